#pragma once

#include <cstddef>
#include <vector>

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

namespace trocar::ultrasound::detail {

/// One scanline at all steering angles: working memory of spread_echoes. Each task has its own.
class SteeringRows {
 public:
  SteeringRows() = default;
  explicit SteeringRows(const ScanPlan& plan);

  /// Samples of one angle, with zeros before and behind them.
  float* re(std::size_t angle) noexcept { return values_.data() + 2 * angle * stride_ + kPad; }
  float* im(std::size_t angle) noexcept { return re(angle) + stride_; }
  /// Zeroes the values beyond the last sample, which vector instructions overwrite.
  void clear_padding() noexcept;

 private:
  std::size_t stride_ = 0, samples_ = 0, angles_ = 1;
  std::vector<float> values_;
};

/// Finds FrameState::loudest of a scanline. Call after all echoes.
void find_loudest(const ScanPlan& plan, FrameState& frame, int line) noexcept;

/// Spreads the echoes `re` and `im` of all scanlines, laterally and along the pulse, to one scanline's samples of every
/// angle.
void spread_echoes(const ScanPlan& plan, const FrameState& frame, int line, SteeringRows& rows,
                   BasebandFrame& out) noexcept;

/// gain[s] = exp(log_gain[s] + added[s]), or 0 if that is negligible. Both inputs must extend 16 floats beyond n.
void to_gain(const float* log_gain, const float* added, int n, float* gain) noexcept;

}  // namespace trocar::ultrasound::detail
