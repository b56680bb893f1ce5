#pragma once

#include "core/result.h"
#include "haptics/coupling/device_preset.h"

namespace trocar::haptics {

/// What a coupling may be, in the patient's newtons and millimetres.
struct CouplingLimits {
  double most_n_per_mm = 3.5;     ///< Spring that the device can show.
  double most_ns_per_mm = 0.005;  ///< Damper that it can show at 1 kHz.
  double least_n_per_mm = 0.05;   ///< Lower limit; a softer coupling renders no useful tissue force. [assumed]
  double longest_s = 0.01;        ///< Ratio of damping to stiffness; B7 and C3 predict the pose by this time. [assumed]
};

/// Limits of a device: its greatest stiffness and damping over its scales. A device without motors only shows a force
/// and takes any damping up to that of the defaults above.
CouplingLimits limits_of(const DevicePreset& preset) noexcept;
/// The nearest coupling within the limits; a softer spring keeps its damping time.
CouplingParams within(const CouplingParams& coupling, const CouplingLimits& limits) noexcept;
/// Errors (exit status 2): the first number that is out of its limits, with the limits. Rotational coupling has no
/// numbers of its own: it is that of two springs as far apart as the tool is wide (physics.md B9).
Status check(const CouplingParams& coupling, const CouplingLimits& limits);

}  // namespace trocar::haptics
