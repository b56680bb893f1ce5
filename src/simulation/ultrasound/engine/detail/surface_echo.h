#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Echoes of the borders that a scanline crosses (docs/physics.md U6).
namespace trocar::ultrasound::detail {

/// After all scanlines were walked: adds them to the scanline, weighted as plane `plane` of the beam; of the central
/// plane notes the reflector.
void add_surface_echoes(const ScanPlan& plan, FrameState& frame, int line, int plane) noexcept;

}  // namespace trocar::ultrasound::detail
