#pragma once

#include "haptics/gate/safety_gate.h"

/// Limits of a coupling from the period of the haptic loop (physics.md G11). Real-time safe.
namespace trocar::haptics {

/// Longest period (s) that permits the full coupling.
double longest_period_s(const CouplingParams& coupling, const GateParams& params) noexcept;
/// Share (0..1) of a coupling's force that a loop period of `period_s` permits.
double permitted_share(const CouplingParams& coupling, double period_s, const GateParams& params) noexcept;

}  // namespace trocar::haptics
