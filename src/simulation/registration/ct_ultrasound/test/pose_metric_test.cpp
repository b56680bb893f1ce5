#include "registration/ct_ultrasound/detail/pose_metric.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "mattes_itk.h"

namespace trocar::registration {
namespace {
using detail::Motion;

/// Smooth local contrasts, related but not equal, on a straight grid and on an oblique one. Many samples of both lie at
/// the limits of -3 and 3: ITK spreads its bins over the values of the samples.
detail::Level waves() {
  detail::Level level;
  volume::GridGeometry geometry;
  geometry.size = {40, 36, 32};
  geometry.spacing_mm = Vec3(2.0, 2.0, 2.5);
  level.us = volume::FloatGrid(geometry);
  geometry.size = {44, 40, 48};
  geometry.spacing_mm = Vec3(1.8, 2.1, 1.9);
  geometry.R_PV = Eigen::AngleAxisd(0.2, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  geometry.origin_P = Vec3(-4, 3, -5);
  level.ct = volume::FloatGrid(geometry);
  const auto wave = [](const Vec3& p) {
    return std::sin(p.x() / 9.0) + std::cos(p.y() / 11.0 + p.x() / 30.0) + std::sin(p.z() / 8.0 + 0.4);
  };
  const auto fill = [&](volume::FloatGrid& grid, const auto& value) {
    for (std::size_t n = 0; n < grid.voxels.size(); ++n)
      grid.voxels[n] =
          static_cast<float>(std::clamp(value(wave(grid.geometry.centre_mm(grid.geometry.index_of(n)))), -3.0, 3.0));
  };
  fill(level.us, [](double v) { return 3.5 * std::cos(1.5 * v); });
  fill(level.ct, [](double v) { return 1.6 * v; });
  return level;
}

std::vector<Vec3> points_within(double margin_mm, std::size_t count) {
  Random random(3);
  std::vector<Vec3> points;
  while (points.size() < count)
    points.emplace_back(random.uniform(margin_mm, 78.0 - margin_mm), random.uniform(margin_mm, 70.0 - margin_mm),
                        random.uniform(margin_mm, 77.0 - margin_mm));
  return points;
}

const Vec3 kCentre(38, 36, 40);

std::vector<Motion> some_motions() {
  Random random(5);
  std::vector<Motion> motions(6, Motion::Zero());
  for (Motion& motion : motions)
    for (int a = 0; a < 6; ++a) motion[a] = (a < 3 ? 0.06 : 3.0) * random.uniform(-1.0, 1.0);
  return motions;
}

testing::ImageView view_of(const volume::FloatGrid& grid) {
  testing::ImageView view;
  view.voxels = grid.voxels.data();
  view.size = grid.geometry.size;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto row = static_cast<int>(a);
    view.spacing_mm[a] = grid.geometry.spacing_mm[row];
    view.origin_mm[a] = grid.geometry.origin_P[row];
    for (std::size_t b = 0; b < 3; ++b) view.direction[a][b] = grid.geometry.R_PV(row, static_cast<int>(b));
  }
  return view;
}

TEST(PoseMetric, EqualsTheMetricOfItk) {
  const detail::Level level = waves();
  const std::vector<Vec3> points = points_within(20.0, 9000);
  std::vector<std::array<double, 3>> numbers;
  for (const Vec3& p : points) numbers.push_back({p.x(), p.y(), p.z()});
  detail::PoseMetric metric(level, points, kCentre);
  testing::MattesItk itk(view_of(level.us), view_of(level.ct), numbers, {kCentre.x(), kCentre.y(), kCentre.z()}, 32);
  for (const Motion& motion : some_motions()) {
    testing::MotionNumbers same{};
    std::copy(motion.begin(), motion.end(), same.begin());
    const testing::MattesItk::Slope reference = itk.value_and_gradient(same);
    EXPECT_GT(reference.value, 0.3);
    // Interpolation in floats.
    EXPECT_NEAR(metric.value(motion), reference.value, 1e-5);
    EXPECT_NEAR(metric.slope(motion).value, reference.value, 1e-5);
    // ITK takes the gradient of the CT by differences over two voxels.
    Motion gradient;
    std::copy(reference.gradient.begin(), reference.gradient.end(), gradient.begin());
    EXPECT_NEAR((metric.slope(motion).gradient - gradient).norm(), 0.0, 0.05 * gradient.norm());
  }
}

TEST(PoseMetric, HasTheGradientOfItsValue) {
  const detail::Level level = waves();
  const std::vector<Vec3> points = points_within(20.0, 9000);
  detail::PoseMetric metric(level, points, kCentre);
  for (const Motion& motion : some_motions()) {
    const Motion gradient = metric.slope(motion).gradient;
    for (int a = 0; a < 6; ++a) {
      Motion step = Motion::Zero();
      step[a] = a < 3 ? 1e-4 : 4e-3;
      const double difference = (metric.value(motion + step) - metric.value(motion - step)) / (2.0 * step[a]);
      // The trilinear field has kinks between the voxels.
      EXPECT_NEAR(gradient[a], difference, 0.01 * gradient.norm()) << a;
    }
  }
}

TEST(PoseMetric, CountsOnlySamplesInTheCt) {
  const detail::Level level = waves();
  std::vector<Vec3> points = points_within(20.0, 3000);
  const double value = detail::PoseMetric(level, points, kCentre).value(Motion::Zero());
  for (int n = 0; n < 500; ++n) points.emplace_back(500.0 + n, 0.0, 0.0);
  detail::PoseMetric metric(level, points, kCentre);
  EXPECT_NEAR(metric.value(Motion::Zero()), value, 1e-12);
  Motion far = Motion::Zero();
  far[4] = 2000.0;
  const detail::PoseMetric::Slope slope = metric.slope(far);
  EXPECT_EQ(slope.value, 0.0);
  EXPECT_EQ(slope.gradient, Motion(Motion::Zero()));
}

TEST(PoseMetric, IsIndependentOfTheNumberOfThreads) {
  const detail::Level level = waves();
  const std::vector<Vec3> points = points_within(10.0, 20000);
  detail::PoseMetric metric(level, points, kCentre);
  const Motion motion = some_motions().front();
  const detail::PoseMetric::Slope slope = metric.slope(motion);
  run_on_threads(1, [&] {
    EXPECT_EQ(metric.slope(motion).gradient, slope.gradient);
    EXPECT_EQ(metric.value(motion), slope.value);
  });
}

TEST(PoseMetric, RoundTripsMotionsThroughPoses) {
  for (const Motion& motion : some_motions())
    EXPECT_NEAR((detail::motion_of(detail::pose_of(motion, kCentre), kCentre) - motion).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace trocar::registration
