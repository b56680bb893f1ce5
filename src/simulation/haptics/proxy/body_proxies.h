#pragma once

#include <array>

#include "haptics/haptic_scene.h"
#include "haptics/insertion/channel.h"
#include "haptics/insertion/path_constraint.h"
#include "haptics/proxy/needle_beam.h"

namespace trocar::haptics {

/// The channel's tissue is sampled in cells fixed in the channel, so that sums over a sliding shaft have no steps.
inline constexpr double kShaftCell_mm = 2.0;

/// Dry and viscous friction of the inserted shaft: summed over the body proxies, each by the tissue it lies in and the
/// length of shaft it stands for (paper B, section 2.1; physics.md B6). `tip_mm`: depth of the tip along the channel.
/// Real-time safe.
struct ShaftResistance {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};
ShaftResistance shaft_resistance(const Channel& channel, const HapticScene& scene, double tip_mm) noexcept;

/// The shaft held to the channel's line by its body proxies, before the tip's force is known. `X_PN`: the device's
/// needle (rigid, +z axis). Purely elastic; at the grip at most half as stiff as the device can show, and at most
/// kMostTurning_nmm_per_rad. `beam.is_bound` tells of proxies or deflections beyond kMaxDeflection and
/// of a pose that is not finite (then nothing holds). Real-time safe.
struct HeldShaft {
  BeamSolution beam;
  BeamBed bed;
  Pose X_PN;
  double share = 1.0;  ///< Share of the shaft's forces rendered at the hand: below 1 if the tissue's rotational
                       ///< stiffness at the grip is too high.
};
inline constexpr double kMostTurning_nmm_per_rad = 1500.0;
HeldShaft hold_shaft(const Channel& channel, const HapticScene& scene, const Pose& X_PN, double tip_mm,
                     bool is_stylet_in) noexcept;

/// Points of the bent shaft in P, grip first, tip last, same length as the straight shaft; for display, ultrasound and
/// X-ray.
struct BentNeedle {
  int count = 0;
  std::array<Vec3, kMaxBeamNodes + 1> points_P = zero_vectors<kMaxBeamNodes + 1>();
};

/// What the shaft does to the hand with `tip_force_P`, the tissue's force on the tip (only its part across the shaft
/// bends and is turned into torque here): force across the shaft and torque about the grip, M = sum l_i x f_i (paper B,
/// eq. 6), in P, all times the shaft's share; no torque about the shaft's own axis: the needle rolls freely.
/// Real-time safe.
struct ShaftReaction {
  Wrench wrench_P;  ///< On the needle, about the grip (stylus origin), of the body proxies and the tip.
  BentNeedle needle;
};
ShaftReaction react(const HeldShaft& shaft, const HapticScene& scene, const Vec3& tip_force_P) noexcept;

/// Sideways force of the tissue on the bevel (N, in P): `bevel_share` of what resists the advancing tip, towards -y of
/// N, away from where the face looks; zero on retreat. Goes into the tip force of `react`. Real-time safe.
Vec3 bevel_force_P(const NeedleGeometry& needle, const Pose& X_PN, double axial_resistance_n) noexcept;

/// A straight needle, for models without bending.
BentNeedle straight_needle(const Pose& X_PN, const HapticScene& scene) noexcept;

}  // namespace trocar::haptics
