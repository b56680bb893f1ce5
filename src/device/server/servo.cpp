#include "server/servo.h"

#include <algorithm>

#include "devices/workspace_map.h"
#include "haptics/gate/gate_params.h"
#include "telemetry/tick_sample.h"

namespace trocar::server {
namespace {

/// Event that reports a stage of the gate.
struct GateEvent {
  std::uint16_t action;
  telemetry::LimitReason reason;
};
constexpr std::array kGateEvents{
    GateEvent{haptics::kGateFault, telemetry::LimitReason::kFault},
    GateEvent{haptics::kGateBrake, telemetry::LimitReason::kBrake},
    GateEvent{haptics::kGateStale, telemetry::LimitReason::kStale},
    GateEvent{haptics::kGateStart, telemetry::LimitReason::kSafeStart},
    GateEvent{haptics::kGateContinuous, telemetry::LimitReason::kContinuous},
    GateEvent{haptics::kGatePassivity, telemetry::LimitReason::kPassivity},
    GateEvent{haptics::kGateSlew, telemetry::LimitReason::kSlew},
};

/// Vector from S to the needle's entry point on the skin, in the room; empty outside the body.
std::optional<Vec3> to_entry_W(const haptics::HapticState& state, const haptics::HapticScene& scene,
                               const Pose& X_WS) noexcept {
  if (scene.options.tool != haptics::Tool::kNeedle || !state.needle.path.is_open) return std::nullopt;
  return scene.X_PW.inverse() * state.needle.path.channel.origin_P - X_WS.p();
}

}  // namespace

/// Spring and damper at the device; zero if it has no force.
stylus::CouplingParams Servo::coupling_in_device(const ServoScene* scene) const noexcept {
  if (scene == nullptr || !device_.preset().has_force()) return {0.0, 0.0};
  const double scale = params_.workspace.force_scale * params_.workspace.motion_scale;
  const stylus::CouplingParams& coupling = scene->scene->options.coupling;
  return {scale * coupling.stiffness_n_per_mm, scale * coupling.damping_ns_per_mm};
}

ServoParams servo_params(const stylus::DevicePreset& preset, double rate_hz) noexcept {
  constexpr double kStuckShare = 0.15;
  ServoParams params;
  params.gate = haptics::gate_params(preset);
  params.gate.period_s = 1.0 / rate_hz;
  params.stuck_n = kStuckShare * params.gate.continuous_force_n;
  params.workspace = devices::workspace_params(preset);
  return params;
}

Servo::Servo(devices::HapticDevice& device, const ServoParams& params) noexcept
    : device_(device),
      params_(params),
      has_torque_(device.preset().has_torque()),
      senses_rotation_(device.preset().sensed_dof == 6),
      is_watched_(device.preset().has_force() && device.is_in_real_hand()) {
  workspace_.X_WD_now = params.workspace.X_WD;
  commanded_R_WS_ =
      rotation_between(Vec3::UnitZ(), -Vec3::UnitZ());  // the tool points down until an orientation is set
}

telemetry::GateFault Servo::watch_encoder(const devices::DeviceReading& reading, double dt_s) noexcept {
  const bool is_same = reading.X_DS.p() == last_.X_DS.p() && reading.X_DS.R() == last_.X_DS.R();
  const bool is_pushing = gate_.watched.force_n.norm() > params_.stuck_n;
  unmoved_s_ =
      is_watched_ && is_same && is_pushing && reading.status == devices::DeviceStatus::kFresh ? unmoved_s_ + dt_s : 0.0;
  return unmoved_s_ > params_.stuck_s ? telemetry::GateFault::kEncoderStuck : telemetry::GateFault::kNone;
}

Servo::Sensed Servo::sense(const ServoInput& input) noexcept {
  Sensed sensed;
  sensed.reading = device_.read(input.now_s);
  const devices::DeviceReading& now = sensed.reading;
  const bool is_fresh = now.status == devices::DeviceStatus::kFresh;
  const double since_fresh_s = age_.advance(is_fresh, input.dt_s, params_.gate.max_unread_s);
  if (now.status == devices::DeviceStatus::kDisconnected || has_refused_)
    sensed.fault = telemetry::GateFault::kDeviceLost;
  const bool is_valid = now.X_DS.is_finite() && now.X_DS.p().norm() < haptics::kFarAway_mm;
  if (!is_valid) sensed.fault = telemetry::GateFault::kNotFinite;
  if (has_read_ && input.dt_s > params_.max_hole_s) sensed.fault = telemetry::GateFault::kLoopStalled;
  if (!is_fresh || !is_valid) {
    sensed.reading.X_DS = last_.X_DS;
    return sensed;
  }
  if (has_read_ && !was_placed_) {
    if (const telemetry::GateFault stuck = watch_encoder(now, input.dt_s); stuck != telemetry::GateFault::kNone)
      sensed.fault = stuck;
    sensed.v_D = (now.X_DS.p() - last_.X_DS.p()) / since_fresh_s;
    sensed.w_D = rotation_vector(now.X_DS.R() * last_.X_DS.R().transpose()) / since_fresh_s;
  }
  last_ = now;
  has_read_ = true;
  return sensed;
}

devices::DeviceHand Servo::hand_in_device(const link::HandTarget& target,
                                          const haptics::HapticScene& scene) const noexcept {
  const Pose X_WS = scene.X_PW.inverse() * target.X_PN * scene.X_SN.inverse();
  const Mat3 R_DP = (scene.X_PW.R() * workspace_.X_WD_now.R()).transpose();
  const double scale = params_.workspace.motion_scale;
  devices::DeviceHand hand;
  hand.X_DS = devices::map_from_room(workspace_, params_.workspace, X_WS);
  hand.v_D = R_DP * target.v_P / scale;
  hand.w_D = R_DP * target.w_P;
  hand.time_s = target.server_time_s;
  hand.stiffness_n_per_mm = target.stiffness_n_per_mm;
  hand.damping_ns_per_mm = target.damping_ns_per_mm;
  hand.mass_kg = target.mass_kg;
  hand.turning_nmm_per_rad = target.turning_nmm_per_rad;
  hand.turning_damping_nmms_per_rad = target.turning_damping_nmms_per_rad;
  hand.inertia_kg_mm2 = target.inertia_kg_mm2;
  hand.point_mm = target.holds_tip ? scene.X_SN.p().z() : 0.0;
  hand.buttons = target.buttons;
  hand.is_held = target.is_held;
  hand.is_rigid = target.is_rigid;
  hand.is_placed = target.is_placed;
  return hand;
}

Servo::Wanted Servo::feel(const Sensed& sensed, const ServoInput& input, telemetry::TickSample& sample) noexcept {
  Wanted wanted;
  Pose X_WS = devices::map_to_room(workspace_, params_.workspace, sensed.reading.X_DS, sensed.reading.buttons);
  if (!senses_rotation_) X_WS = Pose(commanded_R_WS_, X_WS.p());
  if (input.scene == nullptr) {
    sample = {};
    sample.time_s = input.now_s;
    return wanted;
  }
  const haptics::HapticScene& scene = *input.scene->scene;
  const haptics::HapticOutput output =
      tick(tick_,
           {input.now_s, std::min(input.dt_s, haptics::kMaxDt_s), haptics::tool_pose(scene, X_WS), input.is_stylet_in,
            scene.motion_at(input.now_s)},
           scene);
  sample = output.sample;

  const Vec3 axis_W = X_WS.R() * scene.X_SN.R().col(scene.options.tool == haptics::Tool::kNeedle ? 2 : 1);
  Wrench tissue_W = output.tissue_W;
  if (!has_torque_) tissue_W = devices::without_torque(tissue_W, axis_W, to_entry_W(tick_, scene, X_WS));
  wanted.wrench_D = devices::map_to_device(workspace_, params_.workspace, tissue_W);
  // The weight is also compensated while the clutch is pressed.
  const Mat3 R_DW = params_.workspace.force_scale * workspace_.X_WD_now.R().transpose();
  wanted.weight_D = R_DW * output.weight_W;
  wanted.axis_D = workspace_.X_WD_now.R().transpose() * axis_W;
  return wanted;
}

void Servo::note_gate(const haptics::GateOutput& output, const ServoInput& input,
                      telemetry::TickSample& sample) noexcept {
  const auto begun = static_cast<std::uint16_t>(output.actions & ~actions_before_);
  actions_before_ = output.actions;
  for (const GateEvent& event : kGateEvents) {
    if ((begun & event.action) != 0) telemetry::add_event(sample, telemetry::limit_event(event.reason));
  }
  if (output.actions != 0) sample.limited = true;
  sample.gate_mode = gate_.mode;
  sample.gate_fault = gate_.fault;
  sample.gate_scale = gate_.scale;
  sample.coupling_share = gate_.coupling_share;
  if (input.scene == nullptr) return;
  const Mat3 R_PD = input.scene->scene->X_PW.R() * workspace_.X_WD_now.R();  // X_PW * X_WD
  sample.device_f_n = R_PD * output.wrench.force_n;
  sample.device_tau_nmm = R_PD * output.wrench.torque_nmm;
}

void Servo::note_shape(const ServoInput& input, ServoRecord& record) noexcept {
  constexpr double kRounding_s = 1e-6;
  if (input.scene == nullptr || input.scene->scene->options.tool != haptics::Tool::kNeedle) return;
  if (input.now_s >= shape_s_ && input.now_s < shape_s_ + kShapeEvery_s - kRounding_s) return;
  shape_s_ = input.now_s;
  const haptics::HapticScene& scene = *input.scene->scene;
  record.shape = haptics::needle_shape(tick_.needle, {scene, scene.motion_at(input.now_s)}, input.is_stylet_in);
  record.shape->time_s = record.sample.time_s;
}

void Servo::reset(double pressed_mm) noexcept {
  tick_ = {};
  tick_.needle.pressed_mm = pressed_mm;
  if (gate_.fault == telemetry::GateFault::kNone) gate_.mode = telemetry::GateMode::kOff;  // through the safe start
}

bool Servo::gives_force() const noexcept {
  return gate_.last.force_n != Vec3::Zero() || gate_.last.torque_nmm != Vec3::Zero();
}

void Servo::resume() noexcept {
  reset();
  haptics::restart_gate(gate_);
  has_read_ = was_placed_ = has_refused_ = false;
  age_ = {};
  unmoved_s_ = 0.0;
}

ServoRecord Servo::step(const ServoInput& input) noexcept {
  ServoRecord record;
  record.tick = ticks_++;
  record.scene = input.scene == nullptr ? 0 : input.scene->number;
  record.silence_s = input.silence_s;
  if (input.scene != nullptr && input.scene->number != scene_number_) {
    if (!input.scene->continues) reset();
    scene_number_ = input.scene->number;
  }

  const Sensed sensed = sense(input);
  if (was_placed_) reset(pressed_mm_);  // a placed tool has no path from its former pose and creates no channel
  was_placed_ = input.hand && input.hand->is_placed;
  if (was_placed_) pressed_mm_ = input.hand->pressed_mm;
  if (input.hand && input.scene != nullptr) {
    const haptics::HapticScene& scene = *input.scene->scene;
    commanded_R_WS_ = (scene.X_PW.inverse() * input.hand->X_PN * scene.X_SN.inverse()).R();
    device_.hold(hand_in_device(*input.hand, scene));
  }
  const Wanted wanted = feel(sensed, input, record.sample);
  note_shape(input, record);

  haptics::GateInput gate;
  gate.wanted = wanted.wrench_D;
  gate.weight = wanted.weight_D;
  gate.axis = wanted.axis_D;
  gate.v_mm_per_s = sensed.v_D;
  gate.w_rad_per_s = sensed.w_D;
  gate.dt_s = input.dt_s;
  gate.silence_s = input.silence_s;
  gate.unread_s = age_.unread_s();
  gate.busy_s = input.busy_s;
  gate.coupling = coupling_in_device(input.scene);
  gate.is_wanted = input.is_wanted && input.scene != nullptr;
  gate.device_fault = sensed.fault;
  gate.is_reset = input.is_reset;
  const haptics::GateOutput output = haptics::step_gate(gate_, gate, params_.gate);
  has_refused_ = !device_.write(output.wrench);
  if (input.is_reset) unmoved_s_ = 0.0;

  note_gate(output, input, record.sample);
  record.status = sensed.reading.status;
  record.actions = output.actions;
  record.drop_n = output.drop_n;
  record.drop_s = output.drop_s;
  record.wanted_D = gate.wanted + gate.weight;
  record.written_D = output.wrench;
  record.X_DS = sensed.reading.X_DS;
  record.buttons = sensed.reading.buttons;
  return record;
}

}  // namespace trocar::server
