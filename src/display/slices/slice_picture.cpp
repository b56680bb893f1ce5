#include "slices/slice_picture.h"

#include <algorithm>
#include <cmath>

namespace trocar::slices {
namespace {

struct Extent {
  double low, high;
};

/// Displayed range along an axis of P: the volume's box (voxel borders, not centres) or its part inside the field of
/// view.
Extent extent_mm(const volume::GridGeometry& geometry, const Vec3& direction_P, const SliceOptions& options) {
  const Box volume_P = volume_box(geometry);
  const double ends[2] = {direction_P.dot(volume_P.min()), direction_P.dot(volume_P.max())};
  const Extent box{std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
  if (!(options.field_mm > 0.0)) return box;
  const double side = std::min(options.field_mm, box.high - box.low);
  const double low = direction_P.dot(options.center_P) - 0.5 * side;
  const double inside = std::clamp(low, box.low, box.high - side);
  return {inside, inside + side};
}

volume::SlicePlane plane_through(const volume::GridGeometry& geometry, SliceOrientation orientation,
                                 const Vec3& through_P, const SliceOptions& options) {
  const SliceAxes axes = slice_axes(orientation);
  const Extent u = extent_mm(geometry, axes.u_P, options);
  const Extent v = extent_mm(geometry, axes.v_P, options);
  const double longer_mm = options.field_mm > 0.0 ? options.field_mm : std::max(u.high - u.low, v.high - v.low);
  const double step_mm = longer_mm / options.size_px;
  volume::SlicePlane plane;
  plane.columns = std::max(1, static_cast<int>(std::lround((u.high - u.low) / step_mm)));
  plane.rows = std::max(1, static_cast<int>(std::lround((v.high - v.low) / step_mm)));
  plane.step_u_P = step_mm * axes.u_P;
  plane.step_v_P = step_mm * axes.v_P;
  // The point keeps its coordinate perpendicular to the plane; the first pixel's centre is half a pixel inside the box.
  const Vec3 across_P = axes.normal_P();
  plane.origin_P =
      across_P * across_P.dot(through_P) + axes.u_P * (u.low + 0.5 * step_mm) + axes.v_P * (v.low + 0.5 * step_mm);
  return plane;
}

}  // namespace

Eigen::Vector2d SlicePicture::to_pixel(const Vec3& p_P) const noexcept {
  const Vec3 from_origin = p_P - plane.origin_P;
  return {from_origin.dot(plane.step_u_P) / plane.step_u_P.squaredNorm(),
          from_origin.dot(plane.step_v_P) / plane.step_v_P.squaredNorm()};
}

SlicePicture make_slice_picture(const anatomy::VirtualPatient& patient, SliceOrientation orientation,
                                const Vec3& through_P, const SliceOptions& options) {
  SlicePicture picture;
  picture.orientation = orientation;
  picture.plane = plane_through(patient.ct.geometry, orientation, through_P, options);
  SliceBuffers buffers;
  paint_slice(patient, picture.plane, {options.window, options.label_opacity, options.has_outlines}, buffers,
              picture.image);
  return picture;
}

}  // namespace trocar::slices
