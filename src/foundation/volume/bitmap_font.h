#pragma once

#include <string_view>

#include "volume/image.h"

namespace trocar::volume {

/// Letters of 5 × 7 dots for pictures that no text library draws. Knows printable ASCII; others are a box.
inline constexpr int kGlyphWidth = 5;
inline constexpr int kGlyphHeight = 7;
inline constexpr int kGlyphAdvance = 6;

/// Bit (4 - column) of row 0..6 of a character's picture.
unsigned glyph_row(char character, int row) noexcept;
/// Text with its top left dot at (column, row); what is beyond the picture is left out.
void draw_text(RgbImage& image, int column, int row, std::string_view text, Rgb colour, int scale = 1) noexcept;

}  // namespace trocar::volume
