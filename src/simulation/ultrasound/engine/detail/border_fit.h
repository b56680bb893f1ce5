#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"

/// Fits surfaces to the borders of neighbouring scanlines and planes. The position of a border on one scanline contains
/// the voxels' steps; a line fitted through its neighbours gives the position and tilt of the surface.
namespace trocar::ultrasound::detail {

/// A surface at its intersection with a scanline.
struct SurfaceFit {
  float walk = 0.0F;        ///< Sample.
  float lateral = 0.0F;     ///< Slope of its depth along the face.
  float elevation = 0.0F;   ///< Slope of its depth across the image; 0 from fit_in_plane.
  float bow_per_mm = 0.0F;  ///< Its curvature across the image: half of the second derivative of its depth.
  int neighbours = 0;       ///< Number of scanlines with this surface, without the scanline itself.

  /// How much deeper it is at `z_mm` across the image from where it was fitted.
  float deeper_mm(float z_mm) const noexcept { return (elevation + bow_per_mm * z_mm) * z_mm; }
};

/// Fits the nearest borders between the same two tissues on neighbouring scanlines of one plane, some millimetres to
/// either side. Reads only the borders of that plane.
SurfaceFit fit_in_plane(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                        const Border& border) noexcept;

/// As fit_in_plane, with the slope across the image from the borders of all planes. All planes of this frame must be
/// walked. `border` belongs to ScanPlan::walked_line(plane, line); the fit is that on `line`.
SurfaceFit fit_surface(const ScanPlan& plan, const FrameState& frame, int plane, int line,
                       const Border& border) noexcept;

}  // namespace trocar::ultrasound::detail
