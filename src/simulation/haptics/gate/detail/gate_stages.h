#pragma once

#include <cstdint>

#include "haptics/gate/safety_gate.h"

/// The stages of the safety gate, each a plain function. Real-time safe.
namespace trocar::haptics::detail {

/// What a period may take: the limits of the motors as warm as they are.
struct GateLimits {
  double force_n = 0.0;
  double torque_nmm = 0.0;
  bool is_force_warm = false;   ///< The force's limit is below its peak.
  bool is_torque_warm = false;  ///< The torque's.
};

/// Every field that is out of its range takes its careful value; continuous limits are at most the peaks, the brake at
/// most the greatest damping.
GateParams made_safe(const GateParams& params) noexcept;

/// Finite and within reason, all of it (physics.md G1).
bool is_valid(double value) noexcept;
bool is_valid(const Wrench& wrench) noexcept;
bool is_valid(const GateInput& input) noexcept;
/// Small enough for a safe start to begin.
bool is_small(const Wrench& wrench, const GateParams& params) noexcept;
/// Makes a state usable whatever its bits are; false: something had to be thrown away.
bool restore(GateState& state) noexcept;

/// Energy that the last wrench gave, v and w being the mean velocities meanwhile (physics.md G2). `wanted` limits what
/// springs can have stored.
void observe_energy(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept;
/// The wanted wrench, damped where it would give more than the margin (physics.md G3).
Wrench damp_energy(const GateState& state, const GateInput& input, double dt_s, const GateLimits& limits,
                   const GateParams& params, std::uint16_t& actions) noexcept;
/// What the brake puts in the place of every other force (physics.md G4).
Wrench brake_wrench(const GateInput& input, const GateParams& params) noexcept;

/// Counts late periods and moves the share of the coupling: down at once, up slowly.
void watch_loop(GateState& state, const GateInput& input, double rise_s, const GateParams& params) noexcept;
bool is_loop_slow(const GateState& state, const GateParams& params) noexcept;

/// A step that no hand makes (physics.md G12).
bool is_motion_impossible(const GateState& state, const GateInput& input, const GateParams& params) noexcept;
/// Keeps account of the power that the last wrench gave to fast motion (physics.md G13).
void watch_vibration(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept;
bool is_vibrating(const GateState& state) noexcept;

/// What the motors may take now, and how they warm under what goes out (physics.md G5).
GateLimits warm_limits(const GateState& state, const GateParams& params) noexcept;
void warm(GateState& state, double dt_s, const GateParams& params) noexcept;

/// `target`, its rise over `last` held to `most` (physics.md G6). Falls towards zero pass at once.
Vec3 slew_limited(const Vec3& last, const Vec3& target, double most) noexcept;

/// At most the limits: of a force that is too large the part along `axis` stays, lateral part and torque shrink by one
/// factor (physics.md G8). An axis of no length: the whole force and the torque shrink.
Wrench limited(const Wrench& wrench, const Vec3& axis, double force_n, double torque_nmm) noexcept;

}  // namespace trocar::haptics::detail
