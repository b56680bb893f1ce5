#pragma once

#include "core/result.h"
#include "haptics/coupling/device_preset.h"

namespace trocar::haptics {

/// Limits of a coupling, in the patient's newtons and millimetres.
struct CouplingLimits {
  double most_n_per_mm = 3.5;     ///< Stiffest spring that the device can render.
  double most_ns_per_mm = 0.005;  ///< Largest damping that the device can render at 1 kHz.
  double least_n_per_mm = 0.05;   ///< Lower limit; a softer coupling renders no useful tissue force. [assumed]
  /// Largest ratio of damping to stiffness; B7 and C3 predict the pose by this time. [assumed]
  double longest_s = 0.01;
};

/// Limits of a device: its greatest stiffness and damping, divided by its scales. A device without motors only displays
/// a force and accepts any damping up to that of the defaults above.
CouplingLimits limits_of(const DevicePreset& preset) noexcept;
/// The nearest coupling within the limits; a softer spring keeps its damping time.
CouplingParams within(const CouplingParams& coupling, const CouplingLimits& limits) noexcept;
/// Errors (exit status 2): the first number outside its limits, with the limits. The rotational coupling has no
/// parameters of its own: it equals that of two springs as far apart as the tool is wide (physics.md B9).
Status check(const CouplingParams& coupling, const CouplingLimits& limits);

}  // namespace trocar::haptics
