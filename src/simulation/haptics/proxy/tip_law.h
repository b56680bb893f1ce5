#pragma once

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// Resistance of the tissue at a point: the transfer functions at its intensity, and the border there, if any (paper B,
/// eq. 2; physics.md B1). Zero outside the body.
struct TipLaw {
  /// N: unit, along the image gradient, into denser tissue; zero: no border. In A from tip_law_at, in P from
  /// tip_law_now.
  Vec3 normal = Vec3::Zero();
  double border = 0.0;  ///< w: 0 (no border) .. 1 (full border).
  anatomy::HuLaw law;
};

/// Law at a point of the anatomy at rest. `here`: tissue and label at the point (from tissue_at or the channel). Labels
/// override the intensities: labelled tissue has at least its own resistance, at the border of a walled structure only
/// the wall's law applies, and a labelled tissue that is cut and has no layer has no border. Real-time safe.
TipLaw tip_law_at(const HapticScene& scene, const Vec3& p_A, const TissueAt& here) noexcept;
/// The same for that tissue where it is now. Real-time safe.
TipLaw tip_law_now(const PatientNow& now, const Vec3& p_A, const TissueAt& here) noexcept;

/// Force (N) needed to move the tip along the unit vector u, without viscosity: the largest F.u that the law permits
/// (physics.md B3).
double threshold_along_n(const TipLaw& law, const Vec3& u) noexcept;

/// Dry and viscous friction of the shaft along the path.
struct AxialFriction {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};

/// Balance of the needle along its path between three elements: the device, which drives it through the coupling; the
/// friction of its shaft; and the tissue, which bears its tip (spring K to the proxy). Massless; all in mm along the
/// path.
struct NeedleDrive {
  stylus::CouplingParams coupling;
  AxialFriction friction;
  double ahead_mm = 0.0;   ///< Position of the device a damping time ahead.
  double before_mm = 0.0;  ///< Position of the needle at the last tick.
  double dt_s = 0.001;
  double bed_n = 0.0;         ///< Force with which the bed of the bent shaft pushes the needle out,
  double bed_n_per_mm = 0.0;  ///< and its growth over the step.
};
struct NeedleBalance {
  double needle_mm = 0.0;
  double on_shaft_n = 0.0;
  double on_tip_n = 0.0;
  double on_bed_n = 0.0;
  double tip_n_per_mm = 0.0;  ///< Decrease of on_tip_n per mm of proxy motion.
};
/// Closed form; at rest while dry friction exceeds the driving force.
NeedleBalance balance_needle(const NeedleDrive& drive, double tissue_n_per_mm, double proxy_mm) noexcept;

}  // namespace trocar::haptics
