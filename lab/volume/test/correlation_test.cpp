#include "lab/volume/correlation.h"

#include <gtest/gtest.h>

#include <vector>

namespace trocar::volume {
namespace {

using Image = std::vector<std::uint8_t>;

TEST(Correlation, IsPlusOrMinusOneForLinearMaps) {
  const Image a{0, 10, 20, 50, 100}, b{3, 23, 43, 103, 203}, c{200, 180, 160, 100, 0};
  EXPECT_NEAR(correlation(a, b), 1.0, 1e-12);
  EXPECT_NEAR(correlation(a, c), -1.0, 1e-12);
}

TEST(Correlation, FollowsItsDefinition) {
  // Means 2 and 3; covariance 4/3 of sums 2 * 2 / 3, deviations sqrt(2/3) and sqrt(8/3).
  EXPECT_NEAR(correlation(Image{1, 2, 3}, Image{1, 3, 5}), 1.0, 1e-12);
  EXPECT_NEAR(correlation(Image{1, 2, 3}, Image{1, 5, 3}), 0.5, 1e-12);
}

TEST(Correlation, SkipsVoxelsMissingInOneImage) {
  const Image a{0, 200, 1, 2, 3}, b{90, 0, 1, 3, 5};
  EXPECT_NEAR(correlation(a, b, ComparedVoxels::kBothAboveZero), 1.0, 1e-12);
  EXPECT_LT(correlation(a, b), 0.0);
}

TEST(Correlation, IsZeroForEmptyOrConstantImages) {
  EXPECT_EQ(correlation(Image{}, Image{}), 0.0);
  EXPECT_EQ(correlation(Image{7, 7}, Image{1, 2}), 0.0);
}

}  // namespace
}  // namespace trocar::volume
