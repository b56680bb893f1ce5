#pragma once

#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"

namespace trocar::attempt {

/// Thins ticks to the resolution of a plot: keeps the lowest and the highest force of each time interval (kStretch_s),
/// in their order. All peaks are kept, and a second has 150 points at most.
class ForceTrace {
 public:
  static constexpr double kStretch_s = 0.02;

  void add(const ForcePoint& point) {
    if (!has_any_) {
      begin(point);
      return;
    }
    if (point.force_n < low_.force_n) low_ = point;
    if (point.force_n > high_.force_n) high_ = point;
    last_ = point;
    if (point.time_s - from_s_ >= kStretch_s) flush();
  }
  /// Returns the points of the finished intervals; the current interval stays.
  std::vector<ForcePoint> take() { return std::exchange(points_, {}); }
  /// Ends the current interval.
  void flush() {
    if (!has_any_) return;
    const bool is_low_first = low_.time_s <= high_.time_s;
    const ForcePoint& first = is_low_first ? low_ : high_;
    const ForcePoint& second = is_low_first ? high_ : low_;
    points_.push_back(first);
    if (second.time_s > first.time_s) points_.push_back(second);
    if (last_.time_s > points_.back().time_s) points_.push_back(last_);
    has_any_ = false;
  }

 private:
  void begin(const ForcePoint& point) {
    low_ = high_ = last_ = point;
    from_s_ = point.time_s;
    has_any_ = true;
  }

  std::vector<ForcePoint> points_;
  ForcePoint low_, high_, last_;
  double from_s_ = 0.0;
  bool has_any_ = false;
};

}  // namespace trocar::attempt
