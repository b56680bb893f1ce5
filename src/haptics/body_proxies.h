#pragma once

#include <array>

#include "haptics/channel.h"
#include "haptics/haptic_scene.h"
#include "haptics/needle_beam.h"
#include "haptics/path_constraint.h"

namespace trocar {

/// Dry and viscous friction of the inserted shaft: summed over the body proxies, each by the tissue it lies in and the
/// length of shaft it stands for (paper B, section 2.1; physics.md B6). `tip_mm`: depth of the tip along the channel.
/// Real-time safe.
struct ShaftResistance {
  double dry_n = 0.0;
  double viscous_ns_per_mm = 0.0;
};
ShaftResistance shaft_resistance(const Channel& channel, const HapticScene& scene, double tip_mm) noexcept;

/// The shaft held to the channel's line by its body proxies, before the tip's force is known. `X_PN`: the device's
/// needle (rigid, +z axis). Real-time safe.
struct HeldShaft {
  BeamSolution beam;
  BeamBed bed;
  Pose X_PN;
};
HeldShaft hold_shaft(const Channel& channel, const HapticScene& scene, const Pose& X_PN, double tip_mm,
                     bool is_stylet_in) noexcept;

/// Points of the bent shaft in P, grip first, tip last: for pictures, ultrasound and X-ray.
struct BentNeedle {
  int count = 0;
  std::array<Vec3, kMaxBeamNodes + 1> points_P{};
};

/// What the shaft does to the hand with `tip_force_P`, the tissue's force on the tip (only its part across the shaft
/// bends and is turned into torque here): force across the shaft and torque about the grip, M = sum l_i x f_i (paper B,
/// eq. 6), in P; no torque about the shaft's own axis: the needle rolls freely. Real-time safe.
struct ShaftReaction {
  Wrench wrench_P;  ///< On the needle, about the grip (stylus origin), of the body proxies and the tip.
  BentNeedle needle;
};
ShaftReaction react(const HeldShaft& shaft, const HapticScene& scene, const Vec3& tip_force_P) noexcept;

/// A straight needle, for models without bending.
BentNeedle straight_needle(const Pose& X_PN, const HapticScene& scene) noexcept;

}  // namespace trocar
