#pragma once

#include "haptics/coupling/device_preset.h"
#include "haptics/gate/safety_gate.h"

namespace trocar::haptics {

/// The gate of a device: its peaks, its continuous force and torque (unknown: a fifth and three tenths of the peaks
/// [assumed]) and the damping it bears; the rest as GateParams has it. Passes check() for every preset that
/// load_device_presets() lets in.
GateParams gate_params(const DevicePreset& preset) noexcept;

}  // namespace trocar::haptics
