#pragma once

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Multiple reflections (docs/physics.md U7).
namespace trocar::ultrasound::detail {

/// Adds ring-down behind gas on one scanline, before the point spread.
void add_ring_down(const ScanPlan& plan, FrameState& frame, int line) noexcept;
/// Adds echoes between the face and a smooth reflector perpendicular to the scanline: all echoes repeat, each time
/// deeper by the reflector's depth (A-lines).
void add_reverberation(const ScanPlan& plan, const FrameState& frame, int angle, int line, BasebandFrame& out) noexcept;

}  // namespace trocar::ultrasound::detail
