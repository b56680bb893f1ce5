#pragma once

#include <vector>

#include "ultrasound/detail/scatterer_bricks.h"

namespace trocar::detail {

/// Adds the echoes of all scatterers that scanlines [first, last) hear. Each task writes to its own scanlines.
void add_scatterers(const ScanPlan& plan, const std::vector<Brick>& library, FrameState& frame, int first,
                    int last) noexcept;

}  // namespace trocar::detail
