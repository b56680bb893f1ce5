#pragma once

#include <array>
#include <cstdint>

#include "geometry/pose.h"
#include "geometry/vec.h"

namespace trocar::telemetry {

/// Pose of a tool in P, X_PN or X_PT, as the input of a tick and in its record. The rotation is a quaternion: a
/// rotation matrix that is stored as a quaternion is not restored bit-identically, whereas a replay of recorded tool
/// poses is bit-identical.
struct ToolPose {
  std::array<double, 4> rotation_wxyz{1, 0, 0, 0};  ///< Unit quaternion.
  Vec3 p_mm = Vec3::Zero();

  /// True if all numbers are finite and the quaternion has length 1.
  bool is_valid() const noexcept;
  Pose pose() const noexcept;
};

ToolPose to_tool_pose(const Pose& X_PTool) noexcept;

/// The reason why the safety gate gives zero force until a reset. The first fault stays latched.
enum class GateFault : std::uint8_t {
  kNone,
  kNotFinite,         ///< The wrench or the device's reading was NaN, infinite or beyond all limits.
  kDeviceLost,        ///< Unplugged, or a write was refused.
  kDeviceSilent,      ///< No fresh reading for longer than max_unread_s.
  kRunaway,           ///< Faster than brake_mm_per_s for longer than max_runaway_s.
  kEncoderStuck,      ///< Force without motion by a single encoder count for longer than the caller allows.
  kLoopStalled,       ///< One period was longer than the caller allows.
  kRequested,         ///< The stop button was pressed.
  kLoopSlow,          ///< The periods were longer than the coupling allows, for max_slow_s together.
  kImpossibleMotion,  ///< The reading moved further in one period than a hand can move.
  kVibration,         ///< The device vibrated under the gate's force.
};
inline constexpr GateFault kLastGateFault = GateFault::kVibration;
const char* to_string(GateFault fault) noexcept;

/// The mode of the safety gate.
enum class GateMode : std::uint8_t {
  kOff,      ///< No forces requested: zero.
  kWaiting,  ///< Zero force until the requested force is small.
  kRising,   ///< The force ramps up.
  kOn,
  kFading,  ///< Client timeout, or forces no longer requested: ramps to zero, or is at zero.
  kFault,   ///< Latched; ramps to zero within fault_ramp_s, then zero.
  kAbsent,  ///< No gate (attempt without a server). Never a mode of the gate itself.
};
inline constexpr GateMode kLastGateMode = GateMode::kAbsent;
const char* to_string(GateMode mode) noexcept;

/// Phase of the needle's insertion.
enum class InsertionPhase : std::uint8_t { kOutside, kLoading, kInserted, kRetracting };
inline constexpr InsertionPhase kLastInsertionPhase = InsertionPhase::kRetracting;
const char* to_string(InsertionPhase phase) noexcept;

/// An event of a tick. `id` is a layer id (TissueTable) for kPuncture, a label id for kEnter, a LimitReason for kLimit.
enum class EventKind : std::uint8_t { kNone, kPuncture, kEnter, kLimit };
inline constexpr EventKind kLastEventKind = EventKind::kLimit;
struct TickEvent {
  EventKind kind = EventKind::kNone;
  std::uint8_t id = 0;
};
using TickEvents = std::array<TickEvent, 4>;  ///< Events of one tick, filled from the front.
using Quaternion = std::array<double, 4>;     ///< w, x, y, z.
using Drivers = std::array<double, 4>;        ///< Values of two drivers, then their rates per s.

/// The reason why the haptic server limited a force or rejected an input.
enum class LimitReason : std::uint8_t {
  kForceClamped,
  kTorqueClamped,
  kInputRejected,
  kSolverBound,
  kEventsDropped,
  kResumedInside,  ///< The needle was inside the body at the start: no force step, treated as inserted.
  kJumped,         ///< The device moved further in one tick than a hand can move: restarted at its present pose.
  kPassivity,      ///< The gate began to dissipate energy.
  kContinuous,     ///< The gate began to limit the force because the motors are warm.
  kSlew,           ///< The gate began to limit a rise.
  kStale,          ///< The gate began to fade because of a client timeout.
  kBrake,          ///< The gate began to brake.
  kSafeStart,      ///< The gate began to wait or to ramp up.
  kFault,          ///< The gate began to fade to zero and latched.
};
inline constexpr LimitReason kLastLimitReason = LimitReason::kFault;
const char* to_string(LimitReason reason) noexcept;

/// The record of one haptic tick: `haptics` creates it, `link` transmits it, `training` scores it, `storage` stores it.
/// Vectors in P unless named otherwise. tick_fields.h describes the fields for all record formats.
struct TickSample {
  double time_s = 0.0;
  Vec3 tip_mm = Vec3::Zero();        ///< Tip of the virtual needle.
  Vec3 axis = Vec3::UnitZ();         ///< Unit, hub to tip, of the virtual needle.
  double axial_velocity_mm_s = 0.0;  ///< Positive inward; the input of the force law.
  double depth_mm = 0.0;             ///< Tip below the skin along the path, 0 outside.
  std::uint8_t tissue = 0;           ///< Tissue id (TissueTable) at the tip.
  InsertionPhase phase = InsertionPhase::kOutside;
  double layer_displacement_mm = 0.0;  ///< x of the layer being loaded; the input of the force law.
  double f_prepuncture_n = 0.0;        ///< Signed along the axis: negative pushes the needle out.
  double f_friction_n = 0.0;
  double f_cutting_n = 0.0;
  Vec3 f_constraint_n = Vec3::Zero();
  Vec3 f_weight_n = Vec3::Zero();
  Vec3 f_total_n = Vec3::Zero();  ///< axis*(pre + friction + cutting + body) + constraint + tip proxy + weight.
  Vec3 tau_nmm = Vec3::Zero();    ///< About the stylus origin S.
  TickEvents events{};
  bool limited = false;    ///< The tick (device limits, rejected input) or the safety gate changed the wrench.
  double breathing = 0.0;  ///< Phase 0..1, 0 = end-expiration.
  Vec3 f_tip_proxy_n = Vec3::Zero();  ///< Volume proxy of paper B; zero with the insertion model.
  double f_body_axial_n = 0.0;        ///< Shaft friction of the body proxies; zero with the insertion model.
  double f_stick_n = 0.0;             ///< Karnopp holding force along the axis; not a term of the paper.
  Vec3 device_mm = Vec3::Zero();      ///< Needle tip of the device (before the coupling).
  Vec3 device_f_n = Vec3::Zero();     ///< Force sent to the device.
  /// R_PN of the device's needle: with device_mm and time_s sufficient for a replay. Stored in sessions, not in the
  /// CSV.
  Quaternion device_rotation_wxyz{1, 0, 0, 0};
  /// PX_p of paper A: from the first contact with the skin to its puncture; zero before. Stored, not in the CSV.
  Vec3 contact_to_puncture_mm = Vec3::Zero();
  Vec3 device_tau_nmm = Vec3::Zero();      ///< Torque sent to the device, about S; zero if it has no torque motors.
  GateMode gate_mode = GateMode::kAbsent;  ///< Mode of the server's safety gate after this tick.
  GateFault gate_fault = GateFault::kNone;
  double gate_scale = 1.0;  ///< 0..1, scale of safe start, fading and faults (physics.md G7); 1 without a gate.
  /// tip_mm and axis in the anatomy at rest, frame A; the same if the patient does not move. What is judged by labels,
  /// CT or a plan uses these.
  Vec3 rest_tip_mm = Vec3::Zero();
  Vec3 rest_axis = Vec3::UnitZ();
  bool is_breath_held = false;  ///< The patient holds the breath.
  /// Of the patient's motion (motion/breathing.h): what was, to the bit, for replays. Stored, not in the CSV.
  Drivers drivers{};
  double coupling_share = 1.0;  ///< 0..1, share of the coupling that the loop's period permits (physics.md G11).
};

/// For recordings of patients that do not move, and for tests.
inline void set_at_rest(TickSample& sample) noexcept {
  sample.rest_tip_mm = sample.tip_mm;
  sample.rest_axis = sample.axis;
}

/// Resistance (N) of tip and shaft along the needle, for any force model: positive pushes the needle out. Excludes path
/// constraint, weight and stick.
double axial_resistance_n(const TickSample& sample) noexcept;
/// The part of the resistance that acts on the tip: the load of a layer before its puncture.
double tip_load_n(const TickSample& sample) noexcept;

/// Pose of the device's tool at a tick: X_PN, or X_PT of a transducer. Without a rotation: identity rotation.
Pose device_pose(const TickSample& sample) noexcept;
/// Pose of the virtual needle: its tip and axis, with the device's roll.
Pose felt_needle(const TickSample& sample) noexcept;
/// Where a needle is placed after an interruption, so that it goes on where it was (physics.md S1): the virtual
/// needle's pose, and how far its device was ahead of it because tissue was pressed in and the coupling stretched. A
/// tip that presses on a layer is drawn back to that layer's surface, one on unpierced skin to outside it: being placed
/// there pierces neither.
struct NeedlePlace {
  Pose X_PN;
  double pressed_mm = 0.0;  ///< >= 0; 0 outside and on unpierced skin.
};
NeedlePlace needle_place(const TickSample& sample) noexcept;
/// True if the tip is in the body: below the skin, and the skin has given way.
bool is_in_body(const TickSample& sample) noexcept;
/// Where the tip is in the anatomy at rest (A) as far as layers have given way: in front of a layer that it presses in.
Vec3 pierced_rest_tip_mm(const TickSample& sample) noexcept;
/// Pose of the virtual transducer, whose axis is y of T.
Pose felt_probe(const TickSample& sample) noexcept;

/// The event that reports a limit.
constexpr TickEvent limit_event(LimitReason reason) noexcept {
  return {EventKind::kLimit, static_cast<std::uint8_t>(reason)};
}

/// Puts an event into the first free entry of a sample; false if there is none. Real-time safe.
bool add_event(TickSample& sample, TickEvent event) noexcept;

}  // namespace trocar::telemetry
