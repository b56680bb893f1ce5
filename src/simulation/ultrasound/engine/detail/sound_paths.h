#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Where sound goes: contact of the face, straight scanlines, what bends them and what mirrors them. On the central
/// plane, in coarse steps (docs/physics.md U7, U8).
namespace trocar::ultrasound::detail {

/// Frame-wide transforms and each scanline's straight walk.
void aim_lines(const ScanPlan& plan, FrameState& frame) noexcept;

/// Slowness, losses and gas of scanlines [first, last).
void probe_lines(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int first, int last) noexcept;

/// After all lines were probed: the mirrors.
void place_mirrors(const ScanPlan& plan, FrameState& frame) noexcept;

/// After all lines were probed: displacement and focusing by refraction, from how slowness changes sideways.
void refract_lines(const ScanPlan& plan, FrameState& frame) noexcept;

}  // namespace trocar::ultrasound::detail
