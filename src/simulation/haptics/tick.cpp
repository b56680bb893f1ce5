#include "haptics/tick.h"

#include <algorithm>
#include <cmath>

#include "geometry/vec.h"
#include "telemetry/tick_sample.h"

namespace trocar::haptics {

/// The tick of a transducer or a finger (physics.md B9, B10, T1): contact with the skin, weight compensation, limits of
/// the device. The record holds the tool in the needle's fields: `tip_mm` and `axis` are its displayed origin and +y,
/// `depth_mm` is the deepest indentation, `f_constraint_n` is the contact force, `phase` is outside or loading. tick()
/// has checked the input. Real-time safe.
HapticOutput tick_contact(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept;

}  // namespace trocar::haptics

/// Parts of the tick common to all tools. Private to `haptics`; all functions are real-time safe.
namespace trocar::haptics {

/// Adds events to a sample. Overwrites the last entry with kEventsDropped if there are more.
class EventList {
 public:
  explicit EventList(telemetry::TickSample& sample) noexcept : sample_(sample) {}
  void add(telemetry::TickEvent event) noexcept {
    if (!telemetry::add_event(sample_, event))
      sample_.events.back() = telemetry::limit_event(telemetry::LimitReason::kEventsDropped);
  }
  void add(telemetry::LimitReason reason) noexcept { add(telemetry::limit_event(reason)); }

