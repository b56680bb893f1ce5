#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace trocar::image {

using Rgb = std::array<std::uint8_t, 3>;

/// A gray image, row by row from the top left.
struct GrayImage {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t> pixels;
};

/// A colour image (sRGB), row by row from the top left.
struct RgbImage {
  int columns = 0;
  int rows = 0;
  std::vector<Rgb> pixels;

  RgbImage() = default;
  RgbImage(int c, int r, Rgb fill = {0, 0, 0})
      : columns(c), rows(r), pixels(static_cast<std::size_t>(c) * static_cast<std::size_t>(r), fill) {}
  Rgb& at(int column, int row) noexcept {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  const Rgb& at(int column, int row) const noexcept {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

RgbImage to_rgb(const GrayImage& gray);

/// Bitmap font of 5 × 7 dots for images without a text library. Contains printable ASCII; other characters are a box.
inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;
inline constexpr int kGlyphAdvance = 6;

/// Bits of row 0..6 of a character's glyph: bit (4 - column).
unsigned glyph_row(char character, int row) noexcept;
/// Draws text with its top left dot at (column, row), clipped to the image.
void draw_text(RgbImage& image, int column, int row, std::string_view text, Rgb colour, int scale = 1) noexcept;

}  // namespace trocar::image
