#pragma once

#include <array>

#include "geometry/vec.h"
#include "haptics/needle_geometry.h"

namespace trocar::haptics {

/// The shaft as a beam (Euler, Bernoulli), clamped in the grip (paper B, section 2.1, last paragraph; physics.md B8).
/// Nodes 0..n-1 are the body proxies at equal distances from the grip, node n is the tip.
struct NeedleBeam {
  int node_count = 17;                       ///< n + 1.
  double spacing_mm = 150.0 / 17.0;          ///< Distance between nodes, and from the grip to node 0.
  double bending_stiffness_n_mm2 = 20000.0;  ///< E I.
};

inline constexpr int kMaxBeamNodes = kMaxBodyProxies + 1;

/// E I (N mm^2) of the tube, plus that of an inserted stylet.
double bending_stiffness_n_mm2(const NeedleGeometry& needle, bool is_stylet_in) noexcept;
NeedleBeam make_needle_beam(const NeedleGeometry& needle, bool is_stylet_in) noexcept;

/// Elastic foundation of the shaft: one spring per node, from the shaft to its proxy.
struct BeamBed {
  std::array<double, kMaxBeamNodes> stiffness_n_per_mm{};  ///< >= 0; 0 outside the body.
  /// Vector from the straight shaft's node to its proxy, across the shaft.
  std::array<Vec3, kMaxBeamNodes> offset_mm = zero_vectors<kMaxBeamNodes>();
};

/// Equilibrium of the shaft across its straight axis, as a linear function of a force on the tip.
struct BeamSolution {
  int node_count = 0;
  /// Deflection without a force on the tip.
  std::array<Vec3, kMaxBeamNodes> deflection_mm = zero_vectors<kMaxBeamNodes>();
  /// Deflection per newton on the tip; the last value is the tip's.
  std::array<double, kMaxBeamNodes> per_tip_force_mm_n{};
  double turning_nmm_per_rad = 0.0;  ///< Torque at the grip per rotation of it, as of grip_stiffness.
  /// Deflections were limited to kMaxDeflection of the length, because the beam model is linear.
  bool is_bound = false;
};
inline constexpr double kMaxDeflection = 0.3;

/// Exact for forces at nodes, in two passes over them: the compliance of clamp, spans and springs outwards, force and
/// moment back (physics.md B8). A stiffness that is negative or not finite counts as zero; a solution that is not
/// finite is zero and flagged. Real-time safe.
BeamSolution solve_beam(const NeedleBeam& beam, const BeamBed& bed) noexcept;

/// Stiffness of a bed at the grip: force against a lateral shift of the grip, torque against its rotation. Real-time
/// safe.
struct GripStiffness {
  double across_n_per_mm = 0.0;
  double turning_nmm_per_rad = 0.0;
};
GripStiffness grip_stiffness(const NeedleBeam& beam, const BeamBed& bed) noexcept;

}  // namespace trocar::haptics
