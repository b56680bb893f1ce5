#include <gtest/gtest.h>

#include <string>

#include "image/image.h"
#include "slices/slice_picture.h"

namespace trocar::slices {
namespace {

/// A cube of air, 300 mm wide, with voxels of 3 mm; not one gray value of its pictures is white.
anatomy::VirtualPatient air() {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {100, 100, 100};
  geometry.spacing_mm = Vec3::Constant(3.0);
  patient.ct = volume::CtGrid(geometry, -1000);
  patient.labels = volume::LabelGrid(geometry, 0);
  return patient;
}

SlicePicture with_legend(SliceOrientation orientation, int size_px = 600) {
  SliceOptions options;
  options.size_px = size_px;
  SlicePicture picture = make_slice_picture(air(), orientation, {150, 150, 150}, options);
  draw_slice_legend(picture);
  return picture;
}

bool is_white(const image::RgbImage& image, int column, int row) {
  return image.at(column, row) == image::Rgb{255, 255, 255};
}

/// Whether a letter stands with its top left dot at a pixel.
bool reads(const image::RgbImage& image, int column, int row, char letter, int dot) {
  for (int r = 0; r < image::kGlyphHeight; ++r)
    for (int c = 0; c < image::kGlyphWidth; ++c) {
      const bool is_dot = (image::glyph_row(letter, r) >> (image::kGlyphWidth - 1 - c) & 1U) != 0;
      if (is_white(image, column + c * dot, row + r * dot) != is_dot) return false;
    }
  return true;
}

TEST(SliceLegend, NamesTheDirectionsOfEveryOrientation) {
  constexpr int kDot = 3;  // of a picture of 600 pixels
  constexpr int kMargin = 4 * kDot;
  constexpr int kMiddle = (600 - image::kGlyphHeight * kDot) / 2;
  constexpr int kCentre = (600 - image::kGlyphWidth * kDot) / 2;
  const struct {
    SliceOrientation orientation;
    const char* letters;  // left, right, top, bottom
  } cases[] = {
      {SliceOrientation::kAxial, "RLAP"}, {SliceOrientation::kCoronal, "RLHF"}, {SliceOrientation::kSagittal, "APHF"}};
  for (const auto& [orientation, letters] : cases) {
    const SlicePicture picture = with_legend(orientation);
    ASSERT_EQ(picture.image.columns, 600);
    EXPECT_TRUE(reads(picture.image, kMargin, kMiddle, letters[0], kDot)) << letters;
    EXPECT_TRUE(reads(picture.image, 600 - kMargin - image::kGlyphWidth * kDot, kMiddle, letters[1], kDot)) << letters;
    EXPECT_TRUE(reads(picture.image, kCentre, kMargin, letters[2], kDot)) << letters;
    EXPECT_TRUE(reads(picture.image, kCentre, 600 - kMargin - image::kGlyphHeight * kDot, letters[3], kDot)) << letters;
  }
}

TEST(SliceLegend, ScaleBarHasItsStatedLength) {
  const SlicePicture picture = with_legend(SliceOrientation::kAxial);
  const int row = 600 - 4 * 3 - 2;
  int length = 0;
  for (int column = 0; column < picture.image.columns / 3; ++column)  // the letter below stands in the middle
    if (is_white(picture.image, column, row)) ++length;
  EXPECT_EQ(length, 100);  // 50 mm of 300 mm on 600 pixels; 100 mm would pass the share of 0.3
}

TEST(SliceLegend, ScaleBarHasARoundLength) {
  EXPECT_DOUBLE_EQ(scale_bar_mm(90.0), 50.0);
  EXPECT_DOUBLE_EQ(scale_bar_mm(100.0), 100.0);
  EXPECT_DOUBLE_EQ(scale_bar_mm(49.0), 20.0);
  EXPECT_DOUBLE_EQ(scale_bar_mm(1.9), 1.0);
  EXPECT_DOUBLE_EQ(scale_bar_mm(0.3), 0.2);
}

TEST(SliceLegend, LeavesSmallImagesUnchanged) {
  const SlicePicture picture = with_legend(SliceOrientation::kAxial, 64);
  for (const image::Rgb& pixel : picture.image.pixels) EXPECT_NE(pixel, (image::Rgb{255, 255, 255}));
}

}  // namespace
}  // namespace trocar::slices
