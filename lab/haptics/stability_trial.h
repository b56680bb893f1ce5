#pragma once

#include "lab/haptics/closed_loop.h"

namespace trocar::haptics {

/// A needle moves straight down (+z) into a flat scene with skin at z = 0, is held until the forces have settled,
/// tapped and released. A hand must come to rest. A free mass (weight compensated) may drift, but must neither vibrate
/// nor gain energy (docs/validation.md, Stability).
struct StabilityTrial {
  double depth_mm = 40.0;     ///< Depth of the device's tip at release.
  double seconds = 60.0;      ///< Duration after release. Range 2..600.
  double tap_mm_per_s = 5.0;  ///< Lateral velocity of the tap. A device with torques is also turned, by tap_rad_per_s.
  double tap_rad_per_s = 0.05;
};

struct StabilityOutcome {
  double position_mm = 0.0;  ///< Peak-to-peak position of the needle's tip in the last sixth, on the worst axis.
  double force_n = 0.0;      ///< Peak-to-peak force on the device in the last sixth, on the worst axis.
  double growth_mj = 0.0;    ///< Largest rise of the energy given to the device after the first sixth.
  double allowed_mm = 0.0;   ///< Limit of position_mm, from the device's counts.
  double allowed_mj = 0.0;   ///< Limit of growth_mj, likewise.
  bool is_finite = true;
  bool must_rest = true;  ///< True if a hand holds the device.

  bool is_at_rest() const noexcept { return is_finite && position_mm <= allowed_mm; }
  bool is_bounded() const noexcept { return is_finite && force_n <= kAllowed_n && (is_at_rest() || !must_rest); }
  bool is_passive() const noexcept { return is_finite && growth_mj <= allowed_mj; }
  bool is_stable() const noexcept { return is_bounded() && is_passive(); }
  static constexpr double kAllowed_n = 0.3;
};

StabilityOutcome run_stability_trial(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset,
                                     Holder holder, const StabilityTrial& trial);

}  // namespace trocar::haptics
