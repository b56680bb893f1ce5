#include <gtest/gtest.h>

#include <set>
#include <string>

#include "image/image.h"

namespace trocar::image {
namespace {

TEST(BitmapFont, EveryCharacterLooksDifferent) {
  std::set<std::string> seen;
  for (int c = ' '; c <= '~'; ++c) {
    std::string rows;
    for (int r = 0; r < kGlyphHeight; ++r) {
      EXPECT_LT(glyph_row(static_cast<char>(c), r), 32U);
      rows.push_back(static_cast<char>('0' + glyph_row(static_cast<char>(c), r)));
    }
    EXPECT_TRUE(seen.insert(rows).second) << static_cast<char>(c);
  }
  EXPECT_EQ(glyph_row('\xff', 0), 0x1fU);
}

TEST(BitmapFont, ScalesItsDots) {
  RgbImage image(40, 20);
  draw_text(image, 1, 2, "L", {9, 9, 9}, 2);
  EXPECT_EQ(image.at(1, 2)[0], 9);
  EXPECT_EQ(image.at(2, 15)[0], 9);
  EXPECT_EQ(image.at(3, 2)[0], 0);
  EXPECT_EQ(image.at(10, 15)[0], 9);
}

}  // namespace
}  // namespace trocar::image
