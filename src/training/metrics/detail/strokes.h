#pragma once

#include <algorithm>

namespace trocar::metrics::detail {

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

}  // namespace trocar::metrics::detail
