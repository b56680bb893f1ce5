#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace trocar {
inline namespace core {

/// Predicts how long a frame takes at each level of detail, from the measured times of earlier frames, and selects a
/// level. Level 0 is the coarsest. The work of a frame is a nominal number in any unit; the time per unit of work, and
/// a correction for each level, are learned.
class FrameCost {
 public:
  explicit FrameCost(std::size_t levels) : corrections_(levels, 1.0) {}

  /// Expected time of a frame, ms; empty before the first measurement.
  std::optional<double> expected_ms(std::size_t level, double work) const noexcept;
  /// Records that a frame of that level and work took `took_ms`. Times <= 0 are ignored.
  void note(std::size_t level, double work, double took_ms) noexcept;
  /// The finest level whose expected time is at most `target_ms`, the coarsest before the first measurement. `work` has
  /// one value per level. Hysteresis: a level finer than the one selected last must leave a fifth of the time unused.
  std::size_t select_level(std::span<const double> work, double target_ms) noexcept;

 private:
  std::optional<double> ms_per_work_;
  std::vector<double> corrections_;  ///< Measured time of each level relative to its nominal work.
  std::size_t selected_ = 0;
};

}  // namespace core
inline namespace core {

/// Times of a live image.
struct LivePace {
  double moving_ms = 55.0;  ///< Longest frame while requests change: 15 frames a second leave 66 ms. Range 10..500.
  double still_s = 0.3;     ///< A request that is unchanged for this time gets full detail. Range 0..5.
  double busy_share = 0.5;  ///< Greatest share of the time for frames of an unchanged request. Range 0.05..1.
};

/// Decides when a frame is due and at which level of detail, from requests and measured times. It reads no clock: time
/// is an argument. While requests change, it selects the finest level whose time stays within the pace. An unchanged
/// request gets full detail, then a frame at each refresh time.
///
/// `Traits` describes requests and levels:
///   using Request, using Level (an enum from 0, the coarsest), static constexpr std::size_t kLevels;
///   LivePace pace() const;
///   bool is_same(const Request&, const Request&) const: an image of one also serves the other;
///   double work(const Request&, Level) const: nominal work of a frame, any unit;
///   double refresh_s(const Request&) const: between frames of an unchanged request.
template <class Traits>
class LiveSchedule {
 public:
  using Request = typename Traits::Request;
  using Level = typename Traits::Level;
  static constexpr Level kFinest = static_cast<Level>(Traits::kLevels - 1);

  explicit LiveSchedule(Traits traits = {}) : traits_(std::move(traits)) {}

  /// The level of the frame that is due for a request; empty if no frame is due. now_s must not decrease.
  std::optional<Level> due(const Request& request, double now_s) {
    if (!anchor_ || !traits_.is_same(*anchor_, request)) {
      anchor_ = request;
      moved_s_ = now_s;
    }
    const LivePace pace = traits_.pace();
    const bool is_still = now_s - moved_s_ >= pace.still_s;
    if (shown_ && traits_.is_same(*shown_, request)) {
      if (is_still && shown_level_ != kFinest) return kFinest;
      const double refresh_s =
          std::max(traits_.refresh_s(request), 1e-3 * shown_ms_ / std::clamp(pace.busy_share, 0.05, 1.0));
      if (now_s - shown_s_ < refresh_s) return std::nullopt;
    }
    return is_still ? kFinest : level_while_moving(request, pace.moving_ms);
  }

  /// Records a finished frame of that request: it began at begun_s and its computation took took_ms.
  void note_frame(const Request& request, Level level, double begun_s, double took_ms) {
    shown_ = request;
    shown_level_ = level;
    shown_s_ = begun_s;
    shown_ms_ = took_ms;
    cost_.note(static_cast<std::size_t>(level), traits_.work(request, level), took_ms);
  }

  /// Starts with another subject: a frame is due for the next request. Learned costs are kept.
  void restart() noexcept {
    anchor_.reset();
    shown_.reset();
  }

 private:
  Level level_while_moving(const Request& request, double target_ms) {
    std::array<double, Traits::kLevels> work{};
    for (std::size_t level = 0; level < work.size(); ++level)
      work[level] = traits_.work(request, static_cast<Level>(level));
    return static_cast<Level>(cost_.select_level(work, target_ms));
  }

  Traits traits_;
  FrameCost cost_{Traits::kLevels};
  std::optional<Request> anchor_;  ///< First request of the present unchanged series.
  double moved_s_ = 0.0;           ///< Time of the anchor.
  std::optional<Request> shown_;
  Level shown_level_{};
  double shown_s_ = 0.0;
  double shown_ms_ = 0.0;
};

}  // namespace core
inline namespace core {

/// Adds to the niceness of the calling thread, if the system has one per thread (Linux). A failure is ignored.
void lower_priority(int nice) noexcept;

}  // namespace core
}  // namespace trocar
