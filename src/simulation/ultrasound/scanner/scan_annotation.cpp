#include "ultrasound/scanner/scan_annotation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/image.h"

namespace trocar::ultrasound {
namespace {

constexpr image::Rgb kMarkerInk = {90, 200, 120};
constexpr image::Rgb kFocusInk = {240, 200, 80};

/// Layout, in dots of the text.
constexpr int kMargin = 6;
constexpr int kLineHeight = 10;
constexpr int kShortTick = 3;
constexpr int kLongTick = 6;
constexpr int kLabelColumns = 2 * image::kGlyphAdvance;  ///< Space for two digits right of the scale.
constexpr int kWedgeColumns = 8;
constexpr int kTriangle = 4;
constexpr int kMarkerDistance = 9;
constexpr double kMarkerRadius = 3.0;
/// Images up to this number of columns use one pixel per dot, twice as many use two.
constexpr int kColumnsPerScale = 640;

/// Ticks of the depth scale: for shallow images every 5 mm with a label per cm, else every cm with a label per 5 cm.
constexpr double kShallow_mm = 60.0;

std::string depth_label(double depth_mm) {
  return fmt::format("{:.0f}", depth_mm / 10.0);
}

void add_depth_scale(ScanAnnotation& annotation, const RasterGeometry& raster, const ScanGeometry& scan) {
  const int dot = annotation.text_scale;
  annotation.scale_column = raster.columns - (kMargin + kLabelColumns + 2) * dot;
  const double step_mm = scan.depth_mm <= kShallow_mm ? 5.0 : 10.0;
  const int label_each = scan.depth_mm <= kShallow_mm ? 2 : 5;
  for (int i = 0; i * step_mm <= scan.depth_mm + 1e-9; ++i) {
    const bool is_long = i % label_each == 0;
    const double depth_mm = i * step_mm;
    const double row = raster.to_pixel({0.0, depth_mm}).y();
    annotation.ticks.push_back({row, (is_long ? kLongTick : kShortTick) * dot, depth_mm});
    if (!is_long) continue;
    const int top = static_cast<int>(std::lround(row)) - image::kGlyphHeight / 2 * dot;
    annotation.texts.push_back({annotation.scale_column + 3 * dot, top, depth_label(depth_mm)});
  }
}

void add_caption(ScanAnnotation& annotation, const ScanGeometry& scan, const ScanCaption& caption) {
  const DisplaySettings& settings = caption.settings;
  std::vector<std::string> lines = {
      caption.transducer,
      fmt::format("{}{:.1f} MHz", caption.is_harmonic ? "THI " : "", caption.frequency_mhz),
      fmt::format("Depth {:.1f} cm", scan.depth_mm / 10.0),
      fmt::format("Gain {:+.0f} dB", settings.gain_db),
      fmt::format("DR {:.0f} dB", settings.dynamic_range_db),
      fmt::format("Map {}", name_of(settings.gray_map))};
  if (settings.persistence > 0.0) lines.push_back(fmt::format("Persist {:.2f}", settings.persistence));
  lines.insert(lines.end(), caption.remarks.begin(), caption.remarks.end());
  const int dot = annotation.text_scale;
  int row = kMargin * dot;
  for (std::string& line : lines) {
    annotation.texts.push_back({kMargin * dot, row, std::move(line)});
    row += kLineHeight * dot;
  }
}

void add_wedge(ScanAnnotation& annotation, const RasterGeometry& raster, const DisplaySettings& settings) {
  const int dot = annotation.text_scale;
  const int rows = raster.rows / 4;
  annotation.wedge = {kMargin * dot, (raster.rows - rows) / 2, kWedgeColumns * dot, {}};
  for (int r = 0; r < rows; ++r) {
    const double below_white_db = settings.dynamic_range_db * r / std::max(rows - 1, 1);
    annotation.wedge.gray.push_back(gray_of_level(kWhite_db - settings.gain_db - below_white_db, settings));
  }
}

void draw_box(image::RgbImage& image, int column, int row, int columns, int rows, image::Rgb colour) {
  for (int r = std::max(row, 0); r < std::min(row + rows, image.rows); ++r) {
    for (int c = std::max(column, 0); c < std::min(column + columns, image.columns); ++c) image.at(c, r) = colour;
  }
}

/// Filled, with its point at (column, row), extending to the right.
void draw_triangle(image::RgbImage& image, int column, int row, int size, image::Rgb colour) {
  for (int i = 0; i <= size; ++i) draw_box(image, column - i, row - i, 1, 2 * i + 1, colour);
}

void draw_disc(image::RgbImage& image, const Vec2& middle, double radius, image::Rgb colour) {
  for (int r = static_cast<int>(middle.y() - radius); r <= static_cast<int>(middle.y() + radius) + 1; ++r) {
    for (int c = static_cast<int>(middle.x() - radius); c <= static_cast<int>(middle.x() + radius) + 1; ++c) {
      if ((Vec2(c, r) - middle).norm() <= radius) draw_box(image, c, r, 1, 1, colour);
    }
  }
}

}  // namespace

ScanAnnotation make_scan_annotation(const RasterGeometry& raster, const ScanGeometry& scan,
                                    const ScanCaption& caption) {
  ScanAnnotation annotation;
  annotation.text_scale = std::max(1, raster.columns / kColumnsPerScale);
  add_depth_scale(annotation, raster, scan);
  add_caption(annotation, scan, caption);
  add_wedge(annotation, raster, within_ranges(caption.settings));
  annotation.focus_row = raster.to_pixel({0.0, caption.focus_mm}).y();
  const Vec2 end_pixel = raster.to_pixel(scan.line_origin(scan.lines - 1));
  const double outwards = raster.is_mirrored ? -1.0 : 1.0;
  const Vec2 marker = end_pixel + Vec2(outwards * kMarkerDistance * annotation.text_scale, 0.0);
  // A linear array can fill the image: the marker is then inside it.
  const double radius = kMarkerRadius * annotation.text_scale;
  const Vec2 last(raster.columns - 1, raster.rows - 1);
  annotation.marker_pixel = marker.cwiseMin(last - Vec2(radius, radius)).cwiseMax(Vec2(radius, radius));
  return annotation;
}

void draw_annotation(image::RgbImage& image, const ScanAnnotation& annotation) {
  const int dot = annotation.text_scale;
  for (const ScanAnnotation::Tick& tick : annotation.ticks) {
    const int row = static_cast<int>(std::lround(tick.row));
    draw_box(image, annotation.scale_column - tick.length_px, row, tick.length_px, dot, kTextInk);
  }
  const int focus_row = static_cast<int>(std::lround(annotation.focus_row));
  draw_triangle(image, annotation.scale_column - (kLongTick + 2) * dot, focus_row, kTriangle * dot, kFocusInk);
  draw_disc(image, annotation.marker_pixel, kMarkerRadius * dot, kMarkerInk);
  for (std::size_t r = 0; r < annotation.wedge.gray.size(); ++r) {
    const std::uint8_t gray = annotation.wedge.gray[r];
    draw_box(image, annotation.wedge.column, annotation.wedge.row + static_cast<int>(r), annotation.wedge.columns, 1,
             {gray, gray, gray});
  }
  for (const ScanAnnotation::Text& text : annotation.texts) {
    image::draw_text(image, text.column, text.row, text.text, kTextInk, dot);
  }
}

}  // namespace trocar::ultrasound
