#include "registration/rigid_fit.h"

#include <gtest/gtest.h>

#include <array>

#include "core/random.h"

namespace trocar::registration {
namespace {

using Points = std::vector<Vec3>;

constexpr double kRounding_mm = 1e-9;  ///< Doubles at coordinates of some 100 mm.

Points random_points(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  Points points;
  for (std::size_t n = 0; n < count; ++n)
    points.emplace_back(random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(-80, 80));
  return points;
}

Pose random_pose(std::uint64_t seed) {
  Random random(seed + 1000);
  const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
  const Mat3 R = Eigen::AngleAxisd(random.uniform(-3.1, 3.1), axis).toRotationMatrix();
  return {R, Vec3(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200))};
}

Points moved(const Pose& X, const Points& points) {
  Points result;
  for (const Vec3& p : points) result.push_back(X * p);
  return result;
}

double largest_distance(const Points& a, const Points& b) {
  double largest = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, (a[n] - b[n]).norm());
  return largest;
}

TEST(RigidFit, RecoversAnExactMotion) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Points b = random_points(seed, 3 + seed % 8);
    const Pose X_AB = random_pose(seed);
    const auto fit = fit_rigid(moved(X_AB, b), b);
    ASSERT_TRUE(fit) << fit.error().text();
    EXPECT_LT(largest_distance(moved(fit->X_AB, b), moved(X_AB, b)), kRounding_mm);
    EXPECT_LT(fit->rms_mm, kRounding_mm);
    EXPECT_NEAR(fit->scale, 1.0, 1e-12);
    EXPECT_NEAR(fit->X_AB.R().determinant(), 1.0, 1e-12);
  }
}

TEST(RigidFit, HasTheLeastResidualOfAllMotions) {
  const Points b = random_points(7, 6);
  Points a = moved(random_pose(7), b);
  Random random(70);
  for (Vec3& p : a) p += 3.0 * Vec3(random.normal(), random.normal(), random.normal());
  const auto fit = fit_rigid(a, b);
  ASSERT_TRUE(fit);
  for (int n = 0; n < 200; ++n) {
    const Vec3 axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const Pose step(Eigen::AngleAxisd(random.uniform(-0.02, 0.02), axis).toRotationMatrix(),
                    0.5 * Vec3(random.normal(), random.normal(), random.normal()));
    const Points other = moved(step * fit->X_AB, b);
    double sum = 0.0;
    for (std::size_t pair = 0; pair < a.size(); ++pair) sum += (other[pair] - a[pair]).squaredNorm();
    EXPECT_GE(std::sqrt(sum / static_cast<double>(a.size())), fit->rms_mm - 1e-12);
  }
}

TEST(RigidFit, GivesTheScaleOfASimilarity) {
  const Points b = random_points(3, 8);
  Points a = moved(random_pose(3), b);
  for (Vec3& p : a) p *= 1.07;
  const auto fit = fit_rigid(a, b);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->scale, 1.07, 1e-12);
  EXPECT_GT(fit->rms_mm, 1.0);
}

TEST(RigidFit, FindsTheWorstPair) {
  const Points b = random_points(4, 7);
  Points a = moved(random_pose(4), b);
  a[5] += Vec3(0, 15, 0);
  const auto fit = fit_rigid(a, b);
  ASSERT_TRUE(fit);
  EXPECT_EQ(worst_pair(*fit), 5u);
}

TEST(RigidFit, IgnoresAPairOfWeightZero) {
  const Points b = random_points(5, 6);
  const Pose X_AB = random_pose(5);
  Points a = moved(X_AB, b);
  a[2] += Vec3(40, 0, 0);
  const std::array<double, 6> weights = {1, 2, 0, 1, 3, 1};
  const auto fit = fit_rigid(a, b, weights);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->X_AB.p() - X_AB.p()).norm(), 1e-8);
  EXPECT_NEAR(fit->residual_mm[2], 40.0, 1e-8);
}

TEST(RigidFit, FitsPointsInOnePlane) {
  Points b = random_points(6, 5);
  for (Vec3& p : b) p.z() = 0.0;
  const Pose X_AB = random_pose(6);
  const auto fit = fit_rigid(moved(X_AB, b), b);
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_LT(largest_distance(moved(fit->X_AB, b), moved(X_AB, b)), kRounding_mm);
}

TEST(RigidFit, RefusesMirroredPairs) {
  const Points b = random_points(8, 8);
  Points a = moved(random_pose(8), b);
  for (Vec3& p : a) p.x() = -p.x();
  const auto fit = fit_rigid(a, b);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().what.find("mirrored"), std::string::npos);
}

TEST(RigidFit, RefusesPointsOnALine) {
  Points b;
  for (int n = 0; n < 6; ++n) b.emplace_back(10.0 * n, 5.0 * n + 0.01 * (n % 2), -3.0 * n);
  const auto fit = fit_rigid(moved(random_pose(9), b), b);
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().what.find("one line"), std::string::npos);
  EXPECT_FALSE(fit_rigid(Points(4, Vec3(1, 2, 3)), random_points(1, 4)));  // one place
}

TEST(RigidFit, RefusesPairsThatCannotBeFitted) {
  const Points three = random_points(1, 3);
  EXPECT_FALSE(fit_rigid(random_points(1, 2), random_points(2, 2)));
  EXPECT_FALSE(fit_rigid(three, random_points(2, 4)));
  EXPECT_FALSE(fit_rigid(three, three, std::array<double, 2>{1, 1}));
  EXPECT_FALSE(fit_rigid(three, three, std::array<double, 3>{1, 1, 0}));
  EXPECT_FALSE(fit_rigid(three, three, std::array<double, 3>{1, 1, -1}));
  Points broken = three;
  broken[1].y() = std::nan("");
  EXPECT_FALSE(fit_rigid(three, broken));
}

}  // namespace
}  // namespace trocar::registration