 private:
  telemetry::TickSample& sample_;
};

/// Wrench that compensates for the weight of links and stylus, so that the user feels only the tool (paper A;
/// physics.md W1).
inline Wrench weight_compensation(const HapticScene& scene, const Mat3& R_PS) noexcept {
  if (!scene.options.has_weight_compensation) return {};
  const Vec3 lift_P = -scene.gravity_P * scene.device.stylus_weight_n;
  const Vec3 arm_P = R_PS * Vec3(0.0, 0.0, -scene.device.stylus_lever_mm);
  return {lift_P, arm_P.cross(lift_P)};
}

/// Where the patient is, and tip and axis of a sample in the anatomy at rest.
inline void note_motion(const motion::PatientMotion& motion, telemetry::TickSample& sample) noexcept {
  static_assert(motion::kMostDrivers == 2, "a sample has two drivers and their rates");
  const motion::MotionState& state = motion.state();
  sample.breathing = state.phase;
  sample.is_breath_held = state.is_breath_held;
  sample.drivers = {state.drivers[0], state.drivers[1], state.rates_per_s[0], state.rates_per_s[1]};
  telemetry::set_at_rest(sample);
  if (motion.is_rest()) return;
  sample.rest_tip_mm = motion.to_rest(sample.tip_mm);
  sample.rest_axis = motion.line_to_rest(sample.rest_tip_mm, sample.axis).normalized();
}

/// Last step of every tick. Limits `device_f_n`, the torque and its part about the stylus to the device's peaks and
/// adds limit events. Rotates them, and their parts of tissue and weight, to W.
inline void limit_to_device(HapticOutput& output, const Wrench& tissue_P, const Wrench& weight_P,
                            const Vec3& stylus_axis_P, EventList& events, const HapticScene& scene) noexcept {
  telemetry::TickSample& sample = output.sample;
  Vec3 torque_P = sample.tau_nmm;
  const bool force_limited = clamp_norm(sample.device_f_n, scene.device.peak_force_n);
  const bool has_torque = scene.device.has_torque();
  bool torque_limited = has_torque && clamp_norm(torque_P, scene.device.peak_torque_nmm);
  const double roll_nmm = torque_P.dot(stylus_axis_P);
  const double most_nmm = scene.device.peak_roll_nmm;
  if (has_torque && most_nmm > 0.0 && std::abs(roll_nmm) > most_nmm) {
    torque_P += (std::clamp(roll_nmm, -most_nmm, most_nmm) - roll_nmm) * stylus_axis_P;
    torque_limited = true;
  }
  if (force_limited) events.add(telemetry::LimitReason::kForceClamped);
  if (torque_limited) events.add(telemetry::LimitReason::kTorqueClamped);
  sample.limited = force_limited || torque_limited;

  const Mat3 R_WP = scene.X_PW.R().transpose();
  if (!has_torque) torque_P.setZero();
  sample.device_tau_nmm = torque_P;
  output.total_W = R_WP * Wrench{sample.device_f_n, torque_P};
  output.weight_W = R_WP * Wrench{weight_P.force_n, has_torque ? weight_P.torque_nmm : Vec3(Vec3::Zero())};
  output.tissue_W = R_WP * tissue_P;
  if (force_limited) output.tissue_W.force_n = output.total_W.force_n - output.weight_W.force_n;
  if (torque_limited) output.tissue_W.torque_nmm = output.total_W.torque_nmm - output.weight_W.torque_nmm;
}

namespace {

bool is_valid(const HapticInput& input, const HapticScene& scene) noexcept {
  const bool is_near = (input.tool.p_mm - scene.X_PW.p()).norm() < kFarAway_mm;
  return input.tool.is_valid() && is_near && input.dt_s >= kMinDt_s && input.dt_s <= kMaxDt_s;
}

HapticOutput reject(const HapticState& state, const HapticInput& input) noexcept {
  HapticOutput output;
  output.sample = state.last;
  output.sample.time_s = input.time_s;
  output.sample.f_total_n = output.sample.device_f_n = output.sample.tau_nmm = Vec3::Zero();
  output.sample.device_tau_nmm = Vec3::Zero();
  output.sample.events = {};
  output.sample.limited = true;
  EventList(output.sample).add(telemetry::LimitReason::kInputRejected);
  return output;
}

void fill_insertion(telemetry::TickSample& sample, const InsertionStep& step) noexcept {
  sample.tip_mm = step.tip_P;
  sample.axis = step.axis_P;
  sample.axial_velocity_mm_s = step.velocity_mm_per_s;
  sample.depth_mm = step.depth_mm;
  sample.tissue = step.tissue;
  sample.phase = step.phase;
  sample.layer_displacement_mm = step.displacement_mm;
  sample.f_prepuncture_n = -step.prepuncture_n;
  sample.f_friction_n = -step.friction_n;
  sample.f_cutting_n = -step.cutting_n;
  sample.f_stick_n = -step.stick_n;
  sample.f_body_axial_n = -step.body_axial_n;
}

void add_events(EventList& events, const NeedleStep& step) noexcept {
  if (step.has_jumped) events.add(telemetry::LimitReason::kJumped);
  if (step.has_resumed) events.add(telemetry::LimitReason::kResumedInside);
  if (step.axial.punctured != kNoLayer) events.add({telemetry::EventKind::kPuncture, step.axial.punctured});
  for (const std::uint8_t label : step.axial.entered.labels) {
    if (label != 0) events.add({telemetry::EventKind::kEnter, label});
  }
  if (step.axial.entered.is_overflown) events.add(telemetry::LimitReason::kEventsDropped);
  if (step.axial.hit_solver_bound) events.add(telemetry::LimitReason::kSolverBound);
}

}  // namespace

telemetry::ToolPose tool_pose(const HapticScene& scene, const Pose& X_WS) noexcept {
  return telemetry::to_tool_pose(scene.X_PW * X_WS * scene.X_SN);
}

HapticOutput tick(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept {
  if (!is_valid(input, scene)) return reject(state, input);
  if (scene.options.tool != Tool::kNeedle) return tick_contact(state, input, scene);
  const Pose X_PN = input.tool.pose();
  const Pose X_PS = X_PN * scene.X_SN.inverse();

  const NeedleStep step =
      step_needle(state.needle, PatientNow(scene, input.motion), X_PN, input.is_stylet_in, input.dt_s);
  const Wrench weight = weight_compensation(scene, X_PS.R());

  HapticOutput output;
  telemetry::TickSample& sample = output.sample;
  sample.time_s = input.time_s;
  fill_insertion(sample, step.axial);
  sample.f_constraint_n = step.held_P.force_n;
  sample.f_tip_proxy_n = step.tip_proxy_P;
  sample.f_weight_n = weight.force_n;
  const double axial_n = sample.f_prepuncture_n + sample.f_friction_n + sample.f_cutting_n + sample.f_body_axial_n;
  sample.f_total_n = sample.axis * axial_n + sample.f_constraint_n + sample.f_tip_proxy_n + weight.force_n;
  sample.tau_nmm = step.held_P.torque_nmm + weight.torque_nmm;
  sample.device_mm = input.tool.p_mm;
  sample.device_rotation_wxyz = input.tool.rotation_wxyz;
  note_motion(input.motion, sample);
  sample.contact_to_puncture_mm = state.needle.path.contact_to_puncture_P;

  EventList events(sample);
  add_events(events, step);

  // The device receives the coupling's force: the balance of the laws and the holding force.
  sample.device_f_n = sample.f_total_n + sample.axis * sample.f_stick_n;
  const Wrench tissue_P{sample.axis * (axial_n + sample.f_stick_n) + sample.f_constraint_n + sample.f_tip_proxy_n,
                        step.held_P.torque_nmm};
  limit_to_device(output, tissue_P, weight, X_PS.R().col(2), events, scene);
  state.last = sample;
  return output;
}

HapticOutput tick_contact(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept {
  const Pose X_PT = input.tool.pose();
  const Pose X_PS = X_PT * scene.X_SN.inverse();
  const Pose X_PT_before = state.contact.X_PT;
  const bool was_started = state.contact.is_started;

  const ContactStep step = step_contact(state.contact, PatientNow(scene, input.motion), X_PT, input.dt_s);
  const Wrench tissue_P = step.wrench_P.shifted_to(X_PS.p() - X_PT.p());
  const Wrench weight = weight_compensation(scene, X_PS.R());
  const Pose& shown = state.contact.X_PT;
  const bool has_past = was_started && !step.has_jumped;

  HapticOutput output;
  telemetry::TickSample& sample = output.sample;
  sample.time_s = input.time_s;
  sample.tip_mm = shown.p();
  sample.axis = shown.R().col(1);
  sample.axial_velocity_mm_s = has_past ? sample.axis.dot(shown.p() - X_PT_before.p()) / input.dt_s : 0.0;
  sample.depth_mm = step.depth_mm;
  sample.tissue = step.points_in_contact > 0 ? scene.skin : std::uint8_t{0};
  sample.phase = step.points_in_contact > 0 ? telemetry::InsertionPhase::kLoading : telemetry::InsertionPhase::kOutside;
  sample.f_constraint_n = tissue_P.force_n;
  sample.f_weight_n = weight.force_n;
  sample.f_total_n = tissue_P.force_n + weight.force_n;
  sample.tau_nmm = tissue_P.torque_nmm + weight.torque_nmm;
  sample.device_f_n = sample.f_total_n;
  sample.device_mm = input.tool.p_mm;
  sample.device_rotation_wxyz = input.tool.rotation_wxyz;
  note_motion(input.motion, sample);

  EventList events(sample);
  if (step.has_jumped) events.add(telemetry::LimitReason::kJumped);
  if (step.started_inside) events.add(telemetry::LimitReason::kResumedInside);
  if (step.is_bound) events.add(telemetry::LimitReason::kSolverBound);
  limit_to_device(output, tissue_P, weight, X_PS.R().col(2), events, scene);
  state.last = sample;
  return output;
}

}  // namespace trocar::haptics
