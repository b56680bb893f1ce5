#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace trocar::trainer {

/// Frame statistics of the window for the status bar: mean rate, the slowest frame of the last second and the late
/// frames of the attempt.
struct FrameFigures {
  double per_s = 0.0;
  double slowest_ms = 0.0;
  std::uint64_t late = 0;  ///< Frames of `judged` that took more than kLate_s.
  std::uint64_t judged = 0;

  bool operator==(const FrameFigures&) const = default;
};

class FrameCount {
 public:
  static constexpr double kLate_s = 0.1;  ///< A visible jump. [assumed]
  static constexpr double kOver_s = 1.0;

  /// Restarts the count of late frames.
  void restart() noexcept { late_ = judged_ = 0; }
  /// Records a drawn frame; `is_judged`: during an attempt.
  void add(double now_s, bool is_judged);
  /// Time since the last frame; 0 before the first frame.
  double since_last_s(double now_s) const noexcept { return drawn_s_.empty() ? 0.0 : now_s - drawn_s_.back(); }
  /// Empty within the first half second.
  std::optional<FrameFigures> figures() const;
  std::uint64_t late() const noexcept { return late_; }

 private:
  std::deque<double> drawn_s_;  ///< Times of the frames of the last second.
  std::uint64_t late_ = 0;
  std::uint64_t judged_ = 0;
};

}  // namespace trocar::trainer
