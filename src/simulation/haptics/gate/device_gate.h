#pragma once

#include "haptics/coupling/device_preset.h"
#include "haptics/gate/safety_gate.h"

namespace trocar::haptics {

/// Gate parameters of a device: its peaks, its continuous force and torque (if unknown, a fifth and three tenths of the
/// peaks [assumed]) and its maximum damping; defaults of GateParams otherwise. The result passes check() for every
/// preset that load_device_presets() accepts.
GateParams gate_params(const DevicePreset& preset) noexcept;

}  // namespace trocar::haptics
