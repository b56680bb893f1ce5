#include "ultrasound/doppler/detail/colour_conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/parallel.h"
#include "core/result.h"
#include "image/image.h"
#include "ultrasound/scanner/scan_annotation.h"

namespace trocar::ultrasound {
namespace {

constexpr image::Rgb kOutlineInk = {120, 190, 130};

/// Colours from the baseline to the end of the scale, evenly spaced.
constexpr std::array<image::Rgb, 5> kToFace = {{{60, 0, 0}, {150, 0, 0}, {225, 20, 0}, {250, 120, 0}, {255, 240, 90}}};
constexpr std::array<image::Rgb, 5> kFromFace = {
    {{0, 0, 70}, {0, 10, 150}, {0, 50, 230}, {0, 150, 250}, {150, 250, 255}}};

image::Rgb blend(const std::array<image::Rgb, 5>& colours, double share) noexcept {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  image::Rgb colour;
  for (std::size_t c = 0; c < 3; ++c)
    colour[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(colours[low][c], colours[low + 1][c], place - static_cast<double>(low))));
  return colour;
}

/// atan2(im, re) / pi to 2e-3, one step of colour.
float half_turns(float re, float im) noexcept {
  const float x = std::abs(re);
  const float y = std::abs(im);
  const float ratio = std::min(x, y) / std::max(std::max(x, y), 1e-30F);
  // Rajan et al., IEEE Signal Process Mag 23(3):108, 2006: atan(r) = pi/4 r + 0.273 r (1 - r).
  constexpr float kBulge = 0.273F / std::numbers::pi_v<float>;
  float share = 0.25F * ratio + kBulge * ratio * (1.0F - ratio);
  if (y > x) share = 0.5F - share;
  if (re < 0.0F) share = 1.0F - share;
  return im < 0.0F ? -share : share;
}

}  // namespace

image::Rgb doppler_colour(double share, const DopplerSettings& settings) noexcept {
  // With a baseline shift of b the scale ranges from b - 1 to b + 1.
  const double b = settings.baseline;
  if (share > b + 1.0) share -= 2.0;
  if (share < b - 1.0) share += 2.0;
  const bool to_face = (share >= 0.0) != settings.is_inverted;
  const double part = share >= 0.0 ? share / (1.0 + b) : -share / (1.0 - b);
  return blend(to_face ? kToFace : kFromFace, part);
}

void draw_colour_bar(image::RgbImage& image, int column, int row, int columns, int rows, double scale_cm_per_s,
                     const DopplerSettings& settings) {
  const double b = settings.baseline;
  for (int r = 0; r < rows; ++r) {
    const image::Rgb colour = doppler_colour(b + 1.0 - 2.0 * (r + 0.5) / rows, settings);
    for (int c = column; c < column + columns; ++c)
      if (c >= 0 && c < image.columns && row + r >= 0 && row + r < image.rows) image.at(c, row + r) = colour;
  }
  const int dot = std::max(1, image.columns / 640);
  const auto label = [&](double share, int at_row) {
    image::draw_text(image, column, at_row, fmt::format("{:+.0f}", share * scale_cm_per_s), kTextInk, dot);
  };
  label(b + 1.0, row - (image::kGlyphHeight + 2) * dot);
  label(b - 1.0, row + rows + 2 * dot);
  image::draw_text(image, column, row + rows + (image::kGlyphHeight + 5) * dot, "cm/s", kTextInk, dot);
}

