#include "ultrasound/tissue/scan_ends.h"

#include <algorithm>
#include <array>

#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

constexpr double kBody_mm = 3.0;  ///< A face cuts the body if the skin is farther outside than this.
constexpr image::Rgb kHatch{58, 66, 78};
constexpr int kHatchStep_px = 12, kHatchWidth_px = 1;
constexpr int kHatchColumns = 640;  ///< Up to this number of columns, lines have one pixel.

bool is_cut(const anatomy::VirtualPatient& patient, int axis, bool is_last) {
  const volume::GridGeometry& grid = patient.labels.geometry;
  const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
  volume::Index3 at{};
  at[a] = is_last ? grid.size[a] - 1 : 0;
  for (at[b] = 0; at[b] < grid.size[b]; ++at[b]) {
    for (at[c] = 0; at[c] < grid.size[c]; ++at[c]) {
      const Vec3 p_P = grid.centre_mm(at);
      if (volume::sample_linear(patient.skin_distance_mm, p_P) < -kBody_mm) return true;
    }
  }
  return false;
}

/// The half plane left by an end, in T: normal · (x, y) <= offset.
struct HalfPlane {
  Vec2 normal{0.0, 0.0};
  double offset_mm = 0.0;
  double beyond_mm(const Vec2& p_T) const noexcept { return normal.dot(p_T) - offset_mm; }
};
HalfPlane in_plane(const ScanEnd& end, const Pose& X_PT) noexcept {
  const Vec3 normal_T = X_PT.R().transpose() * end.normal_P;
  return {{normal_T.x(), normal_T.y()}, end.offset_mm - end.normal_P.dot(X_PT.p())};
}

/// Sutherland and Hodgman: intersection of a polygon and a half plane.
std::vector<Vec2> clipped(const std::vector<Vec2>& polygon, const HalfPlane& half) {
  std::vector<Vec2> result;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Vec2 &a = polygon[n], &b = polygon[(n + 1) % polygon.size()];
    const double beyond_a = half.beyond_mm(a), beyond_b = half.beyond_mm(b);
    if (beyond_a <= 0.0) result.push_back(a);
    if ((beyond_a <= 0.0) != (beyond_b <= 0.0)) result.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
  }
  return result;
}

}  // namespace

std::vector<ScanEnd> find_scan_ends(const anatomy::VirtualPatient& patient) {
  std::vector<ScanEnd> ends;
  if (patient.labels.empty() || patient.skin_distance_mm.empty()) return ends;
  const volume::GridGeometry& grid = patient.labels.geometry;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool is_last : {false, true}) {
      if (!is_cut(patient, axis, is_last)) continue;
      const double outermost = is_last ? static_cast<double>(grid.size[static_cast<std::size_t>(axis)]) - 0.5 : -0.5;
      const Vec3 normal_P = (is_last ? 1.0 : -1.0) * grid.R_PV.col(axis);
      ends.push_back({normal_P, normal_P.dot(grid.to_mm(outermost * Vec3::Unit(axis)))});
    }
  }
  return ends;
}

bool is_unscanned(const std::vector<ScanEnd>& ends, const Vec3& p_P) noexcept {
  return std::any_of(ends.begin(), ends.end(),
                     [&](const ScanEnd& end) { return end.normal_P.dot(p_P) > end.offset_mm; });
}

double unscanned_share(const std::vector<ScanEnd>& ends, const Pose& X_PT, const ScanGeometry& scan) noexcept {
  constexpr int kLines = 48, kDepths = 48;
  if (ends.empty()) return 0.0;
  double unscanned = 0.0, all = 0.0;
  for (int l = 0; l < kLines; ++l) {
    const double line = (l + 0.5) / kLines * (scan.lines - 1);
    for (int d = 0; d < kDepths; ++d) {
      const double depth_mm = (d + 0.5) / kDepths * scan.depth_mm;
      const Vec2 p_T = scan.to_cartesian({line, depth_mm});
      const double area = scan.line_spacing_mm(depth_mm);
      all += area;
      if (is_unscanned(ends, X_PT * Vec3(p_T.x(), p_T.y(), 0.0))) unscanned += area;
    }
  }
  return unscanned / all;
}

std::vector<Vec2> scanned_polygon_T(const std::vector<ScanEnd>& ends, const Pose& X_PT, const ScanGeometry& scan) {
  constexpr double kMargin_mm = 50.0;
  const ScanGeometry::Extent extent = scan.extent();
  const double x0 = extent.x0 - kMargin_mm, x1 = extent.x1 + kMargin_mm;
  const double y0 = extent.y0 - kMargin_mm, y1 = extent.y1 + kMargin_mm;
  std::vector<Vec2> polygon = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  for (const ScanEnd& end : ends) polygon = clipped(polygon, in_plane(end, X_PT));
  return polygon;
}

void hatch_unscanned(image::RgbImage& image, const RasterGeometry& raster, const ScanGeometry& scan, const Pose& X_PT,
                     const std::vector<ScanEnd>& ends) {
  if (ends.empty()) return;
  const int dot = std::max(1, image.columns / kHatchColumns);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      if ((row + column) / dot % kHatchStep_px >= kHatchWidth_px) continue;
      const Vec2 p_T = raster.to_T(column, row);
      const Polar place = scan.to_polar(p_T);
      const bool is_in_scan =
          place.line >= 0.0 && place.line <= scan.lines - 1 && place.depth_mm >= 0.0 && place.depth_mm <= scan.depth_mm;
      if (is_in_scan && is_unscanned(ends, X_PT * Vec3(p_T.x(), p_T.y(), 0.0))) image.at(column, row) = kHatch;
    }
  }
}

}  // namespace trocar::ultrasound
