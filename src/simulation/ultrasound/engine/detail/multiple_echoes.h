#pragma once

#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Sound that goes to and fro (docs/physics.md U7).
namespace trocar::ultrasound::detail {

/// Ring-down behind gas: before the point spread, on one scanline.
void add_ring_down(const ScanPlan& plan, FrameState& frame, int line) noexcept;
/// Echoes between the face and a reflector that is smooth and square to the scanline: everything comes again, later by
/// the reflector's depth, and again (A-lines).
void add_reverberation(const ScanPlan& plan, const FrameState& frame, int angle, int line, BasebandFrame& out) noexcept;

}  // namespace trocar::ultrasound::detail
