#include "haptics/tick_contact.h"

#include "haptics/detail/tick_parts.h"

namespace trocar::haptics {

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
  sample.breathing = input.motion.phase();
  note_rest(input.motion, sample);

  EventList events(sample);
  if (step.has_jumped) events.add(telemetry::LimitReason::kJumped);
  if (step.started_inside) events.add(telemetry::LimitReason::kResumedInside);
  if (step.is_bound) events.add(telemetry::LimitReason::kSolverBound);
  limit_to_device(output, tissue_P, weight, X_PS.R().col(2), events, scene);
  state.last = sample;
  return output;
}

}  // namespace trocar::haptics
