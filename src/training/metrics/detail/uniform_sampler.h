#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

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

/// The needle's way without the noise of its recording: from its first moment through the means of a UniformSampler to
/// its last one. Noise adds to a length with every moment: 0.02 mm at 1 kHz make five times the length of a way.
class SmoothPath {
 public:
  struct Point {
    Vec3 tip_P, axis_P;
    double depth_mm = 0.0;  ///< 0 where the recording has none.
    double inside = 0.0;    ///< Share of the way about it that lies in the body, 0..1.
  };

  /// Calls visit(from, to) for each new piece of the way. A gap of the recording is one straight piece; none leads over
  /// a pause.
  template <class Visit>
  void add(const Step& step, Visit&& visit) {
    const bool is_joined = step.before != nullptr && step.dt_s <= UniformSampler::kLongestGap_s;
    if (!is_joined) {
      finish(visit);
      Point next = point_of(step.now);
      if (step.before != nullptr) {
        const Point before = point_of(*step.before);
        next.inside = share_inside(before.depth_mm, next.depth_mm, (next.tip_P - before.tip_P).norm());
        visit(before, next);
      }
      last_ = point_of(step.now);
    }
    now_ = point_of(step.now);
    sampler_.add(step, [&](const UniformSampler::Sample& sample) {
      const Point mean{sample.tip_P, sample.axis_P.normalized(), sample.depth_mm, sample.inside};
      visit(*last_, mean);
      last_ = mean;
    });
  }
  /// The piece from the last mean to the last moment.
  template <class Visit>
  void finish(Visit&& visit) const {
    if (last_ && now_) visit(*last_, *now_);
  }

 private:
  static Point point_of(const Moment& moment) {
    const double depth_mm = moment.depth_mm.value_or(0.0);
    return {moment.tip_P, moment.axis_P, depth_mm, depth_mm > 0.0 ? 1.0 : 0.0};
  }

  UniformSampler sampler_;
  std::optional<Point> last_, now_;  ///< The end of the way so far; the last moment.
};

inline constexpr double kTremor_mm = 1.0;  ///< Smaller motions to and fro do not count as travel.

/// Inward and outward strokes of a depth: a turn counts when the depth has come back by more than a threshold, so that
/// tremor is no turn. Begins at depth 0; with `is_going_in` the first advance counts from there, however small.
class Strokes {
 public:
  enum class Turn { kNone, kIn, kOut };

  explicit Strokes(double threshold_mm, bool is_going_in = false)
      : threshold_mm_(threshold_mm), is_going_in_(is_going_in) {}

  Turn add(double depth_mm) noexcept {
    if (is_going_in_) {
      travel_mm_ += std::max(0.0, depth_mm - turn_mm_);
      is_going_in_ = depth_mm > turn_mm_ - threshold_mm_;
      turn_mm_ = is_going_in_ ? std::max(turn_mm_, depth_mm) : depth_mm;
      return is_going_in_ ? Turn::kNone : Turn::kOut;
    }
    is_going_in_ = depth_mm > turn_mm_ + threshold_mm_;
    if (is_going_in_) travel_mm_ += depth_mm - turn_mm_;
    turn_mm_ = is_going_in_ ? depth_mm : std::min(turn_mm_, depth_mm);
    return is_going_in_ ? Turn::kIn : Turn::kNone;
  }
  /// Length of all inward strokes, mm.
  double travel_mm() const noexcept { return travel_mm_; }

 private:
  double threshold_mm_;
  double turn_mm_ = 0.0;  // the deepest point during insertion, the shallowest during withdrawal
  double travel_mm_ = 0.0;
  bool is_going_in_;
};

/// Median over time of a value in 0..largest, from a histogram: accurate to half of a bin. Larger values count as
/// `largest`.
class TimeMedian {
 public:
  TimeMedian(double largest, double bin) : bin_(bin), seconds_(static_cast<std::size_t>(largest / bin) + 1, 0.0) {}

  void add(double value, double dt_s) {
    const auto n = static_cast<std::size_t>(std::max(0.0, value) / bin_);
    seconds_[std::min(n, seconds_.size() - 1)] += dt_s;
    total_s_ += dt_s;
  }
  /// Empty: no time was added.
  std::optional<double> median() const {
    if (!(total_s_ > 0.0)) return std::nullopt;
    double sum_s = 0.0;
    for (std::size_t n = 0; n < seconds_.size(); ++n) {
      sum_s += seconds_[n];
      if (sum_s >= 0.5 * total_s_) return (static_cast<double>(n) + 0.5) * bin_;
    }
    return static_cast<double>(seconds_.size()) * bin_;
  }

 private:
  double bin_;
  std::vector<double> seconds_;  ///< By bin.
  double total_s_ = 0.0;
};

/// Spectral arc length of a speed profile at equal intervals (Balasubramanian 2015): minus the length of the amplitude
/// spectrum, divided by its value at 0 Hz, over the frequency divided by the highest one. The highest frequency is the
/// last one up to 10 Hz at which the spectrum is 0.05 or more. 0 would be perfectly smooth. Empty: no motion.
std::optional<double> spectral_arc_length(const std::vector<double>& speed, double period_s);

}  // namespace trocar::metrics::detail
