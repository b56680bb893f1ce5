#pragma once

#include "haptics/gate/safety_gate.h"

/// What the period of a haptic loop permits a coupling (physics.md G11). Real-time safe.
namespace trocar::haptics {

/// Longest period (s) at which this coupling may stay whole.
double longest_period_s(const CouplingParams& coupling, const GateParams& params) noexcept;
/// Share (0..1) of a coupling's force that may be given where the loop's period is `period_s`.
double permitted_share(const CouplingParams& coupling, double period_s, const GateParams& params) noexcept;

}  // namespace trocar::haptics
