// The needle against expert paths.
#include <gtest/gtest.h>

#include "metrics/curve_distances.h"
#include "metrics/testing/recording.h"

namespace trocar::metrics {
namespace {

using namespace testing;

/// In along +y from y = -10 to a depth and out again, shifted sideways.
Recording straight_puncture(const Vec3& shift, double depth_mm, double rate_hz = 200.0) {
  const double half_s = (depth_mm + 10.0) / 20.0;
  return record(2.0 * half_s, rate_hz, [&](double t, Moment& m) {
    set_depth(m, depth_mm - 20.0 * std::abs(t - half_s));
    m.tip_P += shift;
  });
}

const ExpertPath kStraight{"expert", {{0.0, 0.0, 0.0}, {0.0, 60.0, 0.0}}};

TEST(PathMetrics, EveryMeasureReportsAParallelOffset) {
  const auto values = measure(straight_puncture({3.0, 0.0, 4.0}, 60.0), with_paths({kStraight}));
  for (const char* name : {"target_distance", "entry_offset", "path_distance_mean", "path_distance_max", "targeting"})
    EXPECT_NEAR(value_of(values, name), 5.0, 1e-9) << name;
  for (const char* name : {"frechet_distance", "hausdorff_distance", "dtw_distance"})
    EXPECT_NEAR(value_of(values, name), 5.0, 0.02) << name;  // the first recorded tip is 0.1 mm deep
  EXPECT_NEAR(value_of(values, "path_angle"), 0.0, 1e-5);
  EXPECT_NEAR(*find(values, "target_distance").at_s, 3.5, 1e-9);
}

TEST(PathMetrics, OvershootIsOnThePathButMissesTheTarget) {
  const auto values = measure(straight_puncture(Vec3::Zero(), 72.0), with_paths({kStraight}));
  EXPECT_NEAR(value_of(values, "target_distance"), 12.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_distance_max"), 12.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_distance_mean"), 12.0 * 12.0 / 2.0 / 72.0, 1e-9);  // grows linearly over 12 mm
  EXPECT_NEAR(value_of(values, "frechet_distance"), 12.0, 0.1);
  EXPECT_NEAR(value_of(values, "entry_offset"), 0.0, 1e-9);
  EXPECT_NEAR(value_of(values, "targeting"), 0.0, 1e-9);  // on the way it was there
}

TEST(PathMetrics, MeasuresAngleAndEndOffsetOfATiltedPath) {
  const double angle = radians(8.0);
  const Vec3 axis_P(std::sin(angle), std::cos(angle), 0.0);
  const Recording recording = record(3.0, 200.0, [&](double t, Moment& m) {
    m.axis_P = axis_P;
    m.tip_P = 20.0 * t * axis_P;
    m.depth_mm = 20.0 * t;
  });
  const auto values = measure(recording, with_paths({kStraight}));
  EXPECT_NEAR(value_of(values, "path_angle"), 8.0, 1e-9);
  EXPECT_NEAR(value_of(values, "target_distance"), 2.0 * 60.0 * std::sin(0.5 * angle), 1e-9);
  EXPECT_NEAR(value_of(values, "path_distance_max"), 60.0 * std::sin(angle), 1e-9);
  EXPECT_NEAR(value_of(values, "path_distance_mean"), 30.0 * std::sin(angle), 1e-9);
  EXPECT_NEAR(value_of(values, "frechet_distance"), 2.0 * 60.0 * std::sin(0.5 * angle), 0.05);
}

TEST(PathMetrics, OnlyFrechetDetectsBackAndForthMotion) {
  // To 40 mm, back to 10 mm, on to 60 mm: every point lies on the path (Hausdorff 0), but a leash of 15 mm is needed.
  const Recording recording = record(6.0, 200.0, [](double t, Moment& m) {
    set_depth(m, t < 2.0 ? 20.0 * t : t < 3.5 ? 40.0 - 20.0 * (t - 2.0) : 10.0 + 20.0 * (t - 3.5));
  });
  const auto values = measure(recording, with_paths({kStraight}));
  EXPECT_NEAR(value_of(values, "hausdorff_distance"), 0.0, 0.3);
  EXPECT_NEAR(value_of(values, "frechet_distance"), 15.0, 0.5);
}

TEST(PathMetrics, UsesTheNearestExpertPath) {
  const ExpertPath far{"far", {{50.0, 0.0, 0.0}, {50.0, 60.0, 0.0}}};
  const ExpertPath near{"near", {{2.0, 0.0, 0.0}, {2.0, 60.0, 0.0}}};
  const auto values = measure(straight_puncture(Vec3::Zero(), 60.0), with_paths({far, near, kStraight}));
  EXPECT_EQ(value_of(values, "expert_path"), 3.0);
  EXPECT_EQ(find(values, "expert_path").note, "expert");
  EXPECT_NEAR(value_of(values, "target_distance"), 0.0, 1e-9);
  const auto beside = measure(straight_puncture({1.9, 0.0, 0.0}, 60.0), with_paths({far, near, kStraight}));
  EXPECT_EQ(value_of(beside, "expert_path"), 2.0);
  EXPECT_NEAR(value_of(beside, "target_distance"), 0.1, 1e-9);
}

TEST(PathMetrics, EndsAtTheShotDespiteLaterDepth) {
  MetricContext context = with_paths({kStraight});
  context.end_s = 2.0;
  const Recording recording = record(4.0, 100.0, [](double t, Moment& m) { set_depth(m, 20.0 * t); });
  const auto values = measure(recording, context);
  EXPECT_NEAR(value_of(values, "target_distance"), 20.0, 1e-9);
  EXPECT_NEAR(value_of(values, "hausdorff_distance"), 20.0, 0.1);
}

TEST(PathMetrics, ComparesOnlyTheFinalInsertion) {
  // First to 30 mm, 20 mm beside the path; then on the path to 60 mm; then 25 mm to the other side.
  Recording recording = straight_puncture({20.0, 0.0, 0.0}, 30.0);
  const auto add = [&](Recording more) {
    const double from_s = recording.back().time_s + 0.1;
    for (Moment& moment : more) {
      moment.time_s += from_s;
      recording.push_back(moment);
    }
  };
  add(straight_puncture(Vec3::Zero(), 60.0));
  add(straight_puncture({-25.0, 0.0, 0.0}, 40.0));
  const auto values = measure(recording, with_paths({kStraight}));
  EXPECT_NEAR(value_of(values, "entry_offset"), 0.0, 1e-9);
  EXPECT_LT(value_of(values, "frechet_distance"), 0.3);
  EXPECT_EQ(value_of(values, "skin_punctures"), 3.0);
  EXPECT_EQ(value_of(values, "needle_passes"), 3.0);
}

TEST(PathMetrics, WithoutDepthEndsAtTheClosestApproach) {
  Recording recording = straight_puncture({0.0, 0.0, 7.0}, 60.0);
  for (Moment& moment : recording) moment.depth_mm.reset();
  const auto values = measure(recording, with_paths({kStraight}));
  EXPECT_NEAR(value_of(values, "target_distance"), 7.0, 1e-9);
  EXPECT_FALSE(find(values, "entry_offset").value);
  EXPECT_EQ(find(values, "entry_offset").missing, "the recording has no depth and no patient was given");
}

TEST(PathMetrics, NeverInTheBodyHasNoEndPosition) {
  const Recording recording = record(1.0, 100.0, [](double, Moment& m) { set_depth(m, -5.0); });
  EXPECT_EQ(missing_of("target_distance", recording, with_paths({kStraight})),
            "the needle has no end position: it was never in the body");
  EXPECT_EQ(missing_of("target_distance", recording), "no expert path was given");
}

TEST(PathMetrics, CurveDistancesSatisfyMetricAxioms) {
  // Symmetry, identity, and Hausdorff <= Fréchet on arbitrary curves.
  std::vector<Vec3> a, b;
  for (int n = 0; n < 60; ++n) {
    const double t = 0.1 * n;
    a.emplace_back(t, std::sin(t), 0.2 * t);
    b.emplace_back(t + 0.3 * std::cos(2.0 * t), std::sin(t) + 0.5, 0.0);
  }
  const auto a1 = detail::resample(a, 100), b1 = detail::resample(b, 80);
  for (const auto distance : {detail::frechet_mm, detail::hausdorff_mm, detail::warped_mm}) {
    EXPECT_NEAR(distance(a1, b1), distance(b1, a1), 1e-12);
    EXPECT_EQ(distance(a1, a1), 0.0);
  }
  EXPECT_LE(detail::hausdorff_mm(a1, b1), detail::frechet_mm(a1, b1));
  EXPECT_LE(detail::warped_mm(a1, b1), detail::frechet_mm(a1, b1));
}

TEST(PathMetrics, BoundsMemoryForLongPaths) {
  detail::ThinPath path;
  for (int n = 0; n < 1000000; ++n) path.add({0.01 * n, 0.0, 0.0}, 0.001 * n);
  EXPECT_LE(path.points().size(), detail::ThinPath::kMostPoints);
  EXPECT_NEAR(path.points().back().p_P.x(), 10000.0, 10.0);
  for (std::size_t n = 1; n < path.points().size(); ++n)
    ASSERT_LT((path.points()[n].p_P - path.points()[n - 1].p_P).norm(), 20.0);
}

}  // namespace
}  // namespace trocar::metrics
