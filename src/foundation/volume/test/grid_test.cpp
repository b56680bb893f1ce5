#include "volume/grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "make_grids.h"

namespace trocar::volume {
namespace {

TEST(GridGeometry, IndexToMmAndBackIsIdentity) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const GridGeometry geometry = oblique_geometry({30, 20, 10}, random);
    const Vec3 index = random_vec(random, -5.0, 40.0);
    EXPECT_LT((geometry.to_index(geometry.to_mm(index)) - index).norm(), 1e-9);
  }
}

TEST(GridGeometry, PutsVoxelCentresWhereItkDoes) {
  GridGeometry geometry;
  geometry.size = {4, 5, 6};
  geometry.spacing_mm = {2.0, 3.0, 4.0};
  geometry.origin_P = {10.0, 20.0, 30.0};
  geometry.R_PV << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // i along y, j along z, k along x
  EXPECT_EQ(geometry.to_mm({0, 0, 0}), Vec3(10, 20, 30));
  EXPECT_EQ(geometry.to_mm({1, 0, 0}), Vec3(10, 22, 30));
  EXPECT_EQ(geometry.to_mm({0, 1, 0}), Vec3(10, 20, 33));
  EXPECT_EQ(geometry.to_mm({0, 0, 1}), Vec3(14, 20, 30));
  EXPECT_DOUBLE_EQ(geometry.voxel_volume_mm3(), 24.0);
}

TEST(GridGeometry, OffsetRunsFastestAlongI) {
  const GridGeometry geometry = plain_geometry({4, 5, 6});
  EXPECT_EQ(geometry.offset({0, 0, 0}), 0u);
  EXPECT_EQ(geometry.offset({1, 0, 0}), 1u);
  EXPECT_EQ(geometry.offset({0, 1, 0}), 4u);
  EXPECT_EQ(geometry.offset({0, 0, 1}), 20u);
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    EXPECT_TRUE(geometry.contains(geometry.index_of(n)));
    EXPECT_EQ(geometry.offset(geometry.index_of(n)), n);
  }
  EXPECT_FALSE(geometry.contains({4, 0, 0}));
  EXPECT_FALSE(geometry.contains({0, -1, 0}));
}

TEST(GridGeometry, MatchesWithinAHundredthOfAVoxel) {
  Random random(2);
  const GridGeometry geometry = oblique_geometry({100, 90, 80}, random);
  EXPECT_TRUE(geometry.matches(geometry));

  GridGeometry moved = geometry;
  moved.origin_P += geometry.R_PV * Vec3(0, 0, 0.009 * geometry.spacing_mm.z());
  EXPECT_TRUE(geometry.matches(moved));
  moved.origin_P += geometry.R_PV * Vec3(0, 0, 0.002 * geometry.spacing_mm.z());
  EXPECT_FALSE(geometry.matches(moved));
}

TEST(GridGeometry, DoesNotMatchIfFarCornersDiffer) {
  Random random(3);
  const GridGeometry geometry = oblique_geometry({100, 90, 80}, random);
  GridGeometry other = geometry;
  other.size[2] = 81;
  EXPECT_FALSE(geometry.matches(other));

  other = geometry;
  other.spacing_mm.x() *= 1.0 + 0.011 / 99.0;  // the last voxel is off by just over a hundredth
  EXPECT_FALSE(geometry.matches(other));

  other = geometry;
  other.R_PV = Eigen::AngleAxisd(2e-3, Vec3::UnitX()).toRotationMatrix() * geometry.R_PV;
  EXPECT_FALSE(geometry.matches(other));

  other = geometry;
  other.origin_P.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(geometry.matches(other));
}

}  // namespace
}  // namespace trocar::volume
