// The map between the anatomy at rest and the patient now: against closed forms, differences and its own inverse.
#include "motion/patient_motion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

#include "motion/motion_file.h"

namespace trocar::motion {
namespace {

/// A chest wall (x > 60) that stands still beside an inside that slides along it, is sheared, and has a bump.
MotionParts sliding_parts() {
  MotionParts parts;
  parts.drivers = {"diaphragm", "chest"};
  parts.regions = {{"wall", {{-Vec3::UnitX(), -60.0}}}, {"inside", {}}};
  MotionMode slide;
  slide.region = 1;
  slide.displacement_mm = {0.0, 0.0, -15.0};
  MotionMode shear;
  shear.region = 1;
  shear.profile = Profile::kRamp;
  shear.displacement_mm = {0.0, 12.0, 0.0};
  shear.axis_A = Vec3::UnitZ();
  shear.extent_mm = 80.0;
  MotionMode bump;
  bump.driver = 1;
  bump.profile = Profile::kBump;
  bump.displacement_mm = {0.0, -10.0, 4.0};
  bump.centre_A = {10.0, -30.0, 20.0};
  bump.extent_mm = 40.0;
  parts.modes = {slide, shear, bump};
  return parts;
}

std::shared_ptr<const MotionModel> made(MotionParts parts) {
  auto model = MotionModel::make(std::move(parts), "test");
  EXPECT_TRUE(model) << model.error().text();
  return model.value_or(nullptr);
}

MotionState state_of(double diaphragm, double chest) {
  MotionState state;
  state.drivers = {diaphragm, chest};
  state.rates_per_s = {0.7, -1.1};
  return state;
}

std::vector<Vec3> places(int count, double half_mm) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-half_mm, half_mm);
  std::vector<Vec3> list;
  for (int n = 0; n < count; ++n) {
    const double x = place(random), y = place(random), z = place(random);
    list.emplace_back(x, y, z);
  }
  return list;
}

TEST(PatientMotion, IsTheIdentityWithoutAModel) {
  const PatientMotion motion;
  const Vec3 p(12.3, -4.5, 6.7);
  EXPECT_TRUE(motion.is_rest());
  EXPECT_EQ(motion.to_now(p), p);
  EXPECT_EQ(motion.to_rest(p), p);
  EXPECT_EQ(motion.jacobian(p), Mat3::Identity());
  EXPECT_EQ(motion.velocity(p), Vec3::Zero());
  EXPECT_EQ(motion.gradient_to_now(p, p), p);
}

TEST(PatientMotion, FollowsClosedForms) {
  const auto model = made(sliding_parts());
  const PatientMotion motion(model.get(), state_of(1.0, 0.5));
  // The wall: the bump alone.
  const Vec3 wall(90.0, -30.0, 20.0);
  const double weight = 0.5 * std::exp(-0.5 * 80.0 * 80.0 / (40.0 * 40.0));
  EXPECT_LT((motion.to_now(wall) - wall - weight * Vec3(0.0, -10.0, 4.0)).norm(), 1e-12);
  // Inside, far from the bump: slide and shear.
  const Vec3 inside(-400.0, 0.0, 40.0);
  EXPECT_LT((motion.to_now(inside) - inside - Vec3(0.0, 6.0, -15.0)).norm(), 1e-9);
  EXPECT_EQ(motion.region(wall), 0);
  EXPECT_EQ(motion.region(inside), 1);
}

TEST(PatientMotion, InverseReturnsToTheSamePoint) {
  const auto model = made(sliding_parts());
  for (const auto& [diaphragm, chest] : {std::pair(1.5, 1.5), std::pair(-1.5, 1.0), std::pair(0.3, -1.5)}) {
    const PatientMotion motion(model.get(), state_of(diaphragm, chest));
    double worst_mm = 0.0;
    for (const Vec3& p_A : places(2000, 150.0))
      worst_mm = std::max(worst_mm, (motion.to_rest(motion.to_now(p_A)) - p_A).norm());
    EXPECT_LT(worst_mm, 1e-6);
  }
}

TEST(PatientMotion, JacobianAndVelocityAreTheDerivatives) {
  const auto model = made(sliding_parts());
  constexpr double kStep = 1e-5;
  const MotionState state = state_of(0.8, 1.2);
  const PatientMotion motion(model.get(), state);
  MotionState later = state;
  for (std::size_t i = 0; i < kMostDrivers; ++i) later.drivers[i] += kStep * state.rates_per_s[i];
  const PatientMotion moved(model.get(), later);
  for (const Vec3& p_A : places(200, 120.0)) {
    if (std::abs(p_A.x() - 60.0) < 0.1) continue;  // the tissue tears there
    const Mat3 jacobian = motion.jacobian(p_A);
    EXPECT_GT(jacobian.determinant(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      const Vec3 slope = (motion.to_now(p_A + step) - motion.to_now(p_A - step)) / (2.0 * kStep);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-6);
    }
    EXPECT_LT(((moved.to_now(p_A) - motion.to_now(p_A)) / kStep - motion.velocity(p_A)).norm(), 1e-6);
  }
}

/// A force in A does the same work on a small motion in A as its image does on the image of the motion.
TEST(PatientMotion, ForceTransformPreservesWork) {
  const auto model = made(sliding_parts());
  const PatientMotion motion(model.get(), state_of(1.0, 1.0));
  const Vec3 p_A(5.0, -20.0, 30.0), force_A(1.0, -2.0, 0.5), step_A(0.3, 0.1, -0.2);
  const double work = motion.gradient_to_now(p_A, force_A).dot(motion.line_to_now(p_A, step_A));
  EXPECT_NEAR(work, force_A.dot(step_A), 1e-12);
  EXPECT_LT((motion.line_to_rest(p_A, motion.line_to_now(p_A, step_A)) - step_A).norm(), 1e-12);
}

