#pragma once

#include "ultrasound/detail/frame_state.h"
#include "ultrasound/detail/scan_plan.h"

/// Borders of neighbouring scanlines and planes, put together to surfaces. A border's place on one scanline has the
/// voxels' steps in it; a line through its neighbours has the surface's own place and tilt.
namespace trocar::detail {

/// A surface where a scanline crosses it.
struct SurfaceFit {
  float walk = 0.0F;       ///< Sample.
  float lateral = 0.0F;    ///< Slope of its depth along the face.
  float elevation = 0.0F;  ///< The same across the image.
  int neighbours = 0;      ///< Scanlines that it was found on beside this one.
};

/// Through the nearest borders between the same two tissues, some millimetres to either side.
SurfaceFit fit_surface(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                       const Border& border) noexcept;

}  // namespace trocar::detail
