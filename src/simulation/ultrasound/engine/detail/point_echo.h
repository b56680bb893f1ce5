#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

namespace trocar::ultrasound::detail {

/// Adds the echoes of the scene's single points. They follow the tissue: pressed, bent, late as it is.
void add_points(const ScanPlan& plan, FrameState& frame) noexcept;

}  // namespace trocar::ultrasound::detail
