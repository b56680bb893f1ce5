#pragma once

#include "ultrasound/b_mode.h"
#include "ultrasound/detail/frame_state.h"
#include "ultrasound/detail/scan_plan.h"

namespace trocar::detail {

/// Lateral point spread of scanlines [first, last): from `re`, `im` to `wide_re`, `wide_im`.
void spread_laterally(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;
/// The pulse: from `wide_re`, `wide_im` to the frame's own samples.
void spread_axially(const ScanPlan& plan, const FrameState& frame, int first, int last, BasebandFrame& out) noexcept;

/// gain[s] = exp(log_gain[s] + added[s]), 0 where that is nothing. Both inputs reach 16 floats beyond n.
void to_gain(const float* log_gain, const float* added, int n, float* gain) noexcept;

}  // namespace trocar::detail
