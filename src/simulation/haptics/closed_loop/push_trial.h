#pragma once

#include <vector>

#include "haptics/closed_loop/closed_loop.h"

namespace trocar::haptics {

/// A hand pushes the device's needle straight down (+z) at constant speed and then holds it; records the force on the
/// device tick by tick (docs/validation.md, Bone and loss of resistance).
struct PushTrial {
  double from_mm = -5.0;         ///< Of the tip that the hand wants; the skin lies at z = 0.
  double to_mm = 40.0;           ///< Where the hand stops.
  double speed_mm_per_s = 10.0;  ///< Range 1..200.
  double hold_s = 1.0;
};

struct PushSample {
  double time_s;
  double hand_mm;       ///< Target position of the tip.
  double device_mm;     ///< Where the device's tip is.
  double resistance_n;  ///< Along the needle, of the device's force without the weight; positive pushes out.
  bool is_puncture;     ///< A layer was punctured in this tick...
  std::uint8_t layer;   ///< ...this one.
};

std::vector<PushSample> run_push_trial(std::shared_ptr<const HapticScene> scene, const DevicePreset& preset,
                                       const PushTrial& trial);

/// Metrics of a push against an unyielding structure. `surface_mm`: depth of its resting surface.
struct BoneContact {
  double slope_n_per_mm = 0.0;  ///< Of the force over the device's way, from 10 to 80 % of the steady rise.
  double peak_n = 0.0;
  double steady_n = 0.0;    ///< Mean of the last fifth of the hold.
  double overshoot = 0.0;   ///< Of the peak over the steady force, as a share of it.
  double chatter_n = 0.0;   ///< Peak to peak in the last half of the hold.
  bool is_limited = false;  ///< The device's peak force was reached.
};
BoneContact judge_bone_contact(const std::vector<PushSample>& samples, const PushTrial& trial, double surface_mm,
                               double peak_force_n) noexcept;

/// Metrics of the puncture of one layer; all zero without a puncture.
struct LossOfResistance {
  double peak_n = 0.0;       ///< On the device within 50 ms before.
  double drop_n = 0.0;       ///< To the lowest force within 0.3 s.
  double drop_time_s = 0.0;  ///< From a tenth to nine tenths of the drop.
  double jump_mm = 0.0;      ///< How far the needle went in within 0.3 s beyond what the hand meant to.
  bool has_given_way = false;
};
LossOfResistance judge_loss_of_resistance(const std::vector<PushSample>& samples, std::uint8_t layer) noexcept;

}  // namespace trocar::haptics