namespace detail {

bool is_same_scan(const ScanGeometry& a, const ScanGeometry& b) noexcept {
  return a.is_fan == b.is_fan && a.radius_mm == b.radius_mm && a.line_step == b.line_step && a.lines == b.lines &&
         a.samples == b.samples && a.depth_mm == b.depth_mm;
}

void ColourConversion::make_tables(const image::GrayImage& image, const RasterGeometry& raster,
                                   const ScanGeometry& scan, const DopplerFrame& frame) {
  image_ = image::RgbImage(image.columns, image.rows);
  raster_ = raster;
  places_.clear();
  outline_.clear();
  const auto place_of = [&](int column, int row) {
    const Polar at = scan.to_polar(raster.to_T(column, row));
    return Vec2((at.line - frame.first_line) / frame.line_step, (at.depth_mm - frame.first_mm) / frame.gate_mm);
  };
  const auto is_within = [&](const Vec2& at) {
    return at.x() >= 0.0 && at.x() <= frame.lines - 1 && at.y() >= 0.0 && at.y() <= frame.gates - 1;
  };
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column) {
      const Vec2 at = place_of(column, row);
      if (!is_within(at)) continue;
      const std::int32_t pixel = row * image.columns + column;
      const int line = std::min(static_cast<int>(at.x()), frame.lines - 2);
      const int gate = std::min(static_cast<int>(at.y()), frame.gates - 2);
      places_.push_back({pixel, static_cast<std::int32_t>(frame.at(line, gate)),
                         static_cast<std::uint8_t>(std::lround(255.0 * (at.x() - line))),
                         static_cast<std::uint8_t>(std::lround(255.0 * (at.y() - gate)))});
      const bool is_edge = !is_within(place_of(column - 1, row)) || !is_within(place_of(column + 1, row)) ||
                           !is_within(place_of(column, row - 1)) || !is_within(place_of(column, row + 1));
      if (is_edge) outline_.push_back(pixel);
    }
  is_made_ = true;
}

void ColourConversion::set_colours(const DopplerSettings& settings) noexcept {
  for (std::size_t n = 0; n < kColours; ++n)
    colours_[n] = doppler_colour(2.0 * (static_cast<double>(n) + 0.5) / kColours - 1.0, settings);
}

const image::RgbImage& ColourConversion::convert(const image::GrayImage& image, const RasterGeometry& raster,
                                                 const ScanGeometry& scan, const DopplerFrame& frame,
                                                 const DopplerSettings& settings) {
  const bool fits = is_made_ && image_.columns == image.columns && image_.rows == image.rows &&
                    raster_.is_mirrored == raster.is_mirrored && raster_.mm_per_pixel == raster.mm_per_pixel &&
                    raster_.first_T == raster.first_T;
  if (!fits) make_tables(image, raster, scan, frame);
  TROCAR_CHECK(image.pixels.size() == image_.pixels.size());
  set_colours(settings);
  std::transform(image.pixels.begin(), image.pixels.end(), image_.pixels.begin(), [](std::uint8_t gray) {
    return image::Rgb{gray, gray, gray};
  });
  auto part = [&](std::size_t first, std::size_t last) {
    const auto gates = static_cast<std::size_t>(frame.gates);
    for (std::size_t n = first; n < last; ++n) {
      const Place& place = places_[n];
      const auto pixel = static_cast<std::size_t>(place.pixel);
      if (image.pixels[pixel] > settings.write_priority) continue;
      const auto at = static_cast<std::size_t>(place.cell);
      const float across = static_cast<float>(place.across) / 255.0F;
      const float along = static_cast<float>(place.along) / 255.0F;
      const std::size_t corner[4] = {at, at + 1, at + gates, at + gates + 1};
      if (!(frame.has_flow[corner[0]] | frame.has_flow[corner[1]] | frame.has_flow[corner[2]] |
            frame.has_flow[corner[3]]))
        continue;
      const float weight[4] = {(1.0F - across) * (1.0F - along), (1.0F - across) * along, across * (1.0F - along),
                               across * along};
      float shown = 0.0F, re = 0.0F, im = 0.0F;
      for (std::size_t c = 0; c < 4; ++c) {
        if (frame.has_flow[corner[c]] == 0) continue;
        shown += weight[c];
        re += weight[c] * frame.re[corner[c]];
        im += weight[c] * frame.im[corner[c]];
      }
      if (shown < 0.5F) continue;
      const float share = half_turns(re, im);
      const auto colour = static_cast<std::size_t>(0.5F * (share + 1.0F) * (kColours - 1) + 0.5F);
      image_.pixels[pixel] = colours_[std::min(colour, kColours - 1)];
    }
  };
  constexpr std::size_t kPixelsTogether = 8192;
  parallel_for(places_.size(), kPixelsTogether, std::ref(part));
  for (const std::int32_t pixel : outline_) image_.pixels[static_cast<std::size_t>(pixel)] = kOutlineInk;
  return image_;
}

}  // namespace detail
}  // namespace trocar::ultrasound
