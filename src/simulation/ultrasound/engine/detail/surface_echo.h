#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Echoes of the borders that a scanline crosses (docs/physics.md U6).
namespace trocar::ultrasound::detail {

/// Adds the surface echoes of all planes to scanlines [first, last), and stores their reflectors. Call after all
/// scanlines were walked.
void add_surface_echoes(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

}  // namespace trocar::ultrasound::detail
