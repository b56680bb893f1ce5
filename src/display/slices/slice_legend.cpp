#include "slices/slice_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "volume/bitmap_font.h"

namespace trocar::slices {
namespace {

constexpr int kLeastPixels = 96;
constexpr int kPixelsPerDot = 256;  ///< The font's dots grow by one pixel per this number of pixels.
constexpr int kMargin = 4;          ///< From the picture's edge, in dots.
constexpr double kScaleBarShare = 0.3;
constexpr volume::Rgb kInk{255, 255, 255};
constexpr volume::Rgb kOutline{0, 0, 0};

int text_width(std::string_view text, int dot) {
  return (static_cast<int>(text.size()) * volume::kGlyphAdvance - (volume::kGlyphAdvance - volume::kGlyphWidth)) * dot;
}

void draw_outlined(volume::RgbImage& image, int column, int row, std::string_view text, int dot) {
  for (int across = -1; across <= 1; ++across)
    for (int down = -1; down <= 1; ++down) volume::draw_text(image, column + across, row + down, text, kOutline, dot);
  volume::draw_text(image, column, row, text, kInk, dot);
}

void fill(volume::RgbImage& image, int column, int row, int columns, int rows, volume::Rgb colour) {
  for (int r = std::max(0, row); r < std::min(image.rows, row + rows); ++r)
    for (int c = std::max(0, column); c < std::min(image.columns, column + columns); ++c) image.at(c, r) = colour;
}

void draw_letters(SlicePicture& picture, int dot) {
  volume::RgbImage& image = picture.image;
  const std::string left = direction_letters(-picture.plane.step_u_P);
  const std::string right = direction_letters(picture.plane.step_u_P);
  const std::string top = direction_letters(-picture.plane.step_v_P);
  const std::string bottom = direction_letters(picture.plane.step_v_P);
  const int height = volume::kGlyphHeight * dot;
  const int margin = kMargin * dot;
  const int middle_row = (image.rows - height) / 2;
  draw_outlined(image, margin, middle_row, left, dot);
  draw_outlined(image, image.columns - margin - text_width(right, dot), middle_row, right, dot);
  draw_outlined(image, (image.columns - text_width(top, dot)) / 2, margin, top, dot);
  draw_outlined(image, (image.columns - text_width(bottom, dot)) / 2, image.rows - margin - height, bottom, dot);
}

void draw_scale_bar(SlicePicture& picture, int dot) {
  volume::RgbImage& image = picture.image;
  const double mm_per_px = picture.plane.step_u_P.norm();
  const double length_mm = scale_bar_mm(kScaleBarShare * image.columns * mm_per_px);
  const int length = static_cast<int>(std::lround(length_mm / mm_per_px));
  const int margin = kMargin * dot;
  const int row = image.rows - margin - dot;
  fill(image, margin - 1, row - 1, length + 2, dot + 2, kOutline);
  fill(image, margin, row, length, dot, kInk);
  draw_outlined(image, margin, row - (volume::kGlyphHeight + 2) * dot, fmt::format("{:g} mm", length_mm), dot);
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

}  // namespace trocar::slices
