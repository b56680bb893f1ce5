#include "lab/haptics/stability_trial.h"

#include <algorithm>
#include <cmath>

namespace trocar::haptics {
namespace {

constexpr double kCarry_s = 2.0;
constexpr double kSettle_s = 0.5;
constexpr double kStart_mm = -5.0;  // above the skin

void carry_in(ClosedLoop& loop, double depth_mm) noexcept {
  const auto ticks = static_cast<int>(kCarry_s / loop.dt_s());
  for (int i = 0; i <= ticks; ++i) {
    const double z = kStart_mm + (depth_mm - kStart_mm) * i / ticks;
    loop.carry({0.0, 0.0, z}, Vec3::UnitZ());
  }
  for (int i = 0; i < static_cast<int>(kSettle_s / loop.dt_s()); ++i) loop.carry({0.0, 0.0, depth_mm}, Vec3::UnitZ());
}

/// A hand that holds the present pose, or no hand.
stylus::StylusHold hold_here(const ClosedLoop& loop, Holder holder, double needle_mm) noexcept {
  stylus::StylusHold hold;
  if (holder == Holder::kHand) hold = stylus::make_hand();
  if (holder == Holder::kGuidingHand) hold = stylus::make_guiding_hand(needle_mm);
  hold.X_PS = loop.stylus().X_PS;
  return hold;
}

/// Limits: a quantised tip may wander by four counts, and an oscillation by counts ten times a second against the
/// coupling's spring defines the power. The force has one limit for all devices.
void judge(StabilityOutcome& outcome, const stylus::DevicePreset& preset, const StabilityTrial& trial,
           const HapticScene& scene) noexcept {
  constexpr double kCounts = 4.0;
  constexpr double kSwings_per_s = 10.0;
  const double count_mm = preset.encoder.count_mm + preset.encoder.count_rad * scene.needle.length_mm;
  outcome.allowed_mm = kCounts * count_mm;
  outcome.allowed_mj = preset.coupling.stiffness_n_per_mm * count_mm * count_mm * kSwings_per_s * trial.seconds;
}

}  // namespace

StabilityOutcome run_stability_trial(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset,
                                     Holder holder, const StabilityTrial& trial) {
  const auto loop = std::make_unique<ClosedLoop>(scene, preset, holder);
  carry_in(*loop, trial.depth_mm);
  const stylus::StylusHold hold = hold_here(*loop, holder, scene->needle.length_mm);
  // A needle is not constrained laterally before the skin puncture.
  const bool is_open =
      loop->last().phase != telemetry::InsertionPhase::kOutside && loop->last().contact_to_puncture_mm != Vec3::Zero();
  if (is_open) loop->stylus().v_P += Vec3(trial.tap_mm_per_s, 0.0, 0.0);
  if (is_open && preset.has_torque()) loop->stylus().w_P += Vec3(0.0, trial.tap_rad_per_s, 0.0);

  StabilityOutcome outcome;
  outcome.must_rest = holder == Holder::kHand || holder == Holder::kGuidingHand;
  Eigen::AlignedBox3d position;
  Eigen::AlignedBox3d force;
  const auto ticks = static_cast<int>(trial.seconds / loop->dt_s());
  for (int i = 0; i < ticks; ++i) {
    if (i == ticks / 6) loop->restart_observer();
    loop->run(hold);
    if (i < ticks - ticks / 6) continue;
    position.extend(loop->tip_P());
    force.extend(loop->wrench_P().force_n);
  }
  outcome.position_mm = position.sizes().maxCoeff();
  outcome.force_n = force.sizes().maxCoeff();
  outcome.growth_mj = loop->observer().growth_mj();
  outcome.is_finite = loop->stylus().X_PS.is_finite() && std::isfinite(outcome.growth_mj);
  judge(outcome, preset, trial, *scene);
  return outcome;
}

}  // namespace trocar::haptics
