#pragma once

#include <vector>

#include "lab/haptics/closed_loop.h"

namespace trocar::haptics {

/// A hand that also guides the needle at its tip pushes the device's needle straight down (+z) at constant speed and
/// then holds it; records the force on the device tick by tick (docs/validation.md, Bone and loss of resistance).
struct PushTrial {
  bool is_rigid = false;         ///< The device is moved, whatever the force: what the model does without a hand.
  double from_mm = -5.0;         ///< Start of the hand's target position of the tip; the skin lies at z = 0.
  double to_mm = 40.0;           ///< End of the hand's target position of the tip.
  double speed_mm_per_s = 10.0;  ///< Range 1..200.
  double hold_s = 1.0;
};

struct PushSample {
  double time_s;
  double hand_mm;       ///< Target position of the tip.
  double device_mm;     ///< Actual position of the device's tip.
  double resistance_n;  ///< Component along the needle of the device's force without the weight; positive pushes out.
  bool is_puncture;     ///< A layer was punctured in this tick.
  std::uint8_t layer;   ///< Punctured layer.
};

std::vector<PushSample> run_push_trial(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset,
                                       const PushTrial& trial);

/// Metrics of a push against an unyielding structure. `surface_mm`: depth of its resting surface.
struct BoneContact {
  /// Slope of the force over the device's displacement, from 10 to 80 % of the steady rise.
  double slope_n_per_mm = 0.0;
  double peak_n = 0.0;
  double steady_n = 0.0;    ///< Mean of the last fifth of the hold.
  double overshoot = 0.0;   ///< Excess of the peak over the steady force, as a share of the steady force.
  double chatter_n = 0.0;   ///< Peak-to-peak force in the last half of the hold.
  bool is_limited = false;  ///< The force reached the device's peak force.
};
BoneContact judge_bone_contact(const std::vector<PushSample>& samples, const PushTrial& trial, double surface_mm,
                               double peak_force_n) noexcept;

/// Metrics of the puncture of one layer; all zero without a puncture.
struct LossOfResistance {
  double peak_n = 0.0;       ///< Largest force on the device within 50 ms before the puncture.
  double drop_n = 0.0;       ///< Decrease to the mean force from 0.2 to 0.3 s after the puncture.
  double lowest_n = 0.0;     ///< Lowest force within 0.3 s: the hand swings.
  double drop_time_s = 0.0;  ///< Time from a tenth to nine tenths of the drop.
  double jump_mm = 0.0;      ///< Largest advance of the needle beyond the hand's target within 0.3 s.
  bool has_given_way = false;
};
LossOfResistance judge_loss_of_resistance(const std::vector<PushSample>& samples, std::uint8_t layer) noexcept;

}  // namespace trocar::haptics
