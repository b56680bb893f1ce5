#include "motion/patient_motion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/sampling.h"

namespace trocar::motion {

PatientMotion::PatientMotion(const MotionModel* model, const MotionState& state) noexcept
    : model_(model), state_(state) {
  if (model_ == nullptr) return;
  for (std::size_t d = 0; d < kMostDrivers; ++d)
    drives_[d] = std::clamp(state_.drivers[d], kLeastDrive, kMostDrive) - model_->parts().at_ct[d];
  slide_mm_ = model_->most_slide_mm(drives_);
}

Vec3 PatientMotion::moved(const Vec3& p_A) const noexcept {
  return p_A + model_->displacement_mm(model_->region_of(p_A), p_A, drives_);
}

/// Newton's method: the map of a region is strictly monotone (kMostShortening). The error of a step is about the square
/// of that before it (mm): the last one is not evaluated again.
Vec3 PatientMotion::resting_in(int region, const Vec3& p_P) const noexcept {
  constexpr int kMostSteps = 12;
  constexpr double kClose_mm = 3e-3;
  Vec3 p_A = p_P;
  for (int step = 0; step < kMostSteps; ++step) {
    const MotionModel::Field here = model_->field(region, p_A, drives_);
    const Vec3 error = p_A + here.displacement_mm - p_P;
    p_A -= (Mat3::Identity() + here.gradient).inverse() * error;
    if (error.squaredNorm() < kClose_mm * kClose_mm) break;
  }
  return p_A;
}

/// The region whose tissue is deeper in it than the other region's tissue at the same place is in the other one.
Vec3 PatientMotion::resting(const Vec3& p_P) const noexcept {
  constexpr double kSteepestBorder = 1.5;
  const int first = model_->region_of(p_P);
  const Vec3 first_A = resting_in(first, p_P);
  if (model_->parts().regions.size() == 1) return first_A;
  const double sign = first == 0 ? -1.0 : 1.0;
  const double depth_mm = sign * model_->depth_mm(first_A);
  // The other region's tissue rests within slide_mm_ of this.
  if (2.0 * depth_mm > kSteepestBorder * slide_mm_) return first_A;
  const Vec3 other_A = resting_in(1 - first, p_P);
  const bool is_first = depth_mm + sign * model_->depth_mm(other_A) >= 0.0;
  return is_first ? within(first, first_A) : within(1 - first, other_A);
}

/// The point, or the nearest one of the region: in a gap, the tissue of its edge.
Vec3 PatientMotion::within(int region, Vec3 p_A) const noexcept {
  constexpr int kMostSteps = 3;
  constexpr double kInside_mm = 1e-3, kFlat = 0.1;
  const double sign = region == 0 ? -1.0 : 1.0;
  for (int step = 0; step < kMostSteps; ++step) {
    const double depth_mm = sign * model_->depth_mm(p_A);
    if (depth_mm > 0.0) break;
    const Vec3 slope = sign * volume::gradient_per_mm(model_->parts().border_mm, p_A);
    p_A += (kInside_mm - depth_mm) / std::max(slope.squaredNorm(), kFlat) * slope;
  }
  return p_A;
}

Mat3 PatientMotion::jacobian(const Vec3& p_A) const noexcept {
  if (model_ == nullptr) return Mat3::Identity();
  return Mat3::Identity() + model_->field(model_->region_of(p_A), p_A, drives_).gradient;
}

PatientMotion::Moved PatientMotion::moved_with_jacobian(const Vec3& p_A) const noexcept {
  if (model_ == nullptr) return {p_A, Mat3::Identity()};
  const MotionModel::Field here = model_->field(model_->region_of(p_A), p_A, drives_);
  return {p_A + here.displacement_mm, Mat3::Identity() + here.gradient};
}

double PatientMotion::most_shift_mm(const PatientMotion& other) const noexcept {
  if (model_ != other.model_) return std::numeric_limits<double>::infinity();
  if (model_ == nullptr) return 0.0;
  MotionModel::Scalars apart{};
  for (std::size_t d = 0; d < kMostDrivers; ++d) apart[d] = drives_[d] - other.drives_[d];
  return model_->most_displacement_mm(apart);
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

}  // namespace trocar::motion
