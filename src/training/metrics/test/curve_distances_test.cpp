#include "metrics/curve_distances.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trocar::metrics {
namespace {

constexpr double kTolerance_mm = 1e-6;

TEST(CurveDistances, EqualTheOffsetOfAParallelLine) {
  const Segment expert_P{{0.0, 0.0, 0.0}, {0.0, 60.0, 0.0}};
  const std::vector<Vec3> way_P{{3.0, 0.0, 4.0}, {3.0, 20.0, 4.0}, {3.0, 60.0, 4.0}};
  const CurveDistances distances = curve_distances(way_P, expert_P);
  EXPECT_NEAR(distances.frechet_mm, 5.0, kTolerance_mm);
  EXPECT_NEAR(distances.hausdorff_mm, 5.0, kTolerance_mm);
  EXPECT_NEAR(distances.dtw_mm, 5.0, kTolerance_mm);
}

TEST(CurveDistances, OnlyFrechetCountsBacktracking) {
  const Segment expert_P{{0.0, 0.0, 0.0}, {0.0, 60.0, 0.0}};
  const std::vector<Vec3> way_P{{0.0, 0.0, 0.0}, {0.0, 60.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 60.0, 0.0}};
  constexpr double kSampling_mm = 0.6;
  const CurveDistances distances = curve_distances(way_P, expert_P);
  EXPECT_LT(distances.hausdorff_mm, kSampling_mm);
  EXPECT_NEAR(distances.frechet_mm, 20.0, kSampling_mm) << "half of the 40 mm that the tip went back";
}

std::vector<telemetry::TickSample> to_depths(const std::vector<double>& depths_mm) {
  std::vector<telemetry::TickSample> samples;
  for (const double depth_mm : depths_mm) {
    telemetry::TickSample sample;
    sample.time_s = 0.01 * static_cast<double>(samples.size());
    sample.depth_mm = std::max(0.0, depth_mm);
    sample.tip_mm = Vec3(0.0, depth_mm, 0.0);
    telemetry::set_at_rest(sample);
    samples.push_back(sample);
  }
  return samples;
}

TEST(InsertionWay, IsTheDeepestInsertionUpToItsEnd) {
  const auto samples = to_depths({-5.0, 4.0, 8.0, -2.0, 3.0, 10.0, 20.0, 12.0, -1.0, 6.0});
  const std::vector<Vec3> way_P = insertion_way(samples, {});
  ASSERT_FALSE(way_P.empty());
  EXPECT_DOUBLE_EQ(way_P.front().y(), 3.0);
  EXPECT_DOUBLE_EQ(way_P.back().y(), 20.0);
  EXPECT_DOUBLE_EQ(insertion_way(samples, 2).back().y(), 8.0) << "the shot is the end";
  EXPECT_DOUBLE_EQ(insertion_way(samples, 2).front().y(), 4.0);
}

TEST(InsertionWay, IsEmptyForANeedleThatStaysOutside) {
  EXPECT_TRUE(insertion_way({}, {}).empty());
  EXPECT_TRUE(insertion_way(to_depths({-5.0, -1.0}), {}).empty());
  EXPECT_TRUE(insertion_way(to_depths({-5.0, -1.0}), 7).empty());
}

}  // namespace
}  // namespace trocar::metrics
