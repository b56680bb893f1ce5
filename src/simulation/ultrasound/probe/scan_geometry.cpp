#include "ultrasound/probe/scan_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/result.h"

namespace trocar::ultrasound {
namespace {

/// Fraction of the image that is empty at each side of the scan, so that its edge is visible.
constexpr double kRasterMargin = 0.02;

}  // namespace

Vec2 ScanGeometry::line_origin(double line) const noexcept {
  const double offset = (line - middle_line()) * line_step;
  if (!is_fan) return {offset, 0.0};
  return {radius_mm * std::sin(offset), radius_mm * (std::cos(offset) - 1.0)};
}

Vec2 ScanGeometry::line_direction(double line) const noexcept {
  if (!is_fan) return {0.0, 1.0};
  const double angle = (line - middle_line()) * line_step;
  return {std::sin(angle), std::cos(angle)};
}

double ScanGeometry::line_spacing_mm(double at_depth_mm) const noexcept {
  return is_fan ? (radius_mm + at_depth_mm) * line_step : line_step;
}

Vec2 ScanGeometry::to_cartesian(const Polar& place) const noexcept {
  return line_origin(place.line) + place.depth_mm * line_direction(place.line);
}

Polar ScanGeometry::to_polar(const Vec2& p_T) const noexcept {
  if (!is_fan) return {p_T.x() / line_step + middle_line(), p_T.y()};
  const Vec2 from_apex(p_T.x(), p_T.y() + radius_mm);
  return {std::atan2(from_apex.x(), from_apex.y()) / line_step + middle_line(), from_apex.norm() - radius_mm};
}

ScanGeometry::Extent ScanGeometry::extent() const noexcept {
  const double half = middle_line() * line_step;
  if (!is_fan) return {-half, 0.0, half, depth_mm};
  const double reach_mm = radius_mm + depth_mm;
  // The outermost scanlines end lowest on the face; if they point backwards (half > 90 degrees), at their far end.
  const double lowest_mm = std::cos(half) * (std::cos(half) < 0.0 ? reach_mm : radius_mm) - radius_mm;
  const double widest_mm = half < 0.5 * EIGEN_PI ? reach_mm * std::sin(half) : reach_mm;
  return {-widest_mm, lowest_mm, widest_mm, depth_mm};
}

ScanGeometry make_scan_geometry(const Transducer& transducer, double depth_mm, int lines, int samples) {
  TROCAR_CHECK(lines >= 2 && samples >= 2);
  TROCAR_CHECK(depth_mm > 0.0);
  ScanGeometry scan;
  scan.lines = lines;
  scan.samples = samples;
  scan.depth_mm = depth_mm;
  scan.is_fan = transducer.kind != TransducerKind::kLinear;
  const bool has_arc = scan.is_fan && transducer.kind != TransducerKind::kPhased;
  scan.radius_mm = has_arc ? transducer.radius_mm : 0.0;
  // A linear array's outermost scanlines start at the centres of its outermost elements.
  const double width = scan.is_fan ? transducer.field_of_view_rad : transducer.pitch_mm * (transducer.elements - 1);
  scan.line_step = width / (lines - 1);
  return scan;
}

Vec2 RasterGeometry::to_T(double column, double row) const noexcept {
  return {first_T.x() + (is_mirrored ? -column : column) * mm_per_pixel, first_T.y() + row * mm_per_pixel};
}

Vec2 RasterGeometry::to_pixel(const Vec2& p_T) const noexcept {
  const Vec2 pixels = (p_T - first_T) / mm_per_pixel;
  return {is_mirrored ? -pixels.x() : pixels.x(), pixels.y()};
}

RasterGeometry fit_raster(const ScanGeometry& scan, int columns, int rows, bool is_mirrored) {
  TROCAR_CHECK(columns >= 1 && rows >= 1);
  const ScanGeometry::Extent extent = scan.extent();
  constexpr double kUsed = 1.0 - 2.0 * kRasterMargin;
  RasterGeometry raster;
  raster.columns = columns;
  raster.rows = rows;
  raster.is_mirrored = is_mirrored;
  raster.mm_per_pixel = std::max((extent.x1 - extent.x0) / (kUsed * columns), (extent.y1 - extent.y0) / (kUsed * rows));
  const Vec2 middle_T(0.5 * (extent.x0 + extent.x1), 0.5 * (extent.y0 + extent.y1));
  const Vec2 half_mm = 0.5 * raster.mm_per_pixel * Vec2(columns - 1, rows - 1);
  raster.first_T = middle_T - Vec2(is_mirrored ? -half_mm.x() : half_mm.x(), half_mm.y());
  return raster;
}

}  // namespace trocar::ultrasound
