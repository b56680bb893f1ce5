#include "server/stylus_weighing.h"

#include <algorithm>
#include <cmath>

namespace trocar::server {
namespace {

constexpr double kLongestPeriod_s = 0.1;  // longer gaps count as this, as in the gate
constexpr double kOverContinuous = 1.5;   // of the hold's force while it moves up against friction [assumed]
constexpr double kMostHold_n = 3.0;       // an untended stylus must not push harder [assumed, 1..6]
constexpr double kClear_s = 0.05;         // without force before the start; a placed stylus has no speed after it
constexpr double kHandOver_s = 0.5;       // with the full force before a hand lets go
constexpr double kLeastRest_s = 3.0;      // time to let go [assumed]
constexpr double kRest_s = 0.5;
constexpr double kRest_mm_per_s = 2.0;
constexpr double kRest_mm = 2.0;          // from the target
constexpr double kLongestPhase_s = 15.0;  // of each phase up to the rest
constexpr double kTooFar_mm = 30.0;       // from the start [assumed]
constexpr double kSunkShare = 0.7;        // of the distance: downwards
constexpr double kMostStuck_n = 1.0;      // change of the force without a count: held, or a stuck encoder [assumed]
constexpr double kTilt_rad = 0.1;         // of a way: about 70 counts of 0.05 deg
constexpr double kLeastLevel = 0.3;       // sine of the angle to the vertical below which there is no lever
constexpr double kMostLever_mm = 200.0;
constexpr double kMostAtLimit = 0.1;  // share of the periods
constexpr double kLeastFollowed = 0.5;
constexpr double kMostSpread_n = 0.1;  // a spring of 0.05 N/mm between the two seconds [assumed]
constexpr double kZero_n = 0.02;       // smaller upward pulls are rounding

detail::PoseHoldParams hold_params(const stylus::DevicePreset& preset, const haptics::GateParams& gate) noexcept {
  detail::PoseHoldParams params;
  params.stiffness_n_per_mm = std::min(params.stiffness_n_per_mm, preset.coupling.stiffness_n_per_mm);
  params.damping_ns_per_mm = std::min(params.damping_ns_per_mm, preset.max_damping_ns_per_mm);
  params.most_n = std::min({kMostHold_n, kOverContinuous * gate.continuous_force_n, gate.peak_force_n});
  params.most_nmm = preset.has_torque() ? gate.continuous_torque_nmm : 0.0;
  return params;
}

/// Across the stylus and horizontal: a weight behind S turns the stylus about it. Zero if nearly vertical.
Vec3 turning_axis(const Pose& X_DS) noexcept {
  const Vec3 across = X_DS.R().col(2).cross(Vec3::UnitZ());
  return across.norm() < kLeastLevel ? Vec3(Vec3::Zero()) : across.normalized();
}

}  // namespace

StylusWeighing::StylusWeighing(const stylus::DevicePreset& preset, const haptics::GateParams& gate) noexcept
    : device_(preset.capability),
      has_force_(preset.has_force()),
      continuous_n_(gate.continuous_force_n),
      params_(hold_params(preset, gate)),
      hold_(params_) {}

void StylusWeighing::start() noexcept {
  if (is_running()) return;
  result_.reset();
  if (!has_force_ || device_.stylus_weight_n <= 0.0) {
    abort(has_force_ ? WeighRefusal::kCarriedByDevice : WeighRefusal::kNoForce, telemetry::GateFault::kNone);
    return;
  }
  legs_ = {};
  since_fresh_s_ = 0.0;
  enter(Phase::kClearing);
}

void StylusWeighing::enter(Phase phase) noexcept {
  phase_ = phase;
  phase_s_ = rested_s_ = 0.0;
}

void StylusWeighing::end(const WeighResult& result) noexcept {
  result_ = result;
  enter(Phase::kIdle);
}

void StylusWeighing::abort(WeighRefusal refusal, telemetry::GateFault fault) noexcept {
  WeighResult result;
  result.refusal = refusal;
  result.fault = fault;
  result.limit_n = std::min(continuous_n_, params_.most_n);
  end(result);
}

std::optional<WeighResult> StylusWeighing::take_result() noexcept {
  std::optional<WeighResult> result;
  result.swap(result_);
  return result;
}

bool StylusWeighing::needs_hand() const noexcept {
  return phase_ == Phase::kClearing || phase_ == Phase::kRising ||
         (phase_ == Phase::kSettling && phase_s_ < kHandOver_s);
}

stylus::CouplingParams StylusWeighing::coupling() const noexcept {
  return {params_.stiffness_n_per_mm, params_.damping_ns_per_mm};
}

Wrench StylusWeighing::carried() const noexcept {
  Wrench wrench;
  wrench.force_n = std::min(device_.stylus_weight_n, params_.most_n) * Vec3::UnitZ();
  const Vec3 arm_mm = -device_.stylus_lever_mm * hold_.X_DS().R().col(2);
  if (params_.most_nmm > 0.0) wrench.torque_nmm = arm_mm.cross(wrench.force_n);
  return wrench;
}

/// The start, raised and tilted by the share of the way that the present leg has reached.
Pose StylusWeighing::target() const noexcept {
  if (phase_ != Phase::kMoving) return start_X_DS_;
  const int leg = static_cast<int>(phase_s_ / kLeg_s);
  const double run = phase_s_ / kLeg_s - leg;
  const double share = leg % 2 == 0 ? run : 1.0 - run;
  const Mat3 R = rotation_from_vector(share * kTilt_rad * turning_axis_) * start_X_DS_.R();
  return {R, start_X_DS_.p() + share * kWay_mm * Vec3::UnitZ()};
}

StylusWeighing::Demand StylusWeighing::step(const Input& input) noexcept {
  if (!is_running()) return {};
  const double dt_s = input.dt_s > 0.0 ? std::min(input.dt_s, kLongestPeriod_s) : 0.0;  // NaN: 0
  phase_s_ += dt_s;
  since_fresh_s_ += dt_s;
  if (input.X_DS && since_fresh_s_ > 0.0) {
    hold_.sense(*input.X_DS, since_fresh_s_);
    since_fresh_s_ = 0.0;
  }
  if (phase_ == Phase::kClearing) {
    rested_s_ = input.mode == telemetry::GateMode::kOff ? rested_s_ + dt_s : 0.0;
    if (rested_s_ < kClear_s || !input.X_DS) {
      if (phase_s_ > kLongestPhase_s) abort(WeighRefusal::kForcesOff, telemetry::GateFault::kNone);
      return {};
    }
    start_X_DS_ = *input.X_DS;
    turning_axis_ = params_.most_nmm > 0.0 ? turning_axis(start_X_DS_) : Vec3(Vec3::Zero());
    hold_.begin(start_X_DS_);
    enter(Phase::kRising);
  }
  if (phase_ == Phase::kRising && input.mode == telemetry::GateMode::kOn) enter(Phase::kSettling);
  if (phase_ == Phase::kSettling) settle(input, dt_s);
  if (phase_ == Phase::kMoving) add(input);
  check_motion(input);
  return is_running() ? hold(target(), dt_s) : Demand{};
}

StylusWeighing::Demand StylusWeighing::hold(const Pose& X_DT, double dt_s) noexcept {
  Demand demand;
  demand.is_wanted = true;
  demand.weight_D = carried();
  demand.wanted_D = hold_.step(X_DT, demand.weight_D, phase_ != Phase::kRising, dt_s);
  return demand;
}

void StylusWeighing::check_motion(const Input& input) noexcept {
  if (!is_running()) return;
  const Vec3 off_mm = hold_.X_DS().p() - start_X_DS_.p();
  if (phase_ == Phase::kRising || hold_.X_DS().p() != stuck_p_D_) {
    stuck_p_D_ = hold_.X_DS().p();
    stuck_n_ = input.written_D.force_n;
  }
  if ((input.written_D.force_n - stuck_n_).norm() > kMostStuck_n) {
    abort(WeighRefusal::kHeld, telemetry::GateFault::kNone);
  } else if (off_mm.norm() > kTooFar_mm) {
    const bool has_sunk = -off_mm.z() > kSunkShare * off_mm.norm() && hold_.is_at_limit();
    abort(has_sunk ? WeighRefusal::kTooHeavy : WeighRefusal::kMoved, telemetry::GateFault::kNone);
  } else if (phase_ != Phase::kMoving && phase_s_ > kLongestPhase_s) {
    abort(WeighRefusal::kNotAtRest, telemetry::GateFault::kNone);
  }
}

void StylusWeighing::settle(const Input& input, double dt_s) noexcept {
  const bool is_at_rest =
      hold_.v_mm_per_s().norm() < kRest_mm_per_s && (hold_.X_DS().p() - start_X_DS_.p()).norm() < kRest_mm;
  rested_s_ = is_at_rest ? rested_s_ + dt_s : 0.0;
  if (phase_s_ < kLeastRest_s || rested_s_ < kRest_s) return;
  rest_n_ = input.written_D.force_n.z();
  enter(Phase::kMoving);
}

void StylusWeighing::add(const Input& input) noexcept {
  const int number = static_cast<int>(phase_s_ / kLeg_s);
  if (number >= kLegs) {
    end(evaluate());
    return;
  }
  const double mean_s = phase_s_ - number * kLeg_s - (kLeg_s - kMean_s);
  if (mean_s < 0.0) return;
  Leg& leg = legs_[static_cast<std::size_t>(number)];
  const auto part = static_cast<std::size_t>(std::min(kParts * mean_s / kMean_s, kParts - 1.0));
  if (leg.count[0] == 0) leg.first_mm = hold_.X_DS().p().z();
  leg.last_mm = hold_.X_DS().p().z();
  leg.force_n[part] += input.written_D.force_n;
  ++leg.count[part];
  leg.turning_nmm += input.written_D.torque_nmm.dot(turning_axis_);
  leg.level += hold_.X_DS().R().col(2).cross(Vec3::UnitZ()).dot(turning_axis_);
  if (hold_.is_at_limit()) ++leg.at_limit;
  if (hold_.is_at_torque_limit()) ++leg.at_torque_limit;
}

/// tau = (-L z) x (W up), and its part about the axis (z x up)/|z x up| is -L W |z x up|.
std::optional<double> StylusWeighing::lever_mm(double weight_n) const noexcept {
  if (turning_axis_ == Vec3::Zero() || weight_n <= kZero_n) return std::nullopt;
  double turning_nmm = 0.0, level = 0.0;
  for (const Leg& leg : legs_) {
    if (leg.at_torque_limit > 0) return std::nullopt;
    const int count = leg.count[0] + leg.count[1];
    turning_nmm += leg.turning_nmm / count;
    level += leg.level / count;
  }
  const double lever_mm = -turning_nmm / (weight_n * level);
  if (!(std::abs(lever_mm) <= kMostLever_mm)) return std::nullopt;
  return lever_mm;
}

WeighResult StylusWeighing::evaluate() const noexcept {
  WeighResult result;
  result.limit_n = std::min(continuous_n_, params_.most_n);
  for (const Leg& leg : legs_)
    if (*std::min_element(leg.count.begin(), leg.count.end()) == 0) {  // a period longer than a part
      result.refusal = WeighRefusal::kUnsteady;
      return result;
    }
  std::array<Vec3, 2> means{Vec3::Zero(), Vec3::Zero()};  // up, down
  for (std::size_t i = 0; i < legs_.size(); ++i)
    for (std::size_t part = 0; part < kParts; ++part)
      means[i % 2] += legs_[i].force_n[part] / legs_[i].count[part] / (kLegs / 2 * kParts);
  for (std::size_t i = 0; i < legs_.size(); ++i)
    for (std::size_t part = 0; part < kParts; ++part) {
      const Vec3 off_n = legs_[i].force_n[part] / legs_[i].count[part] - means[i % 2];
      result.spread_n = std::max(result.spread_n, off_n.norm());
    }
  const Vec3 mean_n = 0.5 * (means[0] + means[1]);
  result.weight_n = std::abs(mean_n.z()) < kZero_n ? 0.0 : mean_n.z();
  result.friction_n = 0.5 * (means[0].z() - means[1].z());
  result.horizontal_n = mean_n.head<2>().norm();
  result.lever_mm = lever_mm(result.weight_n);
  result.refusal = find_refusal(result);
  return result;
}

WeighRefusal StylusWeighing::find_refusal(const WeighResult& result) const noexcept {
  bool is_at_limit = false, has_followed = true;
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    const Leg& leg = legs_[i];
    const double way_mm = (i % 2 == 0 ? 1.0 : -1.0) * (leg.last_mm - leg.first_mm);
    if (leg.at_limit > kMostAtLimit * (leg.count[0] + leg.count[1])) is_at_limit = true;
    if (way_mm < kLeastFollowed * kWay_mm * kMean_s / kLeg_s) has_followed = false;
  }
  // At rest, a heavy stylus already needs too much; one in a hand only when it is lifted.
  if (is_at_limit) return rest_n_ > result.limit_n ? WeighRefusal::kTooHeavy : WeighRefusal::kHeld;
  if (!has_followed) return WeighRefusal::kHeld;
  if (result.spread_n > kMostSpread_n) return WeighRefusal::kUnsteady;
  if (result.weight_n > result.limit_n) return WeighRefusal::kTooHeavy;
  return result.weight_n < 0.0 ? WeighRefusal::kPullsUp : WeighRefusal::kNone;
}

}  // namespace trocar::server
