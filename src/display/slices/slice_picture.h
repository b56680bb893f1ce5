#pragma once

#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"

namespace trocar::slices {

/// A CT slice through a point, radiological view (patient's right on the left of the image; coronal and sagittal with
/// the head up, the sagittal slice with the front on the left), window/level, square pixels. Labels are filled and
/// outlined by colour, except fat, muscle and skin, which are the background of structures.
struct SlicePicture {
  volume::RgbImage image;
  volume::SlicePlane plane;  ///< Pixel (u, v) lies at origin + u step_u + v step_v.
  SliceOrientation orientation = SliceOrientation::kAxial;
  /// Image position of a point in P (pixels; may be outside).
  Eigen::Vector2d to_pixel(const Vec3& p_P) const noexcept;
};
struct SliceOptions {
  Window window;
  double label_opacity = 0.25;  ///< Fill; outlines are always opaque. Range 0..1.
  bool has_outlines = true;
  int size_px = 512;  ///< Longer side. Range 1..4096.
  /// Side (mm) of the displayed square around center_P, limited to the volume; 0: the whole volume.
  double field_mm = 0.0;
  Vec3 center_P = Vec3::Zero();
};
SlicePicture make_slice_picture(const anatomy::VirtualPatient& patient, SliceOrientation orientation,
                                const Vec3& through_P, const SliceOptions& options = {});

}  // namespace trocar::slices
