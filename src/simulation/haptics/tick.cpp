#include "haptics/tick.h"

#include "haptics/detail/tick_parts.h"
#include "haptics/tick_contact.h"

namespace trocar::haptics {
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
  sample.breathing = input.motion.phase();
  fill_insertion(sample, step.axial);
  sample.f_constraint_n = step.held_P.force_n;
  sample.f_tip_proxy_n = step.tip_proxy_P;
  sample.f_weight_n = weight.force_n;
  const double axial_n = sample.f_prepuncture_n + sample.f_friction_n + sample.f_cutting_n + sample.f_body_axial_n;
  sample.f_total_n = sample.axis * axial_n + sample.f_constraint_n + sample.f_tip_proxy_n + weight.force_n;
  sample.tau_nmm = step.held_P.torque_nmm + weight.torque_nmm;
  sample.device_mm = input.tool.p_mm;
  sample.device_rotation_wxyz = input.tool.rotation_wxyz;
  note_rest(input.motion, sample);
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

}  // namespace trocar::haptics
