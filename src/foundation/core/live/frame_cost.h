#pragma once

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
}  // namespace trocar
