#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Borders of neighbouring scanlines and planes, put together to surfaces. A border's place on one scanline has the
/// voxels' steps in it; a line through its neighbours has the surface's own place and tilt.
namespace trocar::ultrasound::detail {

/// A surface where a scanline crosses it.
struct SurfaceFit {
  float walk = 0.0F;       ///< Sample.
  float lateral = 0.0F;    ///< Slope of its depth along the face.
  float elevation = 0.0F;  ///< The same across the image; 0 from fit_in_plane.
  int neighbours = 0;      ///< Scanlines that it was found on beside this one.
};

/// Fits the nearest borders between the same two tissues on neighbouring scanlines of one plane, some millimetres to
/// either side. Reads the borders of that plane alone.
SurfaceFit fit_in_plane(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                        const Border& border) noexcept;

/// The same, and the slope across the image from the borders of all planes. All planes of this frame must be walked.
SurfaceFit fit_surface(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                       const Border& border) noexcept;

}  // namespace trocar::ultrasound::detail
