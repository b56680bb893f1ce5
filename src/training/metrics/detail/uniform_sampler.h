#pragma once

#include <algorithm>
#include <cmath>

#include "metrics/detail/body.h"
#include "metrics/metric.h"

namespace trocar::metrics::detail {

/// The needle at equal intervals of active time: means over kPeriod_s of the recording, which is linear between its
/// moments. Derivatives of these means do not depend on the recording's rate and noise above 12 Hz is reduced.
class UniformSampler {
 public:
  static constexpr double kPeriod_s = 0.04;     ///< Voluntary motion of a hand has frequencies below 10 Hz.
  static constexpr double kLongestGap_s = 1.0;  ///< Nothing is known in a longer gap of the recording.

  struct Sample {
    Vec3 tip_P, axis_P;      ///< The axis is a mean of unit vectors, not normalised.
    double depth_mm = 0.0;   ///< 0 where the recording has none.
    double inside = 0.0;     ///< Share of its way that lies in the body, 0..1.
    bool is_joined = false;  ///< It follows the sample before without a gap.
  };

  template <class Take>
  void add(const Step& step, Take&& take) {
    if (step.before == nullptr || step.dt_s > kLongestGap_s) {
      restart();
      return;
    }
    const double depth_before_mm = step.before->depth_mm.value_or(0.0), depth_now_mm = step.now.depth_mm.value_or(0.0);
    const double share = share_inside(depth_before_mm, depth_now_mm, (step.now.tip_P - step.before->tip_P).norm());
    double from = 0.0;  // fraction of the step
    for (bool is_full = true; is_full;) {
      const double part_s = std::min(kPeriod_s - filled_s_, step.dt_s * (1.0 - from));
      const double to = from + part_s / step.dt_s;
      const double middle = 0.5 * (from + to);
      tip_ += part_s * (step.before->tip_P + middle * (step.now.tip_P - step.before->tip_P));
      depth_ += part_s * std::lerp(depth_before_mm, depth_now_mm, middle);
      inside_ += part_s * share;
      axis_ += part_s * (step.before->axis_P + middle * (step.now.axis_P - step.before->axis_P));
      filled_s_ += part_s;
      from = to;
      is_full = filled_s_ >= kPeriod_s * (1.0 - 1e-9);
      if (!is_full) break;
      const Sample sample{tip_ / filled_s_, axis_ / filled_s_, depth_ / filled_s_, inside_ / filled_s_, is_joined_};
      restart();
      is_joined_ = true;
      take(sample);
    }
  }

 private:
  void restart() noexcept {
    tip_ = axis_ = Vec3::Zero();
    depth_ = inside_ = filled_s_ = 0.0;
    is_joined_ = false;
  }

  Vec3 tip_ = Vec3::Zero(), axis_ = Vec3::Zero();  // integrals over the present interval
  double depth_ = 0.0, inside_ = 0.0, filled_s_ = 0.0;
  bool is_joined_ = false;
};

}  // namespace trocar::metrics::detail
