#include "haptics/tick.h"

#include <algorithm>

namespace trocar {
namespace {

class EventList {
 public:
  explicit EventList(TickSample& sample) noexcept : sample_(sample) {}
  void add(EventKind kind, std::uint8_t id) noexcept {
    if (count_ < sample_.events.size())
      sample_.events[count_++] = {kind, id};
    else
      sample_.events.back() = {EventKind::kLimit, static_cast<std::uint8_t>(LimitReason::kEventsDropped)};
  }
  void add(LimitReason reason) noexcept { add(EventKind::kLimit, static_cast<std::uint8_t>(reason)); }

 private:
  TickSample& sample_;
  std::size_t count_ = 0;
};

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

/// Carries the weight of links and stylus, so that the hand feels only the needle (paper A; physics.md W1).
Wrench weight_compensation(const HapticScene& scene, const Mat3& R_PS) noexcept {
  if (!scene.options.has_weight_compensation) return {};
  const Vec3 lift_P = -scene.gravity_P * scene.device.stylus_weight_n;
  const Vec3 arm_P = R_PS * Vec3(0.0, 0.0, -scene.device.stylus_lever_mm);
  return {lift_P, arm_P.cross(lift_P)};
}

/// Scales a vector to a norm; true when it had to.
bool clamp_norm(Vec3& v, double limit) noexcept {
  const double norm = v.norm();
  if (!(norm > limit)) return false;
  v *= limit / norm;
  return true;
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
  Vec3 torque_P = sample.tau_nmm;
  const bool force_limited = clamp_norm(sample.device_f_n, scene.device.peak_force_n);
  const bool torque_limited = clamp_norm(torque_P, scene.device.peak_torque_nmm);
  if (force_limited) events.add(LimitReason::kForceClamped);
  if (torque_limited) events.add(LimitReason::kTorqueClamped);
  sample.limited = force_limited || torque_limited;

  const Mat3 R_DP = scene.X_PD.R().transpose();
  output.f_D = R_DP * sample.device_f_n;
  output.tau_D = R_DP * torque_P;
  state.last = sample;
  return output;
}

}  // namespace trocar
