#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"
#include "registration/matching/detail/nearest.h"
#include "registration/matching/ransac.h"
#include "volume/testing/simd_targets.h"

namespace trocar::registration {
namespace {

std::vector<Descriptor> random_descriptors(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Descriptor> descriptors(count);
  for (Descriptor& d : descriptors)
    for (std::int16_t& v : d) v = static_cast<std::int16_t>(random.next() % 700);
  return descriptors;
}

std::vector<std::uint32_t> owners_in_twos(std::size_t count) {
  std::vector<std::uint32_t> owners;
  for (std::size_t n = 0; n < count; ++n) owners.push_back(static_cast<std::uint32_t>(n / 2));
  return owners;
}

std::int64_t product(const Descriptor& a, const Descriptor& b) {
  std::int64_t sum = 0;
  for (std::size_t n = 0; n < kDescriptorSize; ++n) sum += static_cast<std::int64_t>(a[n]) * b[n];
  return sum;
}

void expect_exact(const std::vector<Descriptor>& a, const std::vector<Descriptor>& b,
                  const std::vector<std::uint32_t>& owners_b,
                  const std::vector<trocar::registration::detail::Nearest>& of_a) {
  for (std::size_t n = 0; n < a.size(); ++n) {
    std::int64_t best = -1, second = -1;
    std::size_t index = 0;
    for (std::size_t m = 0; m < b.size(); ++m)
      if (product(a[n], b[m]) > best) best = product(a[n], b[m]), index = m;
    for (std::size_t m = 0; m < b.size(); ++m)
      if (owners_b[m] != owners_b[index]) second = std::max(second, product(a[n], b[m]));
    EXPECT_EQ(of_a[n].product, best);
    EXPECT_EQ(of_a[n].index, index);
    EXPECT_EQ(of_a[n].second, second);
  }
}

TEST(Nearest, IsExactInBothDirections) {
  const auto a = random_descriptors(271, 1), b = random_descriptors(133, 2);
  const auto owners_a = owners_in_twos(a.size()), owners_b = owners_in_twos(b.size());
  const auto nearest = trocar::registration::detail::find_nearest(a, owners_a, b, owners_b);
  expect_exact(a, b, owners_b, nearest.of_a);
  expect_exact(b, a, owners_a, nearest.of_b);
}

TEST(Nearest, IsIndependentOfInstructionSetAndThreads) {
  const auto a = random_descriptors(300, 3), b = random_descriptors(70, 4);
  const auto owners_a = owners_in_twos(a.size()), owners_b = owners_in_twos(b.size());
  const auto best = trocar::registration::detail::find_nearest(a, owners_a, b, owners_b);
  trocar::registration::detail::NearestOfBoth one;
  {
    const volume::testing::BaselineSimd baseline;
    run_on_threads(1, [&] { one = trocar::registration::detail::find_nearest(a, owners_a, b, owners_b); });
  }
  for (std::size_t n = 0; n < b.size(); ++n) {
    EXPECT_EQ(best.of_b[n].product, one.of_b[n].product);
    EXPECT_EQ(best.of_b[n].index, one.of_b[n].index);
    EXPECT_EQ(best.of_b[n].second, one.of_b[n].second);
  }
}

struct Pairs {
  std::vector<PointPair> pairs;
  Pose X_AB;
};
/// `good` pairs of one motion with an error of 0.5 mm, and `bad` ones at random.
Pairs random_pairs(std::uint64_t seed, int good, int bad) {
  Random random(seed);
  Pairs made;
  made.X_AB = Pose(Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                       .normalized()
                       .toRotationMatrix(),
                   Vec3(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)));
  const auto point = [&] { return Vec3(random.uniform(0, 100), random.uniform(0, 100), random.uniform(0, 100)); };
  for (int n = 0; n < good + bad; ++n) {
    const Vec3 b = point();
    const Vec3 noise = 0.3 * Vec3(random.normal(), random.normal(), random.normal());
    made.pairs.push_back({n < good ? Vec3(made.X_AB * b + noise) : point(), b});
  }
  return made;
}

TEST(Ransac, FindsTheMotionAmongWrongPairs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Pairs made = random_pairs(seed, 20, 80);
    const auto motions = *find_motions(made.pairs, 100.0, {.seed = seed});
    ASSERT_EQ(motions.size(), 1U);
    EXPECT_GE(motions[0].inliers.size(), 19U);
    EXPECT_GT(motions[0].confidence, 0.999);
    EXPECT_LT((motions[0].X_AB * Vec3(50, 50, 50) - made.X_AB * Vec3(50, 50, 50)).norm(), 0.4);
    EXPECT_LT(motions[0].trials, 20000) << "adapted to the share of inliers";
  }
}

TEST(Ransac, HasNoConfidenceInUnrelatedPairs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto motions = *find_motions(random_pairs(seed, 0, 100).pairs, 100.0, {.seed = seed});
    for (const RigidMotion& motion : motions) EXPECT_LT(motion.confidence, 0.5);
  }
}

TEST(Ransac, RejectsDegenerateSamplesAndReflections) {
  Pairs line = random_pairs(1, 0, 0);
  for (int n = 0; n < 30; ++n) {
    const Vec3 b(3.0 * n, 5.0, 7.0);
    line.pairs.push_back({line.X_AB * b, b});
  }
  EXPECT_TRUE(find_motions(line.pairs, 100.0, {})->empty());
  Pairs mirrored = random_pairs(2, 60, 0);
  for (PointPair& pair : mirrored.pairs) pair.a.x() = -pair.a.x();
  const auto motions = *find_motions(mirrored.pairs, 100.0, {});
  for (const RigidMotion& motion : motions) {
    EXPECT_LT(motion.inliers.size(), 20U);
    EXPECT_NEAR(motion.X_AB.R().determinant(), 1.0, 1e-9);
  }
}

TEST(Ransac, RefusesInvalidThresholds) {
  const auto refused = [](const auto& result) { return !result && result.error().exit_status == 2; };
  const std::vector<PointPair> none;
  for (const double value : {0.0, -1.0, 1e4, std::nan("")}) {
    EXPECT_TRUE(refused(find_motions(none, 100.0, {.inlier_mm = value})));
    EXPECT_TRUE(refused(find_motions(none, 100.0, {.certainty = value})));
  }
  EXPECT_TRUE(refused(find_motions(none, 100.0, {.most_trials = 0})));
  EXPECT_TRUE(refused(find_motions(none, 100.0, {.least_triangle_mm = -1.0})));
  EXPECT_TRUE(find_motions(none, 100.0, {})->empty());
}

}  // namespace
}  // namespace trocar::registration
