#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

namespace trocar::ultrasound::detail {

/// Groups of the scene's points that are close to each other.
std::vector<PointGroup> group_points(const AcousticScene& scene);

/// Adds the echoes of the scene's single points. The points follow the tissue: pressure, refraction and delay apply to
/// them. On scanlines [first, last).
void add_points(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

}  // namespace trocar::ultrasound::detail
