#pragma once

#include <cstdint>

#include "core/result.h"
#include "geometry/vec.h"
#include "haptics/haptic_scene.h"  // CouplingParams
#include "telemetry/tick_sample.h"

namespace trocar::haptics {

/// Actions of the gate on the wrench in this period; bits.
enum GateAction : std::uint16_t {
  kGatePassivity = 1 << 0,   ///< Passivity control dissipated energy.
  kGateContinuous = 1 << 1,  ///< Limited below the peak because the motors are warm.
  kGateSlew = 1 << 2,        ///< Limited a rise.
  kGateStale = 1 << 3,       ///< Client timeout.
  kGateClamp = 1 << 4,       ///< At the device's peak force or torque.
  kGateBrake = 1 << 5,       ///< Brakes a device that is too fast.
  kGateStart = 1 << 6,       ///< Safe start: waiting or rising.
  kGateFault = 1 << 7,
  kGateOff = 1 << 8,
  kGateSlowLoop = 1 << 9,  ///< Reduced the coupling, because the loop's period is too long for it.
};

/// Limits of a device and of the gate. A number without a source is assumed. Ranges: gate_params.cpp.
struct GateParams {
  double peak_force_n = 37.5;    ///< Range 0.1..200.
  double peak_torque_nmm = 515;  ///< 0: the device gives no torque.
  double continuous_force_n = 6.2;
  double continuous_torque_nmm = 188;
  double peak_roll_nmm = 170;  ///< Torque about GateInput::axis; 0: only the whole torque is limited. Range 0..5000.
  double continuous_roll_nmm = 48;
  double thermal_time_s = 10.0;         ///< Time constant of the motors' first-order warming. Range 0.5..600.
  double max_damping_ns_per_mm = 0.01;  ///< Upper limit of passivity damping: what the device permits at 1 kHz.
  double passivity_margin_mj = 2.0;     ///< Energy margin before damping starts (counts, delay). Range 0..50.
  double softest_n_per_mm = 0.2;        ///< Softest spring whose stored energy may be returned. Range 0.01..5.
  double softest_nmm_per_rad = 100;  ///< Softest rotational spring whose stored energy may be returned. Range 5..1e4.
  double count_mm = 0.0295;   ///< One count of the device's encoders; the time of a motion within one count is unknown.
                              ///< Range 0..1; 0: exact.
  double count_rad = 4.0e-5;  ///< Range 0..0.1.
  double slew_n_per_s = 4000.0;  ///< Limits rises only. Range 50..1e5.
  double slew_nmm_per_s = 8e4;
  double stale_s = 0.25;       ///< Client timeout before the force fades.
  double fade_s = 0.2;         ///< Time from full force to zero.
  double rise_s = 0.5;         ///< Safe start and resume: time from zero to full force.
  double small_force_n = 0.3;  ///< Safe start begins below this force.
  double small_torque_nmm = 20.0;
  double fault_ramp_s = 0.02;
  double brake_mm_per_s = 1000.0;  ///< The speed of a hand with a needle stays below this value. Range 100..5000.
  double brake_ns_per_mm = 0.005;  ///< Damping of the brake, at most max_damping_ns_per_mm.
  double max_runaway_s = 0.05;
  double max_unread_s = 0.02;  ///< Range 0.002..1.
  double period_s = 0.001;     ///< Nominal period of the loop. Range 0.0001..0.01.
  /// Damping by the device's joints and a loose hand, which may compensate for a spring's delay. Range 0.0001..0.05.
  double physical_damping_ns_per_mm = 0.0035;
  double max_slow_s = 0.05;  ///< Sum of late periods that causes a fault; those mostly spent in own calls count twice
                             ///< (physics.md G11). Range 0.01..5.
  double jump_mm = 5.0;      ///< A step beyond jump_mm + hand_mm_per_s * dt is impossible. Range 1..100.
  double kick_mm = 2.5;      ///< A deviation from the extrapolated motion beyond kick_mm + thrust_mm_per_s2 * dt^2 is
                             ///< impossible. Range 0.5..50.
  double thrust_mm_per_s2 = 4e5;    ///< Largest acceleration of a device by a hand or motor. Range 1e4..1e8.
  double hand_mm_per_s = 3000.0;    ///< Largest speed of a hand. Range 1000..1e4.
  double turn_rad = 1.0;            ///< A rotation beyond turn_rad + hand_rad_per_s * dt is impossible. Range 0.2..3.
  double hand_rad_per_s = 60.0;     ///< Range 10..500.
  double max_vibration_mw = 100.0;  ///< Power supplied above 30 Hz that causes a fault (physics.md G13). Range 1..1e6.
};

/// Errors: the first field out of range, a continuous limit above its peak. step_gate() accepts any bits and replaces a
/// field out of range by the value that gives the least force.
Status check(const GateParams& params);

/// Input of one period: the requested wrench (about S, all quantities in one frame at rest), and the state of device
/// and client.
struct GateInput {
  Wrench wanted;                    ///< Wrench of tissue and path, without the weight.
  Wrench weight;                    ///< Compensation of the stylus' weight; conservative, not included in the energy.
  Vec3 axis = Vec3::UnitZ();        ///< Unit, along the needle: the part of a force that is kept when it saturates.
  Vec3 v_mm_per_s = Vec3::Zero();   ///< Mean velocity of the stylus since the last period (its displacement over dt).
  Vec3 w_rad_per_s = Vec3::Zero();  ///< Mean angular velocity, likewise.
  double dt_s = 0.001;
  double silence_s = 0.0;  ///< Time since the last client message.
  double unread_s = 0.0;   ///< The device's silence; the caller leaves out the time in which its own loop did not run.
  double busy_s = 0.0;     ///< Part of dt_s that reading, tick and writing of the last period took.
  stylus::CouplingParams coupling;  ///< Coupling in device units; stiffness 0: no check.
  bool is_wanted = false;           ///< Forces are requested.
  telemetry::GateFault device_fault = telemetry::GateFault::kNone;  ///< Fault detected by the caller (kDeviceLost,
                                                                    ///< kEncoderStuck, kLoopStalled, kRequested).
  bool is_reset = false;  ///< Explicit reset of a fault; has no effect while its cause persists.
};

/// Fixed size, copyable.
struct GateState {
  telemetry::GateMode mode = telemetry::GateMode::kOff;
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  Wrench last;              ///< Output wrench of the last period.
  Wrench watched;           ///< Output wrench without the weight's share; its energy is monitored.
  double scale = 0.0;       ///< Scale of the safe start, of fading and of a fault's ramp, 0..1.
  double energy_mj = 0.0;   ///< Energy supplied to the device minus dissipated energy; bounded below by the energy that
                            ///< springs may store (G2).
  double quiet_s = 0.0;     ///< Time since more than a small force was requested.
  double force_heat = 0.0;  ///< Mean square of the force divided by the square of the continuous force: 1 = warm.
  double torque_heat = 0.0;
  double roll_heat = 0.0;
  double runaway_s = 0.0;
  double drop_from_n = 0.0;  ///< Force at the start of the present drop.
  double drop_s = 0.0;
  double slow_s = 0.0;         ///< Sum of late periods; decreases in periods on time.
  double since_late_s = 1.0;   ///< Time since the last late period.
  double slow_period_s = 0.0;  ///< Period of a slow loop; 0: the loop is not slow.
  double coupling_share = 1.0;
  Vec3 slow_f_n = Vec3::Zero(), slow_tau_nmm = Vec3::Zero();             ///< Low-pass of the output wrench.
  Vec3 slow_v_mm_per_s = Vec3::Zero(), slow_w_rad_per_s = Vec3::Zero();  ///< Low-pass of the velocities.
  double vibration_mw = 0.0;                                             ///< Mean power supplied to fast motion.
  double vibration_s = 0.0;                                              ///< Time with a power above the limit.
  Vec3 last_v_mm_per_s = Vec3::Zero();
};

struct GateOutput {
  Wrench wrench;              ///< Wrench for the device. Always finite, always within its limits.
  std::uint16_t actions = 0;  ///< GateAction bits.
  double drop_n = 0.0;        ///< Decrease of a force drop that ended in this period; zero otherwise.
  double drop_s = 0.0;        ///< Duration of that drop; zero otherwise.
};

/// Call after the device was leased. Resets the last output, energy, speed and drop; forces return through the safe
/// start. A fault and the motor temperature are kept.
void restart_gate(GateState& state) noexcept;

/// The last step before the motors, and the only one that writes to them (physics.md G1-G9, G11-G13). Stages: finite
/// check, faults, share of the coupling that the loop's period permits, passivity control (Hannaford and Ryu's observer
/// and controller), velocity brake, continuous-force limit, scale of safe start and client timeout, slew limit on rises
/// only, norm clamp. If a force saturates, one factor scales the lateral part and the torque, and the axial part is
/// kept (to 2 %, which leaves a fifth of the limit to the lateral part). Any fault fades to zero within fault_ramp_s
/// and latches. A pure function of its arguments; real-time safe; any input bits give a wrench within the limits.
GateOutput step_gate(GateState& state, const GateInput& input, const GateParams& params) noexcept;

}  // namespace trocar::haptics
