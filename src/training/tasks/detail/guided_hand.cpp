#include "tasks/detail/guided_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tasks/fit_to_patient.h"

namespace trocar::tasks {
namespace {

constexpr double kTremorLow_hz = 8.0;  // band: Lakie 2015 (6-12 Hz), Murbe 2001 (mean 8.1 Hz)
constexpr double kTremorHigh_hz = 12.0;
constexpr double kTremorAlongNeedle = 0.1;  // assumed

constexpr double kSpeedSmoothing_s = 0.06;  // of each of two stages; assumed
constexpr double kMaxLead_mm = 12.0;        // lead of the hand over the device: 7 N at 0.6 N/mm; assumed
constexpr double kBracedPush = 1.5;         // a braced hand pushes with as many times the force; assumed
constexpr double kFeeling_s = 0.02;         // assumed
constexpr double kTouch_n = 0.15;           // assumed; below the threshold of a fingertip
constexpr double kLeastDrop_n = 0.3;        // assumed
constexpr double kDropShare = 0.3;          // of the peak: well above the 7 % of Pang, Tan, Durlach

double smoothing(double dt_s, double time_constant_s) noexcept {
  return 1.0 - std::exp(-dt_s / time_constant_s);
}

}  // namespace

Tremor::Tremor(double rms_mm, std::uint64_t seed) noexcept {
  Random random(seed);
  const double amplitude_mm = rms_mm * std::sqrt(2.0 / static_cast<double>(kSines));
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (Sine& sine : axes_[axis]) {
      sine.amplitude_mm = amplitude_mm * (axis == 2 ? kTremorAlongNeedle : 1.0);
      sine.angular_rad_s = 2.0 * std::numbers::pi * random.uniform(kTremorLow_hz, kTremorHigh_hz);
      sine.phase_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
}

Vec3 Tremor::offset_N(double time_s) const noexcept {
  Vec3 offset = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Sine& sine : axes_[axis])
      offset[static_cast<Eigen::Index>(axis)] +=
          sine.amplitude_mm * std::sin(sine.angular_rad_s * time_s + sine.phase_rad);
  return offset;
}

Vec3 Tremor::velocity_N(double time_s) const noexcept {
  Vec3 velocity = Vec3::Zero();
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Sine& sine : axes_[axis])
      velocity[static_cast<Eigen::Index>(axis)] +=
          sine.amplitude_mm * sine.angular_rad_s * std::cos(sine.angular_rad_s * time_s + sine.phase_rad);
  return velocity;
}

GuidedHand::GuidedHand(const Segment& line_P, const std::optional<Vec3>& bevel_P, double start_mm, const Tremor& tremor,
                       double grip) noexcept
    : start_P_(line_P.a),
      axis_P_(line_P.direction()),
      R_PN_(bevel_P ? needle_rotation(axis_P_, *bevel_P) : needle_pose(line_P.a, axis_P_).R()),
      tremor_(tremor),
      grip_(grip),
      wanted_mm_(start_mm),
      device_mm_(start_mm),
      tip_mm_(start_mm) {}

void GuidedHand::turn_to(const Segment& line_P, const std::optional<Vec3>& bevel_P) noexcept {
  start_P_ = line_P.a;
  axis_P_ = line_P.direction();
  R_PN_ = bevel_P ? needle_rotation(axis_P_, *bevel_P) : needle_pose(line_P.a, axis_P_).R();
}

void GuidedHand::sense(const OperatorView& view) noexcept {
  has_felt_drop_ = false;
  if (is_first_) {  // nothing detected yet
    is_first_ = false;
    start_time_s_ = view.time_s;
    return;
  }
  elapsed_s_ = view.time_s - start_time_s_;
  device_mm_ = (view.X_PN_device.p() - start_P_).dot(axis_P_);
  tip_mm_ = (view.last.tip_mm - start_P_).dot(axis_P_);
  const Vec3 felt_P = view.last.device_f_n - view.last.f_weight_n;  // the rest only holds the stylus
  push_n_ += (-felt_P.dot(axis_P_) - push_n_) * smoothing(view.dt_s, kFeeling_s);
  is_touching_ = push_n_ > kTouch_n || view.last.phase != telemetry::InsertionPhase::kOutside;

  peak_push_n_ = std::max(peak_push_n_, push_n_);
  if (peak_push_n_ - push_n_ > std::max(kLeastDrop_n, kDropShare * peak_push_n_)) {
    has_felt_drop_ = true;
    peak_push_n_ = push_n_;
  }
}

void GuidedHand::move(double speed_mm_s, double dt_s) noexcept {
  const double share = smoothing(dt_s, kSpeedSmoothing_s);
  speed_ahead_mm_s_ += (speed_mm_s - speed_ahead_mm_s_) * share;
  speed_mm_s_ += (speed_ahead_mm_s_ - speed_mm_s_) * share;
  const double unlimited_mm = wanted_mm_ + speed_mm_s_ * dt_s;
  const double lead_mm = kMaxLead_mm / grip_ * (grip_ > 1.0 ? kBracedPush : 1.0);
  wanted_mm_ = std::clamp(unlimited_mm, device_mm_ - lead_mm, device_mm_ + lead_mm);
  if (wanted_mm_ != unlimited_mm) speed_ahead_mm_s_ = speed_mm_s_ = 0.0;
}

HandCommand GuidedHand::command() const noexcept {
  HandCommand command;
  command.X_PN = Pose(R_PN_, start_P_ + wanted_mm_ * axis_P_ + R_PN_ * tremor_.offset_N(elapsed_s_));
  command.grip = grip_;
  command.v_P = speed_mm_s_ * axis_P_ + R_PN_ * tremor_.velocity_N(elapsed_s_);
  return command;
}

}  // namespace trocar::tasks
