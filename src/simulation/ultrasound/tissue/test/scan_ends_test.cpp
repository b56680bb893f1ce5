#include "ultrasound/tissue/scan_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "ultrasound/tissue/test/make_block.h"

namespace trocar::ultrasound {
namespace {

anatomy::VirtualPatient liver_block() {
  return testing::make_block({60.0, 60.0, 40.0}, {2.0, 2.0, 2.0}, [](const Vec3&) {
    return testing::BlockVoxel{testing::kLiver, 60};
  });
}

ScanGeometry short_fan() {
  ScanGeometry scan;
  scan.radius_mm = 50.0;
  scan.lines = 65;
  scan.samples = 64;
  scan.line_step = 1.0 / 64;
  scan.depth_mm = 100.0;
  return scan;
}

TEST(ScanEnds, AreTheFacesThatCutTheBody) {
  // The block has skin in front; all its other faces cut it.
  const std::vector<ScanEnd> ends = find_scan_ends(liver_block());
  ASSERT_EQ(ends.size(), 5u);
  EXPECT_TRUE(std::none_of(ends.begin(), ends.end(), [](const ScanEnd& end) { return end.normal_P.y() < -0.5; }));
  EXPECT_FALSE(is_unscanned(ends, {0.0, 20.0, 0.0}));
  EXPECT_FALSE(is_unscanned(ends, {0.0, -500.0, 0.0})) << "air in front of the skin";
  EXPECT_FALSE(is_unscanned(ends, {29.9, 20.0, 19.9}));
  EXPECT_TRUE(is_unscanned(ends, {30.1, 20.0, 0.0}));
  EXPECT_TRUE(is_unscanned(ends, {0.0, 20.0, -20.1}));
  EXPECT_TRUE(find_scan_ends(anatomy::VirtualPatient{}).empty());
}

TEST(ScanEnds, ComputeShareAndPolygonOfAHalfImage) {
  const std::vector<ScanEnd> ends = {{Vec3::UnitX(), 0.0}};
  EXPECT_NEAR(unscanned_share(ends, Pose(), short_fan()), 0.5, 1e-6);
  EXPECT_EQ(unscanned_share({}, Pose(), short_fan()), 0.0);
  const std::vector<Vec2> polygon = scanned_polygon_T(ends, Pose(), short_fan());
  ASSERT_EQ(polygon.size(), 4u);
  for (const Vec2& corner : polygon) EXPECT_LE(corner.x(), 1e-9);
  EXPECT_TRUE(scanned_polygon_T({{Vec3::UnitZ(), -1.0}}, Pose(), short_fan()).empty()) << "the plane lies beyond";
  EXPECT_EQ(scanned_polygon_T({{Vec3::UnitZ(), 1.0}}, Pose(), short_fan()).size(), 4u);
}

TEST(ScanEnds, HatchLiesBeyondTheEndsWithinTheScan) {
  const RasterGeometry raster = fit_raster(short_fan(), 200, 160);
  image::RgbImage image(200, 160);
  hatch_unscanned(image, raster, short_fan(), Pose(), {{Vec3::UnitX(), 0.0}});
  int hatched = 0, beyond = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const Vec2 p_T = raster.to_T(column, row);
      const Polar at = short_fan().to_polar(p_T);
      const bool is_beyond = p_T.x() > 0.0 && at.line <= 64.0 && at.depth_mm >= 0.0 && at.depth_mm <= 100.0;
      beyond += is_beyond ? 1 : 0;
      if (image.at(column, row) == image::Rgb{0, 0, 0}) continue;
      ++hatched;
      EXPECT_TRUE(is_beyond) << column << " " << row;
    }
  }
  EXPECT_NEAR(hatched, beyond / 12.0, 0.03 * beyond);
}

}  // namespace
}  // namespace trocar::ultrasound
