#include <gtest/gtest.h>

#include "volume/resample.h"
#include "volume/test/make_grids.h"

namespace trocar::volume {
namespace {

CtGrid numbered(const GridGeometry& geometry) {
  CtGrid grid(geometry);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) grid.voxels[n] = static_cast<std::int16_t>(n);
  return grid;
}

TEST(AlongP, FindsTheSameGridInAll48Orders) {
  GridGeometry axial = plain_geometry({5, 4, 3}, {0.5, 1.0, 2.0});
  axial.origin_P = {-8.0, 4.0, 16.0};
  const CtGrid grid = numbered(axial);
  int orders = 0;
  for_each_storage_order([&](const auto& axis, const auto& is_turned) {
    ++orders;
    const CtGrid found = along_P(stored_in_order(grid, axis, is_turned));
    EXPECT_EQ(found.voxels, grid.voxels);
    EXPECT_EQ(found.geometry.size, axial.size);
    EXPECT_EQ(found.geometry.spacing_mm, axial.spacing_mm);
    EXPECT_EQ(found.geometry.origin_P, axial.origin_P);
    EXPECT_EQ(found.geometry.R_PV, axial.R_PV);
  });
  EXPECT_EQ(orders, 48);
}

TEST(AlongP, KeepsVoxelPositionsOfARotatedGrid) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const CtGrid grid = numbered(oblique_geometry({4, 3, 6}, random));
    const CtGrid found = along_P(grid);
    EXPECT_GT(found.geometry.R_PV.determinant(), 0.0);
    EXPECT_TRUE(order_along_P(found.geometry).is_identity());
    for (std::size_t n = 0; n < found.voxels.size(); ++n) {
      const Index3 ijk = found.geometry.index_of(n);
      const Vec3 p_P = found.geometry.centre_mm(ijk);
      const Vec3 index = grid.geometry.to_index(p_P);
      const Index3 nearest{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())};
      ASSERT_TRUE(grid.geometry.contains(nearest));
      EXPECT_EQ(found.voxels[n], grid[nearest]);
    }
  }
}

TEST(AlongP, KeepsAGridAlreadyAlongP) {
  const CtGrid grid = numbered(plain_geometry({5, 4, 3}));
  EXPECT_TRUE(order_along_P(grid.geometry).is_identity());
  EXPECT_EQ(along_P(grid).voxels, grid.voxels);
}

}  // namespace
}  // namespace trocar::volume
