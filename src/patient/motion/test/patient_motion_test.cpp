// The map between the anatomy at rest and the patient now: against closed forms, differences and its own inverse.
#include "motion/patient_motion.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "motion/motion_file.h"
#include "motion/testing/sliding_motion.h"

namespace trocar::motion {
namespace {

using testing::bump, testing::flat_border, testing::lattice_around, testing::ramp, testing::uniform;

/// A chest wall (x > 60) that moves a little itself, beside an inside that slides along it, is sheared, and has a bump.
MotionParts sliding_parts() {
  const auto slide = uniform({0.0, 0.0, -15.0});
  const auto shear = ramp({0.0, 12.0, 0.0}, Vec3::Zero(), Vec3::UnitZ(), 80.0);
  MotionParts parts = testing::sliding_parts(
      flat_border(-Vec3::UnitX(), -60.0),
      {[=](const Vec3& p) -> Vec3 { return slide(p) + shear(p); }, bump({0.0, -10.0, 4.0}, {10.0, -30.0, 20.0}, 40.0)});
  parts.drivers = {"diaphragm", "chest"};
  parts.modes[1] = parts.modes[3];  // the chest moves with the bump
  return parts;
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
  const auto model = testing::made(sliding_parts());
  // Inside: slide and shear are linear, and a quadratic spline has them exactly.
  const PatientMotion slide(model.get(), state_of(1.0, 0.0));
  const Vec3 inside(-100.0, 33.0, 40.0);
  EXPECT_LT((slide.to_now(inside) - inside - Vec3(0.0, 6.0, -15.0)).norm(), 1e-5);
  EXPECT_EQ(slide.region(inside), 1);
  // The bump, as fine as the nodes are.
  const PatientMotion chest(model.get(), state_of(0.0, 0.5));
  const Vec3 wall(90.0, -30.0, 20.0);
  const double weight = 0.5 * std::exp(-0.5 * 80.0 * 80.0 / (40.0 * 40.0));
  EXPECT_LT((chest.to_now(wall) - wall - weight * Vec3(0.0, -10.0, 4.0)).norm(), 0.01);
  EXPECT_EQ(chest.region(wall), 0);
  // Squares, between and beyond the nodes.
  const auto square = testing::made(
      testing::whole_body({[](const Vec3& p) { return Vec3(1e-3 * p.y() * p.y(), 0.0, -5e-4 * p.x() * p.z()); }},
                          lattice_around(Vec3::Zero(), 100.0, 10.0)));
  const PatientMotion curved(square.get(), state_of(1.0, 0.0));
  const Vec3 p(13.7, -41.3, 22.2);
  EXPECT_LT((curved.to_now(p) - p - Vec3(1e-3 * p.y() * p.y(), 0.0, -5e-4 * p.x() * p.z())).norm(), 2e-5);
  EXPECT_EQ(curved.to_now({500.0, 0.0, 0.0}) - curved.to_now({95.0, 0.0, 0.0}), Vec3(405.0, 0.0, 0.0));
}

TEST(PatientMotion, CountsFromWhereTheCtWasTaken) {
  MotionParts parts = sliding_parts();
  parts.at_ct = {0.4, 0.0};
  const auto model = testing::made(parts);
  const Vec3 p(-100.0, 0.0, 0.0);
  EXPECT_EQ(PatientMotion(model.get(), state_of(0.4, 0.0)).to_now(p), p);
  EXPECT_NEAR(PatientMotion(model.get(), state_of(0.0, 0.0)).to_now(p).z(), 6.0, 1e-5);
}

TEST(PatientMotion, InverseReturnsToTheSamePoint) {
  const auto model = testing::made(sliding_parts());
  for (const auto& [diaphragm, chest] : {std::pair(1.5, 1.5), std::pair(-1.5, 1.0), std::pair(0.3, -1.5)}) {
    const PatientMotion motion(model.get(), state_of(diaphragm, chest));
    double worst_mm = 0.0;
    for (const Vec3& p_A : places(2000, 150.0))
      worst_mm = std::max(worst_mm, (motion.to_rest(motion.to_now(p_A)) - p_A).norm());
    EXPECT_LT(worst_mm, 2e-5);
  }
}

TEST(PatientMotion, JacobianAndVelocityAreTheDerivatives) {
  const auto model = testing::made(sliding_parts());
  constexpr double kStep_mm = 0.05, kStep_s = 0.01;
  const MotionState state = state_of(0.8, 1.2);
  const PatientMotion motion(model.get(), state);
  MotionState later = state;
  for (std::size_t i = 0; i < kMostDrivers; ++i) later.drivers[i] += kStep_s * state.rates_per_s[i];
  const PatientMotion moved(model.get(), later);
  for (const Vec3& p_A : places(200, 120.0)) {
    if (std::abs(p_A.x() - 60.0) < 0.1) continue;  // the tissue tears there
    const Mat3 jacobian = motion.jacobian(p_A);
    EXPECT_GT(jacobian.determinant(), 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep_mm * Vec3::Unit(axis);
      const Vec3 slope = (motion.to_now(p_A + step) - motion.to_now(p_A - step)) / (2.0 * kStep_mm);
      EXPECT_LT((slope - jacobian.col(axis)).norm(), 1e-4);
    }
    EXPECT_LT(((moved.to_now(p_A) - motion.to_now(p_A)) / kStep_s - motion.velocity(p_A)).norm(), 1e-3);
  }
}

/// A force in A does the same work on a small motion in A as its image does on the image of the motion.
TEST(PatientMotion, ForceTransformPreservesWork) {
  const auto model = testing::made(sliding_parts());
  const PatientMotion motion(model.get(), state_of(1.0, 1.0));
  const Vec3 p_A(5.0, -20.0, 30.0), force_A(1.0, -2.0, 0.5), step_A(0.3, 0.1, -0.2);
  const double work = motion.gradient_to_now(p_A, force_A).dot(motion.line_to_now(p_A, step_A));
  EXPECT_NEAR(work, force_A.dot(step_A), 1e-12);
  EXPECT_LT((motion.line_to_rest(p_A, motion.line_to_now(p_A, step_A)) - step_A).norm(), 1e-12);
}

/// Along a border that slides, every place now has one tissue, and it is the one that came there.
TEST(PatientMotion, SlidesAlongABorderWithoutGaps) {
  const auto model =
      testing::made(testing::sliding_parts(flat_border(-Vec3::UnitX(), -60.0), {uniform({0.0, 0.0, -15.0})}));
  const PatientMotion motion(model.get(), state_of(1.0, 0.0));
  EXPECT_LT((motion.to_rest({59.999, 0.0, 0.0}) - Vec3(59.999, 0.0, 15.0)).norm(), 1e-5);
  EXPECT_LT((motion.to_rest({60.001, 0.0, 0.0}) - Vec3(60.001, 0.0, 0.0)).norm(), 1e-5);
}

/// Where regions part or meet, the border is in the middle, and the tissue is one that comes back to about that place.
TEST(PatientMotion, SharesGapsAndOverlaps) {
  const auto model = testing::made(
      testing::sliding_parts(flat_border(-Vec3::UnitX(), -60.0), {uniform({-8.0, 0.0, 0.0})}));  // away from the wall
  const PatientMotion apart(model.get(), state_of(1.0, 0.0));
  EXPECT_LT((apart.to_rest({57.0, 0.0, 0.0}) - Vec3(60.0, 0.0, 0.0)).norm(), 0.01) << "the edge of the wall";
  EXPECT_LT((apart.to_rest({55.0, 0.0, 0.0}) - Vec3(60.0, 0.0, 0.0)).norm(), 0.01) << "the edge of the inside";
  EXPECT_EQ(apart.region(apart.to_rest({57.0, 0.0, 0.0})), 0);
  EXPECT_EQ(apart.region(apart.to_rest({55.0, 0.0, 0.0})), 1);
  const auto towards =
      testing::made(testing::sliding_parts(flat_border(-Vec3::UnitX(), -60.0), {uniform({8.0, 0.0, 0.0})}));
  const PatientMotion over(towards.get(), state_of(1.0, 0.0));
  EXPECT_LT((over.to_rest({65.0, 0.0, 0.0}) - Vec3(65.0, 0.0, 0.0)).norm(), 1e-5) << "the wall";
  EXPECT_LT((over.to_rest({63.0, 0.0, 0.0}) - Vec3(55.0, 0.0, 0.0)).norm(), 1e-5) << "the inside";
}

TEST(MotionModel, RefusesWhatIsNoMap) {
  const auto refused = [](MotionParts parts) { return !MotionModel::make(std::move(parts), "test").has_value(); };
  EXPECT_FALSE(refused(sliding_parts()));
  // Tissue that would fold over: shortened to less than nothing.
  EXPECT_TRUE(refused(testing::whole_body({ramp({0.0, 0.0, -60.0}, Vec3::Zero(), Vec3::UnitZ(), 80.0)})));
  // A shear of the same size turns and stretches, but does not fold.
  EXPECT_FALSE(refused(testing::whole_body({ramp({60.0, 0.0, 0.0}, Vec3::Zero(), Vec3::UnitZ(), 80.0)},
                                           lattice_around(Vec3::Zero(), 100.0, 10.0))));
  for (int fault = 0; fault < 9; ++fault) {
    MotionParts parts = sliding_parts();
    if (fault == 0) parts.drivers = {};
    if (fault == 1) parts.drivers.emplace_back("a third one");
    if (fault == 2) parts.regions = {"body"};
    if (fault == 3) parts.regions[0].clear();
    if (fault == 4) parts.modes[2].pop_back();
    if (fault == 5) parts.modes[2][5].x() = std::nanf("");
    if (fault == 6) parts.border_mm = {};
    if (fault == 7) parts.at_ct[0] = 9.0;
    if (fault == 8) parts.lattice.spacing_mm.y() = 0.0;
    EXPECT_TRUE(refused(std::move(parts))) << fault;
  }
}

TEST(MotionFile, RoundTripsBitwise) {
  MotionParts parts = sliding_parts();
  parts.at_ct = {0.1, -0.2};
  parts.source = "a \"test\"";
  const auto model = testing::made(parts);
  auto read = parse_motion(to_toml(*model), "motion.toml");
  ASSERT_TRUE(read) << read.error().text();
  MotionParts& again = read->parts;
  ASSERT_TRUE(unstack_modes(stack_modes(parts), again, "motion_modes.nrrd"));
  again.border_mm = parts.border_mm;
  EXPECT_EQ(again.source, parts.source);
  EXPECT_EQ(read->hash, model->hash());
  EXPECT_EQ(hash_motion(again), model->hash());
  MotionParts other = parts;
  other.modes[2][77].y() += 1e-4F;
  EXPECT_NE(hash_motion(other), hash_motion(parts));
  other = parts;
  other.border_mm.voxels[3] += 1.0F;
  EXPECT_NE(hash_motion(other), hash_motion(parts));
}

TEST(MotionFile, RefusesMalformedModels) {
  const std::string good = to_toml(*testing::made(sliding_parts()));
  for (const auto& [from, to] :
       {std::pair("format = 2", "format = 1"), std::pair("format = 2", "format = 3"), std::pair("drivers", "driver"),
        std::pair("at_ct = [0.0", "at_ct = [7.0"), std::pair("at_ct = [0.0, ", "at_ct = [")}) {
    std::string text = good;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << text;
    text.replace(at, std::string(from).size(), to);
    const auto read = parse_motion(text, "motion.toml");
    ASSERT_FALSE(read) << to;
    EXPECT_NE(read.error().text().find("motion.toml"), std::string::npos) << read.error().text();
  }
  EXPECT_FALSE(parse_motion("", "motion.toml"));
  MotionParts parts = sliding_parts();
  volume::FloatGrid stack = stack_modes(parts);
  stack.geometry.size[2] -= 1;
  EXPECT_FALSE(unstack_modes(stack, parts, "motion_modes.nrrd"));
}

}  // namespace
}  // namespace trocar::motion
