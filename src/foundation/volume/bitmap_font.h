#pragma once

#include <string_view>

#include "volume/image.h"

namespace trocar::volume {

/// Bitmap font of 5 × 7 dots for images without a text library. Contains printable ASCII; other characters are a box.
inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;
inline constexpr int kGlyphAdvance = 6;

/// Bits of row 0..6 of a character's glyph: bit (4 - column).
unsigned glyph_row(char character, int row) noexcept;
/// Draws text with its top left dot at (column, row), clipped to the image.
void draw_text(RgbImage& image, int column, int row, std::string_view text, Rgb colour, int scale = 1) noexcept;

}  // namespace trocar::volume
