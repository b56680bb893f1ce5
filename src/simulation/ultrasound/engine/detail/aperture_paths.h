#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Sound reaches a depth from the whole aperture, not along the scanline alone: shadows have soft edges, and small
/// obstacles are transparent at some distance (docs/physics.md U7). Attenuation takes high frequencies first: a
/// broadband echo loses less than one at the centre frequency (U4).
namespace trocar::ultrasound::detail {

/// Computes FrameState::open_way and `reach` of scanlines [first, last) from the probed losses of all. `rows` is
/// scratch of at least aperture_floats(plan) values.
void open_aperture(const ScanPlan& plan, FrameState& frame, int first, int last, std::vector<float>& rows) noexcept;
std::size_t aperture_floats(const ScanPlan& plan) noexcept;

/// Adds the changes by aperture, spectrum and refraction to the gains of a walk and of its borders.
void apply_paths(const ScanPlan& plan, const FrameState& frame, int line, WalkResult& walk) noexcept;

}  // namespace trocar::ultrasound::detail
