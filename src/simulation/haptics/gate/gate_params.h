#pragma once

#include "haptics/gate/safety_gate.h"
#include "stylus/device_preset.h"

namespace trocar::haptics {

/// Gate parameters of a device: its peaks, its continuous force and torque, and its maximum damping; defaults of
/// GateParams otherwise. The result passes check() for every preset that load_device_presets() accepts.
GateParams gate_params(const stylus::DevicePreset& preset) noexcept;

}  // namespace trocar::haptics

/// Limits of a coupling from the period of the haptic loop (physics.md G11). Real-time safe.
namespace trocar::haptics {

/// Longest period (s) that permits the full coupling.
double longest_period_s(const stylus::CouplingParams& coupling, const GateParams& params) noexcept;
/// Share (0..1) of a coupling's force that a loop period of `period_s` permits.
double permitted_share(const stylus::CouplingParams& coupling, double period_s, const GateParams& params) noexcept;

}  // namespace trocar::haptics
