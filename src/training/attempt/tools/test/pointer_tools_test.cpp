#include "attempt/tools/pointer_tools.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "motion/testing/sliding_motion.h"
#include "phantom/phantom.h"
#include "volume/sampling.h"

namespace trocar::attempt {
namespace {

const anatomy::VirtualPatient& patient() {
  static const anatomy::VirtualPatient the_patient = *phantom::generate_phantom("layers-liver");
  return the_patient;
}

/// From the front, through the middle of the skin.
Segment path() {
  const volume::GridGeometry& grid = patient().skin_distance_mm.geometry;
  const Vec3 middle_P =
      grid.to_mm(Vec3(0.5 * static_cast<double>(grid.size[0]), 0.5 * static_cast<double>(grid.size[1]),
                      0.5 * static_cast<double>(grid.size[2])));
  const Vec3 entry_P = anatomy::SkinNow(patient()).nearest(middle_P);
  return {entry_P, entry_P + 60.0 * anatomy::SkinNow(patient()).inward(entry_P)};
}

PointerNeedle needle() {
  return {patient(), path(), 150.0};
}

TEST(PointerNeedle, AimsAlongThePathBeforeTheSkin) {
  const PointerNeedle hand = needle();
  EXPECT_FALSE(hand.is_past_skin());
  EXPECT_NEAR((hand.X_PN().p() - (path().a - PointerNeedle::kAbove_mm * path().direction())).norm(), 0.0, 1e-9);
  EXPECT_NEAR(hand.X_PN().R().col(2).dot(path().direction()), 1.0, 1e-12);
}

TEST(PointerNeedle, ApproachesThePathInBoundedSteps) {
  constexpr double kStep_mm = 2.0, kStep_rad = 0.05;
  PointerNeedle hand = needle();
  for (int step = 0; step < 30; ++step) hand.glide({1.0, 0.0, 0.5});
  hand.tilt(Vec3::UnitX(), Vec3::UnitZ(), 0.3, 0.0);
  ASSERT_GT((hand.entry_P() - path().a).norm(), 20.0);
  int steps = 0;
  for (bool is_there = false; !is_there && steps < 100; ++steps) {
    const Vec3 before_P = hand.entry_P(), axis_before_P = hand.X_PN().R().col(2);
    is_there = hand.approach(path(), kStep_mm, kStep_rad);
    EXPECT_LE((hand.entry_P() - before_P).norm(), 1.1 * kStep_mm);
    EXPECT_LE(angle_between_rad(hand.X_PN().R().col(2), axis_before_P), kStep_rad + 1e-9);
    EXPECT_GT(volume::sample_linear(patient().skin_distance_mm, hand.X_PN().p()), 5.0) << "the tip stays outside";
  }
  EXPECT_LT(steps, 60);
  EXPECT_NEAR((hand.X_PN().p() - needle().X_PN().p()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(angle_between_rad(hand.X_PN().R().col(2), path().direction()), 0.0, 1e-6);
}

TEST(PointerNeedle, DoesNotChangePathInsideTheBody) {
  PointerNeedle hand = needle();
  hand.push(PointerNeedle::kAbove_mm + 30.0);
  const Vec3 tip_P = hand.X_PN().p();
  const Vec3 beside_P(10.0, 0.0, 0.0);
  EXPECT_TRUE(hand.approach({path().a + beside_P, path().b + beside_P}, 2.0, 0.05));
  EXPECT_EQ(hand.X_PN().p(), tip_P);
}

TEST(PointerNeedle, GlidesOverTheSkinAndKeepsItsHeight) {
  PointerNeedle hand = needle();
  for (int step = 0; step < 20; ++step) hand.glide({1.0, 3.0, 0.5});
  EXPECT_NEAR(volume::sample_linear(patient().skin_distance_mm, hand.entry_P()), 0.0, 0.1);
  EXPECT_NEAR((hand.X_PN().p() - hand.entry_P()).norm(), PointerNeedle::kAbove_mm, 1e-9);
  EXPECT_GT((hand.entry_P() - path().a).norm(), 10.0);
}

TEST(PointerNeedle, FollowsThePointerInAnObliqueView) {
  const Vec3 inward_P = path().direction();
  const Vec3 across_P = inward_P.unitOrthogonal();
  for (const double oblique_rad : {0.0, 0.5, -1.0}) {
    const Vec3 seen_along_P = Eigen::AngleAxisd(oblique_rad, across_P) * inward_P;
    const Vec3 right_P = across_P.cross(seen_along_P);
    PointerNeedle hand = needle();
    for (int step = 0; step < 10; ++step) hand.glide(0.5 * right_P, seen_along_P);
    const Vec3 way_P = hand.entry_P() - path().a;
    EXPECT_NEAR(way_P.dot(right_P), 5.0, 0.3) << oblique_rad;
    EXPECT_NEAR(way_P.dot(across_P), 0.0, 0.3) << oblique_rad;
  }
  // A view that grazes the skin does not throw the needle far.
  PointerNeedle hand = needle();
  hand.glide(2.0 * inward_P, across_P);
  EXPECT_LT((hand.entry_P() - path().a).norm(), 0.5);
}

TEST(PointerNeedle, TurnsAboutItsEntryInTheBody) {
  PointerNeedle hand = needle();
  hand.push(PointerNeedle::kAbove_mm + 40.0);
  const Vec3 entry_P = hand.entry_P(), tip_P = hand.X_PN().p();
  hand.glide({5.0, 0.0, 0.0});
  EXPECT_EQ(hand.entry_P(), entry_P);
  EXPECT_NEAR((hand.X_PN().p() - entry_P).norm(), 40.0, 1e-9);
  // The hub goes with the hand, the tip the other way.
  EXPECT_LT(hand.X_PN().p().x(), tip_P.x() - 1.0);
}

TEST(PointerNeedle, PushesAlongItsAxisWithinBounds) {
  PointerNeedle hand = needle();
  hand.push(1.5);
  EXPECT_NEAR(hand.past_mm(), 1.5 - PointerNeedle::kAbove_mm, 1e-12);
  for (int step = 0; step < 100; ++step) hand.push(10.0);
  EXPECT_DOUBLE_EQ(hand.past_mm(), 145.0);
  for (int step = 0; step < 100; ++step) hand.push(-10.0);
  EXPECT_DOUBLE_EQ(hand.past_mm(), -PointerNeedle::kFarthest_mm);
}

TEST(PointerNeedle, TurnsItsBevelByTheShorterArcInBoundedSteps) {
  constexpr double kStep_rad = 0.05;
  for (const double from_rad : {0.0, 1.0, -2.5, 3.1}) {
    PointerNeedle hand = needle();
    hand.turn(from_rad);
    const Vec3 goal_P = (Vec3::UnitX() + 0.4 * path().direction() + 0.2 * Vec3::UnitZ()).normalized();
    const Vec3 axis_P = hand.X_PN().R().col(2);
    const Vec3 across_P = (goal_P - goal_P.dot(axis_P) * axis_P).normalized();
    const double left_rad = angle_between_rad(hand.X_PN().R().col(1), across_P);
    int steps = 0;
    for (bool is_there = false; !is_there && steps < 200; ++steps) {
      const Pose before = hand.X_PN();
      is_there = hand.turn_bevel(goal_P, kStep_rad);
      EXPECT_LE(angle_between_rad(hand.X_PN().R().col(1), before.R().col(1)), kStep_rad + 1e-9);
      EXPECT_NEAR((hand.X_PN().p() - before.p()).norm(), 0.0, 1e-12);
    }
    EXPECT_EQ(steps, static_cast<int>(std::ceil(left_rad / kStep_rad))) << from_rad;
    EXPECT_NEAR(angle_between_rad(hand.X_PN().R().col(1), across_P), 0.0, 1e-6);
  }
  PointerNeedle hand = needle();
  EXPECT_TRUE(hand.turn_bevel(hand.X_PN().R().col(2), 0.1)) << "no direction across the needle";
}

TEST(PointerNeedle, TakesOverAPose) {
  PointerNeedle first = needle();
  first.tilt({1, 0, 0}, {0, 0, -1}, 0.3, -0.2);
  first.turn(0.7);
  first.push(50.0);
  PointerNeedle second = needle();
  second.put(first.X_PN());
  EXPECT_NEAR((second.X_PN().p() - first.X_PN().p()).norm(), 0.0, 1e-6);
  EXPECT_NEAR((second.X_PN().R() - first.X_PN().R()).norm(), 0.0, 1e-6);
  EXPECT_NEAR((second.entry_P() - first.entry_P()).norm(), 0.0, 0.2);
}

TEST(PointerNeedle, StaysFiniteAndInBoundsForAnyInput) {
  Random rng(7);
  PointerNeedle hand = needle();
  const double odd[] = {0.0, 1e9, -1e9, std::numeric_limits<double>::quiet_NaN(), 0.2, -3.0};
  for (int step = 0; step < 500; ++step) {
    const auto pick = [&] { return odd[static_cast<std::size_t>(rng.uniform(0.0, 5.999))]; };
    hand.glide({pick(), pick(), pick()});
    hand.tilt({1, 0, 0}, {0, 0, -1}, pick(), pick());
    hand.push(pick());
    hand.turn(pick());
    ASSERT_TRUE(hand.X_PN().is_finite());
    ASSERT_LE(angle_between_rad(hand.X_PN().R().col(2), anatomy::SkinNow(patient()).inward(hand.entry_P())),
              PointerNeedle::kFlattest_rad + 1e-6);
  }
}

/// Beam into the skin, lateral along the body's width.
PointerProbe probe() {
  Mat3 R_PT;
  R_PT.col(1) = path().direction();
  R_PT.col(0) = (Vec3::UnitX() - R_PT.col(1).x() * R_PT.col(1)).normalized();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  return {patient(), {R_PT, path().a}};
}

TEST(PointerProbe, ApproachesAPoseOnTheSkin) {
  constexpr double kStep_mm = 2.0, kStep_rad = 0.05;
  const Pose X_PT_goal = probe().X_PT();
  PointerProbe hand = probe();
  hand.push(-10.0);
  for (int step = 0; step < 25; ++step) hand.glide({1.0, 0.0, 0.5});
  hand.turn(1.0);
  int steps = 0;
  for (bool is_there = false; !is_there && steps < 200; ++steps) {
    const Vec3 before_P = hand.X_PT().p();
    is_there = hand.approach(X_PT_goal, kStep_mm, kStep_rad);
    EXPECT_LE((hand.X_PT().p() - before_P).norm(), 2.2 * kStep_mm) << "along the skin and onto it";
    EXPECT_LE(hand.pressed_mm(), PointerProbe::kDeepest_mm);
  }
  EXPECT_LT(steps, 100);
  EXPECT_NEAR((hand.X_PT().p() - X_PT_goal.p()).norm(), 0.0, 1e-6);
  EXPECT_NEAR((hand.X_PT().R() - X_PT_goal.R()).norm(), 0.0, 1e-6);
}

TEST(PointerProbe, StaysOnTheSkinAndFacesInward) {
  const Segment line = path();
  Mat3 R_PT;
  R_PT.col(1) = line.direction();
  R_PT.col(0) = Vec3(0, 0, 1).cross(line.direction()).normalized();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  PointerProbe hand(patient(), {R_PT, line.a});
  for (int step = 0; step < 20; ++step) hand.glide({2.0, 1.0, 1.0});
  hand.push(3.0);
  EXPECT_NEAR(hand.pressed_mm(), 3.0, 0.2);
  EXPECT_NEAR(volume::sample_linear(patient().skin_distance_mm, hand.X_PT().p()), -3.0, 0.5);
  EXPECT_GT(hand.X_PT().R().col(1).dot(anatomy::SkinNow(patient()).inward(hand.X_PT().p())), 0.98);
  EXPECT_NEAR(hand.X_PT().R().determinant(), 1.0, 1e-9);
}

TEST(PointerProbe, TurnsAboutItsBeamAndLimitsPressDepth) {
  const Segment line = path();
  PointerProbe hand(patient(), needle_pose(line.a, line.direction()));
  const Vec3 beam_P = hand.X_PT().R().col(1);
  hand.turn(0.5);
  EXPECT_NEAR((hand.X_PT().R().col(1) - beam_P).norm(), 0.0, 1e-12);
  hand.push(100.0);
  EXPECT_DOUBLE_EQ(hand.pressed_mm(), PointerProbe::kDeepest_mm);
}

TEST(PointerTools, MoveWithTheSkin) {
  const Segment path_A = path();
  const auto model = motion::testing::uniform_model({0.0, -6.0, 4.0});
  PointerNeedle needle(patient(), path_A, 150.0);
  PointerProbe probe(patient(), Pose(Eigen::AngleAxisd(0.2, Vec3::UnitY()).toRotationMatrix(), path_A.a));
  const Pose needle_rest = needle.X_PN(), probe_rest = probe.X_PT();
  const motion::PatientMotion motion(model.get(), {.drivers = {1.0}});
  needle.set_motion(motion);
  probe.set_motion(motion);
  EXPECT_LT((needle.X_PN().p() - needle_rest.p() - Vec3(0.0, -6.0, 4.0)).norm(), 1e-6);
  EXPECT_LT((probe.X_PT().p() - probe_rest.p() - Vec3(0.0, -6.0, 4.0)).norm(), 1e-6);
  needle.aim_at(path_A);
  EXPECT_LT((needle.entry_P() - motion.to_now(path_A.a)).norm(), 1e-9);
  needle.set_motion({});
  EXPECT_LT((needle.entry_P() - path_A.a).norm(), 1e-6);
}

}  // namespace
}  // namespace trocar::attempt
