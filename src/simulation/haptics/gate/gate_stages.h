#pragma once

#include <cstdint>

#include "haptics/gate/safety_gate.h"

/// The stages of the safety gate, each a plain function. Real-time safe.
namespace trocar::haptics::detail {

/// Limits of a period: the limits of the motors at their present temperature.
struct GateLimits {
  double force_n = 0.0;
  double torque_nmm = 0.0;
  double roll_nmm = 0.0;        ///< About the axis; 0: no limit of its own.
  bool is_force_warm = false;   ///< The force's limit is below its peak.
  bool is_torque_warm = false;  ///< The torque's limit is below its peak.
};

/// Replaces every field that is out of its range by its safe value. Limits the continuous limits to the peaks, and the
/// brake to the greatest damping.
GateParams made_safe(const GateParams& params) noexcept;

/// True if all values are finite and below the plausibility bounds (physics.md G1).
bool is_valid(double value) noexcept;
bool is_valid(const Wrench& wrench) noexcept;
bool is_valid(const GateInput& input) noexcept;
/// True if the wrench is small enough for a safe start to begin.
bool is_small(const Wrench& wrench, const GateParams& params) noexcept;
/// Makes a state valid for any bit pattern; false: a value had to be discarded.
bool restore(GateState& state) noexcept;

/// Adds the energy that the last wrench supplied; v and w are the mean velocities during that period (physics.md G2).
/// `wanted` limits the energy that springs can have stored.
void observe_energy(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept;
/// The requested wrench, with damping added where it would supply more energy than the margin (physics.md G3).
Wrench damp_energy(const GateState& state, const GateInput& input, double dt_s, const GateLimits& limits,
                   const GateParams& params, std::uint16_t& actions) noexcept;
/// The brake's wrench, which replaces every other force (physics.md G4).
Wrench brake_wrench(const GateInput& input, const GateParams& params) noexcept;

/// Counts late periods and updates the share of the coupling: at once downwards, slowly upwards.
void watch_loop(GateState& state, const GateInput& input, double rise_s, const GateParams& params) noexcept;
bool is_loop_slow(const GateState& state, const GateParams& params) noexcept;

/// True for a step that a hand cannot make (physics.md G12).
bool is_motion_impossible(const GateState& state, const GateInput& input, const GateParams& params) noexcept;
/// Updates the mean power that the last wrench supplied to fast motion (physics.md G13).
void watch_vibration(GateState& state, const GateInput& input, double dt_s, const GateParams& params) noexcept;
bool is_vibrating(const GateState& state) noexcept;

/// Present limits of the motors, and their warming under the output (physics.md G5).
GateLimits warm_limits(const GateState& state, const GateParams& params) noexcept;
void warm(GateState& state, const Vec3& axis, double dt_s, const GateParams& params) noexcept;

/// `target`, with its rise over `last` limited to `most` (physics.md G6). Decreases towards zero pass at once.
Vec3 slew_limited(const Vec3& last, const Vec3& target, double most) noexcept;

/// Limits a wrench. If the force is too large, its part along `axis` is kept, and one factor scales the lateral part
/// and the torque (physics.md G8). With an axis of zero length, the factor scales the whole force and the torque.
Wrench limited(const Wrench& wrench, const Vec3& axis, double force_n, double torque_nmm) noexcept;
/// The torque with its part about `axis` limited to `most`; unchanged if `most` is 0 or the axis has no direction.
Vec3 roll_limited(const Vec3& torque_nmm, const Vec3& axis, double most) noexcept;
/// Part of the torque about the axis; 0 for an axis without direction.
double roll_of(const Vec3& torque_nmm, const Vec3& axis) noexcept;

}  // namespace trocar::haptics::detail
