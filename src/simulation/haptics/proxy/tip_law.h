#pragma once

#include "haptics/patient_now.h"

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

}  // namespace trocar::haptics
