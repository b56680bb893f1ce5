#pragma once

#include <array>

#include "geometry/vec.h"
#include "haptics/haptic_scene.h"
#include "haptics/insertion/channel.h"
#include "haptics/proxy/needle_beam.h"

namespace trocar::haptics {

/// The channel's tissue is sampled in cells fixed in the channel, so that sums over a sliding shaft have no steps.
inline constexpr double kShaftCell_mm = 2.0;

/// Dry and viscous friction of the inserted shaft: the sum over the body proxies. Each proxy counts with the tissue at
/// its position and with the length of shaft that it represents (paper B, section 2.1; physics.md B6). `tip_mm`: depth
/// of the tip along the channel. Real-time safe.
struct ShaftResistance {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};
ShaftResistance shaft_resistance(const Channel& channel, const HapticScene& scene, double tip_mm) noexcept;

/// Where the patient moves: velocity (mm/s) along the channel of the tissue at the tip minus that of the tissue at the
/// shaft, its mean over the inserted length. 0 at rest. Real-time safe.
double tissue_drift_mm_per_s(const Channel& channel, const PatientNow& now, double tip_mm) noexcept;

/// The shaft held to its channel by its body proxies, before the tip's force is known. `X_PN`: the device's needle
/// (rigid, +z axis); `ahead_s`: how far ahead in time that pose is, so that a moving channel is taken there, too.
/// Purely elastic; the stiffness at the grip is at most half of the device's, and at most kMostTurning_nmm_per_rad.
/// `beam.is_bound` is set for proxies or deflections beyond kMaxDeflection, and for a pose that is not finite (then no
/// force acts). Real-time safe.
struct HeldShaft {
  BeamSolution beam;
  BeamBed bed;
  Pose X_PN;
  bool is_straight = true;                       ///< The channel is a line, along line_P.
  Vec3 line_P = Vec3::UnitZ();                   ///< Unit, along the channel at the tip.
  std::array<Vec3, kMaxBeamNodes> bent_P;        ///< Unit, along the channel at a node, of one that is not straight.
  std::array<double, kMaxBeamNodes> along_mm{};  ///< Part along the shaft of the way from a node to the channel's line.
  std::array<double, kMaxBeamNodes> stiffening_n_per_mm2{};  ///< Change of the bed's stiffness per mm of depth.
  std::array<double, kMaxBeamNodes> growth_n_per_mm3{};      ///< Change of that per mm of depth.
  double turning_nmm_per_rad = 0.0;                          ///< Rotational stiffness at the grip, without the share.
  double share = 1.0;         ///< Share of the shaft's forces rendered at the hand: below 1 if the tissue's rotational
                              ///< stiffness at the grip is too high.
  double energy_nmm = 0.0;    ///< Stored in tissue and shaft without a force on the tip, as far as it is rendered.
  double out_n = 0.0;         ///< Its growth with depth at a constant pose and share: pushes the needle out (B7).
  double out_n_per_mm = 0.0;  ///< Change of that with depth where the shaft keeps its shape.
};
inline constexpr double kMostTurning_nmm_per_rad = 1500.0;
HeldShaft hold_shaft(const Channel& channel, const PatientNow& now, const Pose& X_PN, double tip_mm, bool is_stylet_in,
                     double ahead_s = 0.0) noexcept;

/// True for a needle whose inserted part is further beside the channel than kMaxDeflection of its length: no needle
/// bends so far, it tears its channel. Real-time safe.
bool is_torn(const Channel& channel, const PatientNow& now, const Pose& X_PN, double tip_mm) noexcept;

/// Deflections of the beam's nodes from the straight shaft, across it, in P (mm); node_count 0: straight.
struct BentShaft {
  int node_count = 0;
  std::array<Vec3, kMaxBeamNodes> deflection_mm = zero_vectors<kMaxBeamNodes>();
};

/// Reaction of the shaft on the hand under `tip_force_P`, the tissue's force on the tip. Only the part of that force
/// across the shaft bends the shaft and causes torque here. The result is the force across the shaft and the torque
/// about the grip, M = sum l_i x f_i (paper B, eq. 6), in P, all times the shaft's share. There is no torque about the
/// shaft's own axis: the needle rolls freely. Real-time safe.
struct ShaftReaction {
  Wrench wrench_P;  ///< Wrench of the body proxies and the tip on the needle, about the grip (stylus origin).
  BentShaft bent;
};
ShaftReaction react(const HeldShaft& shaft, const HapticScene& scene, const Vec3& tip_force_P) noexcept;

/// Sideways force of the tissue on the bevel (N, in P): `bevel_share` of the resistance to the advancing tip, towards
/// -y of N, opposite to the side that the bevel's face points to; zero on retreat. Add it to the tip force of `react`.
/// Real-time safe.
Vec3 bevel_force_P(const NeedleGeometry& needle, const Pose& X_PN, double axial_resistance_n) noexcept;

}  // namespace trocar::haptics
