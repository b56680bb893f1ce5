#include "lab/ultrasound/image_statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"

namespace trocar::ultrasound {
namespace {

std::vector<float> rayleigh(std::size_t count, double rms, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> values(count);
  for (float& value : values)
    value = static_cast<float>(rms / std::sqrt(2.0) * std::hypot(random.normal(), random.normal()));
  return values;
}

TEST(TargetVisibility, FindsTheContrastThatWasSet) {
  const auto background = rayleigh(40000, 1.0, 1);
  for (const double set_db : {-12.0, -6.0, 6.0, 12.0}) {
    const auto inside = rayleigh(40000, std::pow(10.0, set_db / 20.0), 2);
    EXPECT_NEAR(target_visibility(inside, background).contrast_db, set_db, 0.15) << set_db;
  }
}

TEST(TargetVisibility, MatchesTheClosedFormForRayleighLevels) {
  // Intensities are exponential with means 1 and r; their densities cross at r ln r / (r - 1).
  const double ratio = 4.0;
  const double cross = ratio * std::log(ratio) / (ratio - 1.0);
  const double expected = std::exp(-cross / ratio) - std::exp(-cross);
  const auto visibility = target_visibility(rayleigh(200000, 2.0, 3), rayleigh(200000, 1.0, 4));
  EXPECT_NEAR(visibility.gcnr, expected, 0.01);
  const double mean = std::sqrt(std::acos(-1.0)) / 2.0;
  EXPECT_NEAR(visibility.cnr, mean * (2.0 - 1.0) / std::sqrt((1.0 - mean * mean) * (4.0 + 1.0)), 0.01);
}

TEST(TargetVisibility, IsZeroForEqualAndOneForDisjointRegions) {
  EXPECT_LT(target_visibility(rayleigh(200000, 1.0, 5), rayleigh(200000, 1.0, 6)).gcnr, 0.02);
  EXPECT_DOUBLE_EQ(target_visibility(std::vector<float>{1, 2}, std::vector<float>{8, 9}).gcnr, 1.0);
}

TEST(GrayHistogram, SharesSumToOneAndGivePercentiles) {
  std::vector<std::uint8_t> grays;
  for (int i = 0; i < 100; ++i) grays.push_back(static_cast<std::uint8_t>(i));
  const GrayHistogram histogram = gray_histogram(grays);
  EXPECT_EQ(gray_percentile(histogram, 0.5), 49);
  EXPECT_EQ(gray_percentile(histogram, 1.0), 99);
  EXPECT_NEAR(mean_gray(histogram), 49.5, 1e-9);
}

TEST(EarthMoverDistance, EqualsTheShiftOfAShiftedHistogram) {
  std::vector<std::uint8_t> a, b;
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    a.push_back(static_cast<std::uint8_t>(random.uniform(0.0, 200.0)));
    b.push_back(static_cast<std::uint8_t>(a.back() + 17));
  }
  EXPECT_NEAR(earth_mover_distance(gray_histogram(a), gray_histogram(b)), 17.0, 1e-9);
  EXPECT_NEAR(earth_mover_distance(gray_histogram(b), gray_histogram(a)), 17.0, 1e-9);
  EXPECT_DOUBLE_EQ(earth_mover_distance(gray_histogram(a), gray_histogram(a)), 0.0);
}

TEST(BhattacharyyaDistance, IsZeroForEqualAndInfiniteForDisjoint) {
  const GrayHistogram black = gray_histogram(std::vector<std::uint8_t>{0});
  const GrayHistogram white = gray_histogram(std::vector<std::uint8_t>{255});
  const GrayHistogram both = gray_histogram(std::vector<std::uint8_t>{0, 255});
  EXPECT_DOUBLE_EQ(bhattacharyya_distance(black, black), 0.0);
  EXPECT_TRUE(std::isinf(bhattacharyya_distance(black, white)));
  EXPECT_NEAR(bhattacharyya_distance(black, both), 0.5 * std::log(2.0), 1e-12);
}

}  // namespace
}  // namespace trocar::ultrasound
