#include "slices/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "anatomy/label_statistics.h"
#include "core/result.h"
#include "image/image.h"
#include "slices/paint_slice.h"
#include "slices/slice_geometry.h"

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

namespace {

constexpr int kLeastPixels = 96;
constexpr int kPixelsPerDot = 256;  ///< The font's dots grow by one pixel per this number of pixels.
constexpr int kMargin = 4;          ///< From the picture's edge, in dots.
constexpr double kScaleBarShare = 0.3;
constexpr image::Rgb kInk{255, 255, 255};
constexpr image::Rgb kOutline{0, 0, 0};

int text_width(std::string_view text, int dot) {
  return (static_cast<int>(text.size()) * image::kGlyphAdvance - (image::kGlyphAdvance - image::kGlyphWidth)) * dot;
}

void draw_outlined(image::RgbImage& image, int column, int row, std::string_view text, int dot) {
  for (int across = -1; across <= 1; ++across)
    for (int down = -1; down <= 1; ++down) image::draw_text(image, column + across, row + down, text, kOutline, dot);
  image::draw_text(image, column, row, text, kInk, dot);
}

void fill(image::RgbImage& image, int column, int row, int columns, int rows, image::Rgb colour) {
  for (int r = std::max(0, row); r < std::min(image.rows, row + rows); ++r)
    for (int c = std::max(0, column); c < std::min(image.columns, column + columns); ++c) image.at(c, r) = colour;
}

void draw_letters(SlicePicture& picture, int dot) {
  image::RgbImage& image = picture.image;
  const std::string left = direction_letters(-picture.plane.step_u_P);
  const std::string right = direction_letters(picture.plane.step_u_P);
  const std::string top = direction_letters(-picture.plane.step_v_P);
  const std::string bottom = direction_letters(picture.plane.step_v_P);
  const int height = image::kGlyphHeight * dot;
  const int margin = kMargin * dot;
  const int middle_row = (image.rows - height) / 2;
  draw_outlined(image, margin, middle_row, left, dot);
  draw_outlined(image, image.columns - margin - text_width(right, dot), middle_row, right, dot);
  draw_outlined(image, (image.columns - text_width(top, dot)) / 2, margin, top, dot);
  draw_outlined(image, (image.columns - text_width(bottom, dot)) / 2, image.rows - margin - height, bottom, dot);
}

void draw_scale_bar(SlicePicture& picture, int dot) {
  image::RgbImage& image = picture.image;
  const double mm_per_px = picture.plane.step_u_P.norm();
  const double length_mm = scale_bar_mm(kScaleBarShare * image.columns * mm_per_px);
  const int length = static_cast<int>(std::lround(length_mm / mm_per_px));
  const int margin = kMargin * dot;
  const int row = image.rows - margin - dot;
  fill(image, margin - 1, row - 1, length + 2, dot + 2, kOutline);
  fill(image, margin, row, length, dot, kInk);
  draw_outlined(image, margin, row - (image::kGlyphHeight + 2) * dot, fmt::format("{:g} mm", length_mm), dot);
}

}  // namespace

double scale_bar_mm(double most_mm) noexcept {
  const double decade = std::pow(10.0, std::floor(std::log10(most_mm)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= most_mm) return step * decade;
  return decade;
}

void draw_slice_legend(SlicePicture& picture) {
  if (std::min(picture.image.columns, picture.image.rows) < kLeastPixels) return;
  const int dot = 1 + std::max(picture.image.columns, picture.image.rows) / kPixelsPerDot;
  draw_letters(picture, dot);
  draw_scale_bar(picture, dot);
}

namespace {

constexpr int kInsetColumns = 96, kInsetRows = 96;
constexpr int kInsetMargin = 6;
constexpr image::Rgb kBorder{150, 158, 168};
constexpr image::Rgb kPath{255, 214, 10};
constexpr double kLabelOpacity = 0.45;  ///< More than in a slice view: details of the CT are not visible anyway.

/// A slice through the region's centre that shows the whole body.
image::RgbImage paint(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region,
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
  image::RgbImage image;
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

image::RgbImage make_slice_thumbnail(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region) {
  image::RgbImage image = paint(patient, region, SliceOrientation::kAxial, kThumbnailColumns, kThumbnailRows);
  add_coronal_inset(patient, region, image);
  return image;
}

void add_coronal_inset(const anatomy::VirtualPatient& patient, const ThumbnailRegion& region, image::RgbImage& image) {
  TROCAR_CHECK(image.columns >= kThumbnailColumns && image.rows >= kThumbnailRows);
  const image::RgbImage inset = paint(patient, region, SliceOrientation::kCoronal, kInsetColumns, kInsetRows);
  const int left = image.columns - kInsetColumns - kInsetMargin, top = image.rows - kInsetRows - kInsetMargin;
  for (int row = -1; row <= kInsetRows; ++row) {
    for (int column = -1; column <= kInsetColumns; ++column) {
      const bool is_border = row < 0 || column < 0 || row == kInsetRows || column == kInsetColumns;
      image.at(left + column, top + row) = is_border ? kBorder : inset.at(column, row);
    }
  }
}

}  // namespace trocar::slices
