#pragma once

#include <vector>

#include "ultrasound/probe/scan_geometry.h"

/// Measurements in an image. Calipers are set in pixels and stored in mm of the image plane (x, y of T), so that they
/// are independent of image size and depth; converted back to pixels for drawing.
namespace trocar::ultrasound {

/// A straight line between two marks.
struct DistanceCaliper {
  Vec2 a_T{0.0, 0.0}, b_T{0.0, 0.0};

  double distance_mm() const noexcept { return (b_T - a_T).norm(); }
};
DistanceCaliper place_distance(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel) noexcept;

/// An ellipse: the ends of one axis, and the distance of the outline from that axis.
struct EllipseCaliper {
  Vec2 a_T{0.0, 0.0}, b_T{0.0, 0.0};
  double half_width_mm = 0.0;  ///< Other semi-axis.

  double length_mm() const noexcept { return (b_T - a_T).norm(); }  ///< Length of the axis that was set first.
  double width_mm() const noexcept { return 2.0 * half_width_mm; }
  double area_mm2() const noexcept;
  /// Distance of a point from the line of the first axis: the other semi-axis of an ellipse whose outline extends to
  /// that distance.
  double distance_to_axis_mm(const Vec2& p_T) const noexcept;
  /// Exact, by the arithmetic-geometric mean.
  double circumference_mm() const noexcept;
  /// Points on the outline, `count` of them, evenly by angle.
  std::vector<Vec2> outline_T(int count) const;
};
/// `side_pixel` is a point beside the axis: its distance from the axis' line is the other semi-axis.
EllipseCaliper place_ellipse(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel,
                             const Vec2& side_pixel) noexcept;

/// The angle at a corner between two arms.
struct AngleCaliper {
  Vec2 corner_T{0.0, 0.0}, a_T{0.0, 0.0}, b_T{0.0, 0.0};

  double angle_rad() const noexcept;  ///< 0..pi; 0 where an arm has no length.
};
AngleCaliper place_angle(const RasterGeometry& raster, const Vec2& corner_pixel, const Vec2& a_pixel,
                         const Vec2& b_pixel) noexcept;

}  // namespace trocar::ultrasound
