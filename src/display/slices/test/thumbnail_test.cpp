#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "slices/slice_geometry.h"
#include "slices/slice_picture.h"
#include "slices/test/coarse_abdomen.h"

namespace trocar::slices {
namespace {

constexpr image::Rgb kPath{255, 214, 10};

std::size_t count(const image::RgbImage& image, const image::Rgb& color) {
  return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), color));
}

TEST(Thumbnail, ShowsTheEndOfThePatientsFirstPath) {
  const anatomy::VirtualPatient& patient = coarse_abdomen();
  ASSERT_FALSE(patient.paths.empty());
  const ThumbnailRegion region = find_thumbnail_region(patient);
  EXPECT_EQ(region.centre_P, patient.paths.front().line_P.b);
  ASSERT_TRUE(region.path_P);
  EXPECT_EQ(region.path_P->a, patient.paths.front().line_P.a);
}

TEST(Thumbnail, ShowsTheLargestLesionOrTheMiddleWithoutAPath) {
  anatomy::VirtualPatient patient = coarse_abdomen();
  patient.paths.clear();
  const ThumbnailRegion lesion = find_thumbnail_region(patient);
  EXPECT_FALSE(lesion.path_P);
  const anatomy::Label* label = anatomy::find_label(patient, lesion.centre_P);
  ASSERT_NE(label, nullptr);
  EXPECT_EQ(label->tissue, "liver_lesion");
  std::fill(patient.labels.voxels.begin(), patient.labels.voxels.end(), std::uint8_t{0});
  const ThumbnailRegion middle = find_thumbnail_region(patient);
  EXPECT_LT((middle.centre_P - volume_box(patient.ct.geometry).center()).norm(), 1e-9);
}

TEST(Thumbnail, DrawsThePathAtTheRequestedSize) {
  const anatomy::VirtualPatient& patient = coarse_abdomen();
  ThumbnailRegion region = find_thumbnail_region(patient);
  const image::RgbImage image = make_slice_thumbnail(patient, region);
  EXPECT_EQ(image.columns, kThumbnailColumns);
  EXPECT_EQ(image.rows, kThumbnailRows);
  EXPECT_GT(std::set<image::Rgb>(image.pixels.begin(), image.pixels.end()).size(), 100u);
  EXPECT_GT(count(image, kPath), 20u);
  region.path_P.reset();
  EXPECT_EQ(count(make_slice_thumbnail(patient, region), kPath), 0u);
}

TEST(Thumbnail, InsetCoversOnlyTheLowerRightCorner) {
  const anatomy::VirtualPatient& patient = coarse_abdomen();
  constexpr image::Rgb kGround{1, 2, 3};
  image::RgbImage image(kThumbnailColumns + 80, kThumbnailRows + 50, kGround);
  add_coronal_inset(patient, find_thumbnail_region(patient), image);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      if (column < image.columns - 110 || row < image.rows - 110) {
        ASSERT_EQ(image.at(column, row), kGround) << column << " " << row;
      }
    }
  }
  EXPECT_NE(image.at(image.columns - 50, image.rows - 50), kGround);
  EXPECT_EQ(image.at(image.columns - 1, image.rows - 1), kGround) << "a margin";
}

}  // namespace
}  // namespace trocar::slices