/// Along a border that slides, every place now has one tissue, and it is the one that came there.
TEST(PatientMotion, SlidesAlongABorderWithoutGaps) {
  MotionParts parts = sliding_parts();
  parts.modes.resize(1);
  const auto model = made(parts);
  const PatientMotion motion(model.get(), state_of(1.0, 0.0));
  EXPECT_LT((motion.to_rest({59.999, 0.0, 0.0}) - Vec3(59.999, 0.0, 15.0)).norm(), 1e-6);
  EXPECT_LT((motion.to_rest({60.001, 0.0, 0.0}) - Vec3(60.001, 0.0, 0.0)).norm(), 1e-6);
}

/// Where regions part or meet, the tissue beside the gap, or the first region, has the place.
TEST(PatientMotion, ClosesGapsByTheNearestRegion) {
  MotionParts parts = sliding_parts();
  parts.modes.resize(1);
  parts.modes[0].displacement_mm = {-8.0, 0.0, 0.0};  // away from the wall
  const auto model = made(parts);
  const PatientMotion apart(model.get(), state_of(1.0, 0.0));
  EXPECT_LT((apart.to_rest({57.0, 0.0, 0.0}) - Vec3(57.0, 0.0, 0.0)).norm(), 1e-6) << "the wall is 3 mm away";
  EXPECT_LT((apart.to_rest({53.0, 0.0, 0.0}) - Vec3(61.0, 0.0, 0.0)).norm(), 1e-6) << "the inside is 1 mm away";
  const PatientMotion over(model.get(), state_of(-1.0, 0.0));
  EXPECT_LT((over.to_rest({62.0, 0.0, 0.0}) - Vec3(62.0, 0.0, 0.0)).norm(), 1e-6) << "the wall is listed first";
}

TEST(MotionClock, BreathesFromEndExpirationAndHoldsBreath) {
  const auto model = made(sliding_parts());
  MotionClock clock{model.get(), {}};
  clock.drive.period_s = 4.0;
  clock.drive.begins_s = 1.0;
  clock.drive.depth = {1.0, 0.5};
  EXPECT_EQ(clock.at(1.0).state().drivers[0], 0.0);
  EXPECT_NEAR(clock.at(3.0).state().drivers[0], 1.0, 1e-12);
  EXPECT_NEAR(clock.at(3.0).phase(), 0.5, 1e-12);
  EXPECT_NEAR(clock.at(-2.0).state().drivers[1], 0.25, 1e-12) << "before the first breath";
  EXPECT_NEAR(clock.at(2.0).state().rates_per_s[0], std::numbers::pi / 4.0, 1e-12);
  clock.drive.is_held = true;
  clock.drive.held_phase = 0.5;
  EXPECT_EQ(clock.at(1.0).to_now(Vec3::Zero()), clock.at(2.7).to_now(Vec3::Zero()));
  EXPECT_EQ(clock.at(1.3).velocity(Vec3::Zero()), Vec3::Zero());
  EXPECT_TRUE(MotionClock{}.at(5.0).is_rest());
}

TEST(MotionClock, RefusesImplausibleBreathing) {
  MotionDrive drive;
  EXPECT_TRUE(check(drive));
  drive.period_s = 0.0;
  EXPECT_FALSE(check(drive));
  drive = {};
  drive.depth[3] = std::nan("");
  EXPECT_FALSE(check(drive));
  drive = {};
  drive.held_phase = 1.5;
  EXPECT_FALSE(check(drive));
}

TEST(MotionFile, RoundTripsBitwise) {
  const auto model = made(sliding_parts());
  const std::string text = to_toml(*model);
  const auto again = parse_motion(text, "motion.toml");
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ((*again)->hash(), model->hash());
  EXPECT_EQ(to_toml(**again), text);
  MotionParts other = sliding_parts();
  other.modes[2].extent_mm = std::nextafter(40.0, 41.0);
  EXPECT_NE(made(other)->hash(), model->hash());
}

TEST(MotionFile, RefusesMalformedModels) {
  const std::string good = to_toml(*made(sliding_parts()));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return parse_motion(text, "motion.toml");
  };
  for (const auto& [from, to] :
       {std::pair("format = 1", "format = 2"), std::pair("\"bump\"", "\"dent\""),
        std::pair("extent_mm = 40", "extent = 40"), std::pair("extent_mm = 40", "extent_mm = 2"),
        std::pair("extent_mm = 40", "extent_mm = nan"), std::pair("driver = \"chest\"", "driver = \"heart\""),
        std::pair("name = \"inside\"", "name = \"inside\"\nsides = [[1.0, 0.0, 0.0, 5.0]]"),
        std::pair("-60.0]", "-60.0, 1.0]"), std::pair("[[-1", "[[-2")}) {
    const auto read = with(from, to);
    ASSERT_FALSE(read) << to;
    EXPECT_NE(read.error().text().find("motion.toml"), std::string::npos) << read.error().text();
  }
  EXPECT_FALSE(parse_motion("", "motion.toml"));
  EXPECT_FALSE(parse_motion(good.substr(0, good.size() / 2), "motion.toml"));
}

}  // namespace
}  // namespace trocar::motion
