#include <gtest/gtest.h>

#include "slices/paint_slice.h"

namespace trocar::slices {
namespace {

constexpr image::Rgb kCt{100, 100, 100};

/// A cube of 20 mm with gray 200 in its frame U, whose half x > 10 mm was not imaged.
class FuseUltrasound : public ::testing::Test {
 protected:
  FuseUltrasound() : gray_(volume::GridGeometry{{21, 21, 21}, Vec3::Ones(), Vec3::Zero(), Mat3::Identity()}, 200) {
    imaged_ = volume::MaskGrid(gray_.geometry, 1);
    for (std::size_t n = 0; n < imaged_.voxels.size(); ++n)
      if (imaged_.geometry.index_of(n)[0] > 10) imaged_.voxels[n] = 0;
    plane_.origin_P = Vec3(90.0, 0.0, 10.0);
    plane_.columns = 40;
    plane_.rows = 21;
  }

  image::RgbImage fused(const FusionStyle& style) {
    image::RgbImage picture(plane_.columns, plane_.rows, kCt);
    fuse_ultrasound({gray_, imaged_, 255.0, Pose::translation(Vec3(100.0, 0.0, 0.0))}, plane_, style, picture);
    return picture;
  }

  volume::LabelGrid gray_;
  volume::MaskGrid imaged_;
  volume::SlicePlane plane_;
};

TEST_F(FuseUltrasound, DrawsAtItsPoseWhereItWasImaged) {
  const image::RgbImage picture = fused({FusionKind::kBlend, 0.5, 15.0});
  EXPECT_EQ(picture.at(9, 5), kCt) << "before its first voxel";
  EXPECT_NE(picture.at(10, 5), kCt);
  EXPECT_NE(picture.at(20, 5), kCt);
  EXPECT_EQ(picture.at(21, 5), kCt) << "not imaged";
  const image::Rgb orange = picture.at(15, 5);
  EXPECT_GT(orange[0], orange[1]);
  EXPECT_GT(orange[1], orange[2]);
}

TEST_F(FuseUltrasound, ZeroShareAndOffShowOnlyTheCt) {
  EXPECT_EQ(fused({FusionKind::kBlend, 0.0, 15.0}).at(15, 5), kCt);
  EXPECT_EQ(fused({FusionKind::kOff, 1.0, 15.0}).at(15, 5), kCt);
}

TEST_F(FuseUltrasound, CheckerboardAlternatesEveryField) {
  const image::RgbImage picture = fused({FusionKind::kCheckerboard, 1.0, 5.0});
  const image::Rgb us{200, 200, 200};
  int us_pixels = 0;
  for (int column = 10; column <= 19; ++column)
    for (int row = 0; row < 10; ++row) {
      ASSERT_TRUE(picture.at(column, row) == us || picture.at(column, row) == kCt);
      us_pixels += picture.at(column, row) == us ? 1 : 0;
    }
  EXPECT_EQ(us_pixels, 50) << "half of two by two fields";
  EXPECT_NE(picture.at(12, 2), picture.at(17, 2));
  EXPECT_NE(picture.at(12, 2), picture.at(12, 7));
  EXPECT_EQ(picture.at(12, 2), picture.at(17, 7));
}

}  // namespace
}  // namespace trocar::slices
