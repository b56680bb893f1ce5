#include "slices/thumbnail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "anatomy/build_patient.h"
#include "core/check.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"

namespace trocar::slices {
namespace {

constexpr int kInsetColumns = 96, kInsetRows = 96;
constexpr int kInsetMargin = 6;
constexpr volume::Rgb kBorder{150, 158, 168};
constexpr volume::Rgb kPath{255, 214, 10};
constexpr double kLabelOpacity = 0.45;  ///< More than in a slice view: details of the CT are not visible anyway.

/// A slice through the region's centre that shows the whole body.
volume::RgbImage paint(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region,
                       SliceOrientation orientation, int columns, int rows) {
  SliceGeometry geometry;
  geometry.axes = slice_axes(orientation);
  const Box body = body_box(patient);
  geometry.mm_per_px = fitting_scale(body, geometry.axes, columns, rows);
  const Vec3 normal_P = geometry.axes.normal_P();
  geometry.center_P = body.center() + normal_P.dot(region.centre_P - body.center()) * normal_P;
  geometry.columns = columns;
  geometry.rows = rows;
  SliceStyle style;
  style.label_opacity = kLabelOpacity;
  SliceBuffers buffers;
  volume::RgbImage image;
  paint_slice(patient, geometry.plane(), style, buffers, image);
  if (!region.path_P) return image;

  const Eigen::Vector2d from = geometry.to_pixel(region.path_P->a), to = geometry.to_pixel(region.path_P->b);
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * (to - from).norm())));
  for (int step = 0; step <= steps; ++step) {
    const Eigen::Vector2d at = from + (to - from) * step / steps;
    const auto column = static_cast<int>(std::lround(at.x())), row = static_cast<int>(std::lround(at.y()));
    for (int n = 0; n < 2; ++n)
      if (column + n >= 0 && column + n < columns && row >= 0 && row < rows) image.at(column + n, row) = kPath;
  }
  return image;
}

}  // namespace

ThumbnailRegion find_thumbnail_region(const anatomy::VirtualPatient& patient) {
  if (!patient.paths.empty()) return {patient.paths.front().line_P.b, patient.paths.front().line_P};
  const auto statistics = anatomy::label_statistics(patient);
  for (const std::string_view wanted : {"liver_lesion", "liver"}) {
    const anatomy::LabelStatistics* largest = nullptr;
    for (const anatomy::LabelStatistics& s : statistics) {
      const anatomy::Label* label = patient.label_table.find(s.id);
      if (label == nullptr || label->tissue != wanted || s.voxels == 0) continue;
      if (largest == nullptr || s.voxels > largest->voxels) largest = &s;
    }
    if (largest != nullptr) return {largest->centroid_P, {}};
  }
  return {volume_box(patient.ct.geometry).center(), {}};
}

volume::RgbImage make_slice_thumbnail(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region) {
  volume::RgbImage image = paint(patient, region, SliceOrientation::kAxial, kThumbnailColumns, kThumbnailRows);
  add_coronal_inset(patient, region, image);
  return image;
}

void add_coronal_inset(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region, volume::RgbImage& image) {
  TROCAR_CHECK(image.columns >= kThumbnailColumns && image.rows >= kThumbnailRows);
  const volume::RgbImage inset = paint(patient, region, SliceOrientation::kCoronal, kInsetColumns, kInsetRows);
  const int left = image.columns - kInsetColumns - kInsetMargin, top = image.rows - kInsetRows - kInsetMargin;
  for (int row = -1; row <= kInsetRows; ++row) {
    for (int column = -1; column <= kInsetColumns; ++column) {
      const bool is_border = row < 0 || column < 0 || row == kInsetRows || column == kInsetColumns;
      image.at(left + column, top + row) = is_border ? kBorder : inset.at(column, row);
    }
  }
}

}  // namespace trocar::slices
