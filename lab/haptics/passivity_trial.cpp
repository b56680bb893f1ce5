#include "lab/haptics/passivity_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "lab/haptics/passivity_observer.h"

namespace trocar::haptics {
namespace {

constexpr double kFree_n = 1e-6;

/// The wrench of the laws, before the device's limits.
Wrench law_wrench(const telemetry::TickSample& sample) noexcept {
  return {sample.f_total_n + sample.axis * sample.f_stick_n, sample.tau_nmm};
}

/// Work of a wrench that is linear between two ticks.
class Work {
 public:
  void add(const Wrench& wrench, const Vec3& way_mm, const Vec3& turn_rad) noexcept {
    const Wrench mean{0.5 * (before_.force_n + wrench.force_n), 0.5 * (before_.torque_nmm + wrench.torque_nmm)};
    all_.add(mean, way_mm, turn_rad, 1.0);
    force_.add({mean.force_n, Vec3::Zero()}, way_mm, turn_rad, 1.0);
    before_ = wrench;
  }
  void start(const Wrench& wrench) noexcept { before_ = wrench; }
  const PassivityObserver& all() const noexcept { return all_; }
  double by_force_mj() const noexcept { return force_.energy_mj(); }

 private:
  Wrench before_;
  PassivityObserver all_, force_;
};

/// The tissue recovers from the motion before: a recoil has a time constant of 0.2 s.
void wait_until_recovered(HapticState& state, HapticInput& input, const HapticScene& scene) noexcept {
  constexpr double kWait_s = 4.0;
  input.dt_s = 0.02;
  for (double t = 0.0; t < kWait_s; t += input.dt_s) {
    input.time_s += input.dt_s;
    tick(state, input, scene);
  }
}

void prepare(HapticState& state, HapticInput& input, const HapticScene& scene, const ClosedMotion& before,
             double dt_s) noexcept {
  input.dt_s = dt_s;
  const int count = static_cast<int>(std::ceil(before.seconds() / dt_s));
  for (int n = 0; n <= count; ++n) {
    input.time_s += dt_s;
    input.tool = telemetry::to_tool_pose(tool_of_motion(scene, before.at(n * dt_s)));
    tick(state, input, scene);
  }
  wait_until_recovered(state, input, scene);
}

bool is_free(const Wrench& wrench) noexcept {
  return wrench.force_n.norm() < kFree_n;
}

void look_at(PassivityOutcome& outcome, const HapticOutput& output, const Wrench& wrench) noexcept {
  ++outcome.ticks;
  outcome.limited_ticks += output.sample.limited ? 1 : 0;
  outcome.is_finite = outcome.is_finite && wrench.force_n.allFinite() && wrench.torque_nmm.allFinite();
  outcome.peak_force_n = std::max(outcome.peak_force_n, wrench.force_n.norm());
  for (const telemetry::TickEvent& event : output.sample.events)
    outcome.punctures += event.kind == telemetry::EventKind::kPuncture ? 1 : 0;
}

}  // namespace

Pose tool_of_motion(const HapticScene& scene, const Pose& X_PM) noexcept {
  if (scene.options.tool == Tool::kNeedle) return X_PM;
  Mat3 R_MT;
  R_MT.col(0) = Vec3::UnitX();
  R_MT.col(1) = Vec3::UnitZ();
  R_MT.col(2) = -Vec3::UnitY();
  return {X_PM.R() * R_MT, X_PM.p()};
}

PassivityOutcome run_passivity_trial(const HapticScene& scene, const PassivityTrial& trial,
                                     const std::function<void(const PassivitySample&)>& see) {
  const auto state = std::make_unique<HapticState>();
  HapticInput input;
  if (trial.before != nullptr) prepare(*state, input, scene, *trial.before, trial.dt_s);
  input.dt_s = trial.dt_s;
  PassivityOutcome outcome;
  Work law, device;
  Pose X_PS_before;
  const double start_s = input.time_s;
  const int count = static_cast<int>(std::ceil(trial.motion->seconds() / trial.dt_s));
  for (int n = 0; n <= count; ++n) {
    const double time_s = n * trial.dt_s;
    const Pose X_PTool = tool_of_motion(scene, trial.motion->at(time_s));
    const Pose X_PS = X_PTool * scene.X_SN.inverse();
    input.time_s = start_s + (n + 1) * trial.dt_s;
    input.tool = telemetry::to_tool_pose(X_PTool);
    const HapticOutput output = tick(*state, input, scene);
    const Wrench wrench = law_wrench(output.sample);
    const Mat3& R_PW = scene.X_PW.R();
    const Wrench limited = R_PW * output.total_W;
    if (n == 0) {
      outcome.is_free_at_start = is_free(wrench);
      law.start(wrench);
      device.start(limited);
    } else {
      const Vec3 way_mm = X_PS.p() - X_PS_before.p();
      const Vec3 turn_rad = rotation_vector(X_PS.R() * X_PS_before.R().transpose());
      law.add(wrench, way_mm, turn_rad);
      device.add(limited, way_mm, turn_rad);
    }
    X_PS_before = X_PS;
    look_at(outcome, output, wrench);
    const double energy_mj = law.all().energy_mj();
    if (energy_mj > outcome.most_mj) outcome.most_s = time_s;
    outcome.most_mj = std::max(outcome.most_mj, energy_mj);
    outcome.is_free_at_end = is_free(wrench);
    if (see) see({time_s, X_PTool, wrench, law.by_force_mj(), energy_mj - law.by_force_mj(), output.sample});
  }
  outcome.end_mj = law.all().energy_mj();
  outcome.stored_mj = -law.all().lowest_mj();
  outcome.device_mj = device.all().highest_mj();
  return outcome;
}

std::optional<double> find_skin_puncture_mm(const HapticScene& scene, const Vec3& skin_P, const Vec3& axis_P,
                                            double most_mm) {
  constexpr double kFrom_mm = -1.0, kStep_mm = 0.05;
  const auto state = std::make_unique<HapticState>();
  HapticInput input;
  for (double way = kFrom_mm; way < most_mm; way += kStep_mm) {
    input.time_s += input.dt_s;
    input.tool = telemetry::to_tool_pose(needle_pose(skin_P + way * axis_P, axis_P));
    for (const telemetry::TickEvent& event : tick(*state, input, scene).sample.events)
      if (event.kind == telemetry::EventKind::kPuncture) return way;
  }
  return std::nullopt;
}

void remove_losses(anatomy::TissueTable& tissues, HapticOptions& options) {
  options.has_stick = false;
  options.coupling.damping_ns_per_mm = 0.0;
  for (anatomy::LayerParams& layer : tissues.layers) layer.viscosity_ns_per_mm = 0.0;
  for (anatomy::TissueParams& tissue : tissues.tissues) {
    tissue.viscosity_ns_per_mm = tissue.friction_mu = tissue.roughness_n = 0.0;
    tissue.stick_n_per_mm = tissue.cutting_n = 0.0;
  }
  for (anatomy::HuLaw& law : tissues.transfer.laws) {
    law.normal_n = law.tangential_n = law.resistance_n = law.viscosity_ns_per_mm = 0.0;
    law.shaft_n_per_mm = law.shaft_viscosity_ns_per_mm = 0.0;
  }
}

void close_layers(anatomy::TissueTable& tissues, ClosedLayers closed) {
  if (closed == ClosedLayers::kNone) return;
  if (closed == ClosedLayers::kAll) tissues.friction.tip = 0.0;
  const auto skin = tissues.tissues[tissues.skin].layer;
  for (std::size_t i = 0; i < tissues.layers.size(); ++i) {
    if (closed == ClosedLayers::kAllButSkin && skin && *skin == i) continue;
    tissues.layers[i].puncture_force_n = std::numeric_limits<double>::infinity();
  }
}

}  // namespace trocar::haptics
