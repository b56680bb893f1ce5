#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Paths of sound: contact of the face, straight scanlines, refraction and mirrors. On the central plane, in coarse
/// steps (docs/physics.md U7, U8).
namespace trocar::ultrasound::detail {

/// Computes to which depth tissue yields under the face: FrameState::dent_reach and contact_shape.
void fit_dent(const AcousticScene& scene, const ScanPlan& plan, FrameState& frame) noexcept;

/// Computes the frame's transforms and the straight walks of scanlines [first, last).
void aim_lines(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

/// Computes slowness, losses, gas and layers of scanlines [first, last); of every second one, and between them the
/// mean.
void probe_lines(const ScanPlan& plan, FrameState& frame, WalkResult& scratch, int first, int last) noexcept;

/// Places the mirrors of scanlines [first, last). Call after they were probed.
void place_mirrors(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

/// Computes displacement and focusing of scanlines [first, last) by refraction, from the lateral change of slowness.
/// Call after they were probed; their neighbours may be those of an earlier frame.
void refract_lines(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept;

}  // namespace trocar::ultrasound::detail
