#include "haptics/tick.h"

#include "haptics/detail/tick_parts.h"
#include "haptics/tick_contact.h"

namespace trocar {
namespace {

bool is_usable(const HapticInput& input) noexcept {
  constexpr double kFarAway_mm = 1e5;
  return input.X_DS.is_finite() && input.X_DS.p().norm() < kFarAway_mm && input.dt_s > 0.0 && input.dt_s <= kMaxDt_s;
}

HapticOutput reject(const HapticState& state, const HapticInput& input) noexcept {
  HapticOutput output;
  output.sample = state.last;
  output.sample.time_s = input.time_s;
  output.sample.f_total_n = output.sample.device_f_n = output.sample.tau_nmm = Vec3::Zero();
  output.sample.events = {};
  output.sample.limited = true;
  EventList(output.sample).add(LimitReason::kInputRejected);
  return output;
}

/// Paper A: path constraint, only while the needle is in the skin (docs/physics.md C3).
Wrench constraint_wrench(const InsertionState& state, const HapticScene& scene, const Pose& X_PN) noexcept {
  if (!state.has_path || !(state.rest_mm > 0.0)) return {};
  const Channel& line = state.channel;
  if (line.direction_P.dot(X_PN.p() - line.origin_P) <= 0.0) return {};
  return path_constraint(line.origin_P, line.direction_P, X_PN.p(), X_PN.R().col(2), scene.options.constraint);
}

void fill_insertion(TickSample& sample, const InsertionStep& step) noexcept {
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
}

}  // namespace

HapticOutput tick(HapticState& state, const HapticInput& input, const HapticScene& scene) noexcept {
  if (!is_usable(input)) return reject(state, input);
  if (scene.options.tool != Tool::kNeedle) return tick_contact(state, input, scene);
  const Pose X_PS = scene.X_PD * input.X_DS;
  const Pose X_PN = X_PS * scene.X_SN;

  const InsertionStep step = step_insertion(state.insertion, scene, X_PN.p(), X_PN.R().col(2), input.dt_s);
  const Wrench constraint = constraint_wrench(state.insertion, scene, X_PN);
  const Wrench weight = weight_compensation(scene, X_PS.R());

  HapticOutput output;
  TickSample& sample = output.sample;
  sample.time_s = input.time_s;
  fill_insertion(sample, step);
  sample.f_constraint_n = constraint.force_n;
  sample.f_weight_n = weight.force_n;
  const double axial_n = sample.f_prepuncture_n + sample.f_friction_n + sample.f_cutting_n;
  sample.f_total_n = sample.axis * axial_n + constraint.force_n + weight.force_n;
  sample.tau_nmm = constraint.torque_nmm + weight.torque_nmm;
  sample.device_mm = X_PN.p();
  sample.contact_to_puncture_mm = state.insertion.contact_to_puncture_P;
  const Eigen::Quaterniond q(X_PN.R());
  sample.device_rotation_wxyz = {q.w(), q.x(), q.y(), q.z()};

  EventList events(sample);
  if (step.punctured != kNoLayer) events.add(EventKind::kPuncture, step.punctured);
  for (const std::uint8_t label : step.entered) {
    if (label != 0) events.add(EventKind::kEnter, label);
  }
  if (step.dropped_events) events.add(LimitReason::kEventsDropped);
  if (step.hit_solver_bound) events.add(LimitReason::kSolverBound);

  // The device gets the coupling's force: the balance of the laws and the holding force.
  sample.device_f_n = sample.f_total_n + sample.axis * sample.f_stick_n;
  limit_to_device(output, events, scene);
  state.last = sample;
  return output;
}

}  // namespace trocar
