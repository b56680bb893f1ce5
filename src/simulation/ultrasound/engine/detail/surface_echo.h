#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Echoes of the borders that a scanline crosses (docs/physics.md U6).
namespace trocar::ultrasound::detail {

/// Adds surface echoes to the scanline, weighted as plane `plane` of the beam; on the central plane, stores the
/// reflector. Call after all scanlines were walked.
void add_surface_echoes(const ScanPlan& plan, FrameState& frame, int line, int plane) noexcept;

}  // namespace trocar::ultrasound::detail
