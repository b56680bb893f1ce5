#include "motion/patient_motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trocar::motion {

PatientMotion::PatientMotion(const MotionModel* model, const MotionState& state) noexcept
    : model_(model), state_(state) {
  for (double& driver : state_.drivers) driver = std::clamp(driver, -kMostDrive, kMostDrive);
}

Vec3 PatientMotion::moved(const Vec3& p_A) const noexcept {
  return p_A + model_->displacement_mm(model_->region_of(p_A), p_A, state_.drivers);
}

/// Newton's method from the displacement at p_P: the displacement is a contraction (kMostGradient), so it converges.
Vec3 PatientMotion::resting_in(int region, const Vec3& p_P) const noexcept {
  constexpr int kMostSteps = 12;
  constexpr double kClose_mm = 1e-7;
  Vec3 p_A = p_P - model_->displacement_mm(region, p_P, state_.drivers);
  for (int step = 0; step < kMostSteps; ++step) {
    const MotionModel::Field here = model_->field(region, p_A, state_.drivers);
    const Vec3 error = p_A + here.displacement_mm - p_P;
    if (error.squaredNorm() < kClose_mm * kClose_mm) break;
    p_A -= (Mat3::Identity() + here.gradient).inverse() * error;
  }
  return p_A;
}

Vec3 PatientMotion::resting(const Vec3& p_P) const noexcept {
  Vec3 nearest_A = p_P;
  double least_mm = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(model_->parts().regions.size());
  for (int region = 0; region < count; ++region) {
    const Vec3 p_A = resting_in(region, p_P);
    const double outside_mm = model_->outside_mm(region, p_A);
    if (!(outside_mm < least_mm)) continue;
    nearest_A = p_A;
    least_mm = outside_mm;
    if (outside_mm == 0.0) break;
  }
  return nearest_A;
}

Mat3 PatientMotion::jacobian(const Vec3& p_A) const noexcept {
  if (model_ == nullptr) return Mat3::Identity();
  return Mat3::Identity() + model_->field(model_->region_of(p_A), p_A, state_.drivers).gradient;
}

PatientMotion::Moved PatientMotion::moved_with_jacobian(const Vec3& p_A) const noexcept {
  if (model_ == nullptr) return {p_A, Mat3::Identity()};
  const MotionModel::Field here = model_->field(model_->region_of(p_A), p_A, state_.drivers);
  return {p_A + here.displacement_mm, Mat3::Identity() + here.gradient};
}

double PatientMotion::most_shift_mm(const PatientMotion& other) const noexcept {
  if (model_ != other.model_) return std::numeric_limits<double>::infinity();
  if (model_ == nullptr) return 0.0;
  double sum_mm = 0.0;
  for (const MotionMode& mode : model_->parts().modes) {
    const auto driver = static_cast<std::size_t>(mode.driver);
    sum_mm += std::abs(state_.drivers[driver] - other.state_.drivers[driver]) * mode.displacement_mm.norm();
  }
  return sum_mm;
}

bool PatientMotion::is_finite() const noexcept {
  const auto is_number = [](double value) { return std::isfinite(value); };
  return is_number(state_.time_s) && is_number(state_.phase) && std::ranges::all_of(state_.drivers, is_number) &&
         std::ranges::all_of(state_.rates_per_s, is_number);
}

Vec3 PatientMotion::velocity(const Vec3& p_A) const noexcept {
  if (model_ == nullptr) return Vec3::Zero();
  return model_->displacement_mm(model_->region_of(p_A), p_A, state_.rates_per_s);
}

Vec3 PatientMotion::line_to_now(const Vec3& p_A, const Vec3& v_A) const noexcept {
  return model_ == nullptr ? v_A : Vec3(jacobian(p_A) * v_A);
}

Vec3 PatientMotion::line_to_rest(const Vec3& p_A, const Vec3& v_P) const noexcept {
  return model_ == nullptr ? v_P : Vec3(jacobian(p_A).inverse() * v_P);
}

Vec3 PatientMotion::gradient_to_now(const Vec3& p_A, const Vec3& g_A) const noexcept {
  return model_ == nullptr ? g_A : Vec3(jacobian(p_A).inverse().transpose() * g_A);
}

Status check(const MotionDrive& drive) {
  constexpr double kShortest_s = 1.0, kLongest_s = 60.0, kMostTime_s = 1e9;
  const bool has_depth = std::ranges::all_of(drive.depth, [](double d) { return std::abs(d) <= kMostDrive; });
  if (!(drive.period_s >= kShortest_s && drive.period_s <= kLongest_s) || !(std::abs(drive.begins_s) <= kMostTime_s) ||
      !(drive.held_phase >= 0.0 && drive.held_phase <= 1.0) || !has_depth)
    return fail("a number is out of its range", "motion of the patient",
                "use a period of 1 to 60 s, a phase of 0 to 1 and depths of at most 1.5");
  return {};
}

double phase_at(const MotionDrive& drive, double time_s) noexcept {
  if (drive.is_held) return drive.held_phase;
  const double breaths = (time_s - drive.begins_s) / drive.period_s;
  return breaths - std::floor(breaths);
}

MotionState state_of_phase(const MotionDrive& drive, double phase, double time_s) noexcept {
  MotionState state;
  state.time_s = time_s;
  state.phase = phase;
  const double angle = 2.0 * std::numbers::pi * phase;
  const double share = 0.5 * (1.0 - std::cos(angle));
  const double share_per_s = drive.is_held ? 0.0 : std::numbers::pi / drive.period_s * std::sin(angle);
  for (std::size_t i = 0; i < kMostDrivers; ++i) {
    state.drivers[i] = drive.depth[i] * share;
    state.rates_per_s[i] = drive.depth[i] * share_per_s;
  }
  return state;
}

}  // namespace trocar::motion
