#include "ultrasound/sweep/detail/hole_filling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trocar::ultrasound::detail {
namespace {

/// A grid with two known slices, k = 1 and k = 1 + gap; the rest is hole.
struct TwoSlices {
  volume::LabelGrid gray;
  std::vector<std::uint8_t> known;

  TwoSlices(std::int64_t gap, std::uint8_t first, std::uint8_t second) {
    volume::GridGeometry geometry;
    geometry.size = {40, 40, gap + 3};
    gray = volume::LabelGrid(geometry);
    known.assign(gray.voxels.size(), 0);
    for (std::size_t n = 0; n < known.size(); ++n) {
      const std::int64_t k = geometry.index_of(n)[2];
      if (k != 1 && k != 1 + gap) continue;
      known[n] = 1;
      gray.voxels[n] = k == 1 ? first : second;
    }
  }
};

TEST(HoleFilling, SticksInterpolateBetweenSlices) {
  TwoSlices slices(4, 100, 140);
  // Between the slices only: outside, no stick has two ends.
  EXPECT_EQ(detail::fill_holes(slices.gray, slices.known, {HoleFilling{}}), 3U * 40 * 40);
  for (std::int64_t k = 2; k < 5; ++k) EXPECT_EQ((slices.gray[{20, 20, k}]), 100 + 10 * (k - 1));
  EXPECT_EQ((slices.gray[{20, 20, 0}]), 0);
}

TEST(HoleFilling, SticksReachNoFartherThanTheirLimit) {
  // From known to known, both counted, a gap of 7 holes takes 9 voxels.
  TwoSlices within(8, 100, 100), beyond(9, 100, 100);
  EXPECT_EQ(detail::fill_holes(within.gray, within.known, {HoleFilling{}}), 7U * 40 * 40);
  EXPECT_EQ(detail::fill_holes(beyond.gray, beyond.known, {HoleFilling{}}), 0U);
}

TEST(HoleFilling, TheShortestStickWins) {
  // One hole: 2 voxels along i hold 50, its other neighbours 200.
  volume::GridGeometry geometry;
  geometry.size = {5, 5, 5};
  volume::LabelGrid gray(geometry, 200);
  std::vector<std::uint8_t> known(gray.voxels.size(), 1);
  for (std::int64_t j = 1; j < 4; ++j)
    for (std::int64_t k = 1; k < 4; ++k) known[geometry.offset({2, j, k})] = 0;
  gray[{1, 2, 2}] = gray[{3, 2, 2}] = 50;
  volume::LabelGrid one = gray;
  detail::fill_holes(one, known, {HoleFilling{}});
  EXPECT_EQ((one[{2, 2, 2}]), 50);
  // The next ones are diagonals of 3 * sqrt(2): with two wanted, all equals of the second count.
  volume::LabelGrid two = gray;
  detail::fill_holes(two, known, {{.sticks = 2}});
  const double diagonal = 4.0 / (3.0 * std::sqrt(2.0));
  EXPECT_NEAR((two[{2, 2, 2}]), (50.0 / 3.0 + 200.0 * diagonal) / (1.0 / 3.0 + diagonal), 0.51);
}

TEST(HoleFilling, FilledVoxelsFillNoOthers) {
  TwoSlices slices(4, 100, 140);
  detail::fill_holes(slices.gray, slices.known, {{.kind = HoleFilling::Kind::kNearest, .size = 3}});
  EXPECT_EQ((slices.gray[{20, 20, 2}]), 100);
  EXPECT_EQ((slices.gray[{20, 20, 3}]), 0);  // two away from both
  EXPECT_EQ((slices.gray[{20, 20, 4}]), 140);
}

TEST(HoleFilling, GaussianWeighsByDistance) {
  TwoSlices slices(3, 100, 140);
  detail::fill_holes(slices.gray, slices.known,
                     {{.kind = HoleFilling::Kind::kGaussian, .size = 5, .sigma_voxels = 1.0}});
  // Whole planes: the weights in the plane cancel, exp(-1/2) and exp(-2) along k remain.
  const double near = std::exp(-0.5), far = std::exp(-2.0);
  EXPECT_NEAR((slices.gray[{20, 20, 2}]), (100 * near + 140 * far) / (near + far), 0.51);
}

TEST(HoleFilling, RequiresAShareOfKnownVoxels) {
  // A cube of 3 beside a slice knows 9 of 27.
  const auto filled = [](double least_share) {
    TwoSlices slices(8, 100, 140);
    return detail::fill_holes(slices.gray, slices.known,
                              {{.kind = HoleFilling::Kind::kNearest, .size = 3, .least_share = least_share}});
  };
  EXPECT_GT(filled(0.30), 0U);
  EXPECT_EQ(filled(0.34), 0U);
}

TEST(HoleFilling, TriesMethodsInOrder) {
  TwoSlices slices(9, 100, 140);
  const HoleFilling stick, nearest{.kind = HoleFilling::Kind::kNearest, .size = 3};
  EXPECT_EQ(detail::fill_holes(slices.gray, slices.known, {stick, nearest}), 4U * 40 * 40);
}

}  // namespace
}  // namespace trocar::ultrasound::detail
