#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Paths of sound: contact of the face, straight scanlines, refraction and mirrors. On the central plane, in coarse
/// steps (docs/physics.md U7, U8).
namespace trocar::ultrasound::detail {

/// Computes the frame's transforms and each scanline's straight walk.
void aim_lines(const ScanPlan& plan, FrameState& frame) noexcept;

/// Computes slowness, losses and gas of scanlines [first, last).
void probe_lines(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int first, int last) noexcept;

/// Places the mirrors. Call after all lines were probed.
void place_mirrors(const ScanPlan& plan, FrameState& frame) noexcept;

/// Computes displacement and focusing by refraction, from the lateral change of slowness. Call after all lines were
/// probed.
void refract_lines(const ScanPlan& plan, FrameState& frame) noexcept;

}  // namespace trocar::ultrasound::detail
