#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/random.h"
#include "volume/resample.h"
#include "volume/testing/simd_targets.h"

namespace trocar::volume {
namespace {

FloatGrid random_grid(std::int64_t i, std::int64_t j, std::int64_t k) {
  GridGeometry geometry;
  geometry.size = {i, j, k};
  FloatGrid grid(geometry);
  Random random(1);
  for (float& v : grid.voxels) v = static_cast<float>(random.normal());
  return grid;
}

TEST(GaussianBlur, TurnsAPointIntoAGaussian) {
  GridGeometry geometry;
  geometry.size = {41, 37, 33};
  FloatGrid grid(geometry);
  grid[{20, 18, 16}] = 1000.0F;
  const Vec3 sigma(2.0, 1.5, 3.0);
  gaussian_blur(grid, sigma);
  EXPECT_NEAR(std::accumulate(grid.voxels.begin(), grid.voxels.end(), 0.0), 1000.0, 1e-2 * 1000.0);
  const double peak = 1000.0 / std::pow(2.0 * M_PI, 1.5) / sigma.prod();
  EXPECT_NEAR(static_cast<double>(grid[{20, 18, 16}]), peak, 0.01 * peak);
  const double aside = peak * std::exp(-0.5 * (4.0 / 4.0 + 1.0 / 2.25 + 9.0 / 9.0));
  EXPECT_NEAR(static_cast<double>(grid[{22, 19, 13}]), aside, 0.01 * peak);
}

TEST(GaussianBlur, AddsVariancesWhenAppliedTwice) {
  FloatGrid twice = random_grid(48, 40, 44), once = twice;
  gaussian_blur(twice, Vec3::Constant(1.5));
  gaussian_blur(twice, Vec3::Constant(2.0));
  gaussian_blur(once, Vec3::Constant(2.5));
  for (std::int64_t n = 14; n < 30; ++n)
    EXPECT_NEAR(static_cast<double>(twice[{n, 20, 22}]), static_cast<double>(once[{n, 20, 22}]), 2e-4);
}

TEST(GaussianBlur, MatchesOneThreadExactlyAndTheBaselineClosely) {
  FloatGrid many = random_grid(53, 29, 31), one = many, baseline = many;
  gaussian_blur(many, Vec3(1.7, 0.0, 2.1));
  run_on_threads(1, [&] { gaussian_blur(one, Vec3(1.7, 0.0, 2.1)); });
  EXPECT_EQ(many.voxels, one.voxels);
  {
    const testing::BaselineSimd slow;
    gaussian_blur(baseline, Vec3(1.7, 0.0, 2.1));
  }
  for (std::size_t n = 0; n < many.voxels.size(); ++n) EXPECT_NEAR(many.voxels[n], baseline.voxels[n], 1e-5F);
}

}  // namespace
}  // namespace trocar::volume
