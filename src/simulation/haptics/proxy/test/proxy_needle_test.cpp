#include "haptics/proxy/proxy_needle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

constexpr std::uint8_t kSkinLayer = 0, kMuscleLayer = 1, kCapsuleLayer = 2;

double axial(const telemetry::TickSample& s) {
  return -s.f_tip_proxy_n.dot(s.axis);
}
double peak_between(const std::vector<telemetry::TickSample>& samples, double from_mm, double to_mm) {
  double peak = 0.0;
  for (const telemetry::TickSample& s : samples) {
    if (s.depth_mm >= from_mm && s.depth_mm < to_mm) peak = std::max(peak, axial(s));
  }
  return peak;
}

class ProxySpeeds : public ::testing::TestWithParam<std::pair<double, double>> {};
INSTANTIATE_TEST_SUITE_P(SpeedAndRate, ProxySpeeds,
                         ::testing::Values(std::pair{2.0, 1000.0}, std::pair{10.0, 1000.0}, std::pair{50.0, 1000.0},
                                           std::pair{10.0, 4000.0}));

TEST_P(ProxySpeeds, WallsBreakInOrderAtTheirPunctureForce) {
  const auto [speed, rate] = GetParam();
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kProxy), rate);
  const auto samples = driver.move(60.0, speed);
  EXPECT_EQ(punctures(samples), (std::vector<int>{kSkinLayer, kCapsuleLayer}));
  for (const telemetry::TickSample& s : samples) {
    for (const telemetry::TickEvent& event : s.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      EXPECT_NEAR(axial(s), event.id == kSkinLayer ? 2.8 : 1.5, 1e-9);
    }
  }
}

TEST(ProxyNeedle, EntersATissueAfterItsWallIsPierced) {
  using enum telemetry::EventKind;
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kProxy));
  EXPECT_EQ(
      ways_in(driver.move(60.0, 10.0)),
      (std::vector<std::pair<telemetry::EventKind, int>>{
          {kPuncture, kSkinLayer}, {kEnter, kFat}, {kEnter, kMuscle}, {kPuncture, kCapsuleLayer}, {kEnter, kLiver}}));
}

TEST(ProxyNeedle, DropsToTheResistanceInsideAfterAWall) {
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kProxy));
  const auto samples = driver.move(60.0, 5.0);
  EXPECT_NEAR(axial(samples.back()), 0.6 + 0.005 * 5.0, 0.01);  // cutting force of the liver + c v of its HU
}

TEST(ProxyNeedle, RendersMuscleFromTheGradientWithOrWithoutLabels) {
  Driver labelled(make_scene({{0, kFat}, {20, kMuscle}}, haptics::ForceModel::kProxy));
  Driver unlabelled(make_unlabelled_scene({{0, kFat}, {20, kMuscle}}, haptics::ForceModel::kProxy));
  const double with_labels = peak_between(labelled.move(50.0, 5.0), 15.0, 30.0);
  const double without = peak_between(unlabelled.move(50.0, 5.0), 15.0, 30.0);
  EXPECT_GT(with_labels, 1.0);
  EXPECT_LE(with_labels, 2.6);
  EXPECT_NEAR(with_labels, without, 0.1);
}

TEST(ProxyNeedle, ExitsMuscleWithoutAThreshold) {
  Driver driver(make_unlabelled_scene({{0, kMuscle}, {20, kFat}}, haptics::ForceModel::kProxy));
  EXPECT_LT(peak_between(driver.move(50.0, 5.0), 10.0, 40.0), 0.35);  // R0 + c v of muscle, and no T_N
}

TEST(ProxyNeedle, ReentersItsHoleWithoutAPuncture) {
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kProxy));
  driver.move(50.0, 10.0);
  EXPECT_TRUE(punctures(driver.move(20.0, 10.0)).empty());
  EXPECT_TRUE(punctures(driver.move(49.0, 10.0)).empty());  // the capsule again, in its hole
  driver.move(-10.0, 10.0);
  EXPECT_TRUE(punctures(driver.move(48.0, 10.0)).empty());  // skin and capsule again
  EXPECT_EQ(driver.state().needle.path.is_open, true);
}

TEST(ProxyNeedle, ItsOwnHoleHasNoBordersAndNoCutting) {
  Driver driver(make_unlabelled_scene({{0, kMuscle}, {15, kFat}, {30, kMuscle}}, haptics::ForceModel::kProxy));
  driver.move(45.0, 5.0);
  for (const telemetry::TickSample& s : driver.move(5.0, 5.0)) {  // out of fat into muscle, on the way back
    if (s.depth_mm < 43.0) {
      ASSERT_LT(std::abs(axial(s)), 0.03) << s.depth_mm;  // c v
    }
  }
  EXPECT_LT(peak_between(driver.move(44.0, 5.0), 6.0, 43.0), 0.03);
}

TEST(ProxyNeedle, BoneStopsTheNeedleWithOrWithoutItsLabel) {
  for (const auto& scene : {make_scene({{0, kFat}, {15, kBone}}, haptics::ForceModel::kProxy),
                            make_unlabelled_scene({{0, kFat}, {15, kBone}}, haptics::ForceModel::kProxy)}) {
    Driver driver(scene);
    const auto samples = driver.move(35.0, 10.0);
    const double proxy_depth = driver.state().needle.proxy.proxy_P.z();
    EXPECT_LT(proxy_depth, 15.5);
    EXPECT_GT(samples.back().device_f_n.norm(), 12.0);
  }
}

TEST(ProxyNeedle, StiffnessChangeCausesNoForceStep) {
  // Soft fat that needs force, then the stiffer wall of the liver: the force must rise from where it was.
  anatomy::TissueTable tissues = paper_tissues();
  tissues.tissues[2].cutting_n = 1.0;
  tissues.transfer.laws[1].stiffness_n_per_mm = 0.3;
  Driver driver(make_scene({{0, kFat}, {30, kLiver}}, haptics::ForceModel::kProxy, tissues));
  double before = 0.0;
  for (const telemetry::TickSample& s : driver.move(45.0, 10.0)) {
    if (s.depth_mm > 10.0 && s.events[0].kind != telemetry::EventKind::kPuncture) {
      ASSERT_LT(axial(s) - before, 0.03) << s.depth_mm;  // 10 mm/s on 1 N/mm is 0.01 N a tick
    }
    before = axial(s);
  }
}

TEST(ProxyNeedle, PiercesAWallSofterThanTheTissueBeforeIt) {
  anatomy::TissueTable tissues = paper_tissues();
  tissues.layers[2].delta_x_mm = 5.0;  // gives way some millimetres in, like the dura
  tissues.transfer.laws[1].stiffness_n_per_mm = 5.0;
  Driver driver(make_scene({{0, kFat}, {30, kLiver}}, haptics::ForceModel::kProxy, tissues));
  EXPECT_EQ(punctures(driver.move(45.0, 10.0)), (std::vector<int>{kSkinLayer, kCapsuleLayer}));
}

TEST(ProxyNeedle, SteadyForceIsTheSameAtAnyRate) {
  std::vector<double> forces;
  for (const double rate : {1000.0, 2000.0, 4000.0}) {
    Driver driver(make_unlabelled_scene({{0, kFat}}, haptics::ForceModel::kProxy), rate);
    forces.push_back(driver.move(60.0, 10.0).back().f_total_n.z());
  }
  EXPECT_NEAR(forces[0], forces[1], 2e-3);  // the shaft is a hundredth of a millimetre further in or out
  EXPECT_NEAR(forces[0], forces[2], 2e-3);
}

TEST(ProxyNeedle, SlidesOnClosedSkinWithFriction) {
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kProxy));
  driver.move(1.5, 5.0);  // presses with less than the puncture force
  telemetry::TickSample sample;
  for (int i = 1; i <= 200; ++i) sample = driver.to({0.05 * i, 0.0, 1.5});
  const Vec3 proxy = driver.state().needle.proxy.proxy_P;
  EXPECT_NEAR(proxy.z(), 0.0, 1e-6);
  EXPECT_GT(proxy.x(), 5.0);
  const double normal = -sample.f_tip_proxy_n.z();
  EXPECT_GT(normal, 0.5);
  EXPECT_NEAR(-sample.f_tip_proxy_n.x(), 2.0 * normal, 1e-6);  // a sharp tip grips
}

TEST(ProxyNeedle, ComposesTheTotalFromItsParts) {
  for (const haptics::ForceModel model : {haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    Driver driver(make_scene(liver_way(), model));
    for (int i = 0; i < 6000; ++i) {
      const telemetry::TickSample s =
          driver.to({0.3 * std::sin(0.01 * i), 0.0, -10.0 + 0.01 * i}, Vec3(0.05, 0, 1).normalized());
      const double along = s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n + s.f_body_axial_n;
      const Vec3 expected = s.axis * along + s.f_constraint_n + s.f_tip_proxy_n + s.f_weight_n;
      ASSERT_LT((s.f_total_n - expected).norm(), 1e-12);
    }
  }
}

TEST(Combined, CombinesPaperAWallsWithProxyBorders) {
  Driver driver(make_scene(liver_way(), haptics::ForceModel::kCombined));
  const auto samples = driver.move(60.0, 5.0);
  EXPECT_EQ(punctures(samples), (std::vector<int>{kSkinLayer, kCapsuleLayer}));
  EXPECT_GT(peak_between(samples, 10.0, 14.0), 1.0);  // muscle, from the gradient
  const telemetry::TickSample& last = samples.back();
  EXPECT_NEAR(last.f_cutting_n, -0.6, 1e-9);
  EXPECT_EQ(last.f_friction_n, 0.0);
  EXPECT_EQ(last.f_tip_proxy_n.norm(), 0.0);  // the liver is labelled: the tip is A's
  EXPECT_LT(last.f_body_axial_n, -0.1);
}

TEST(Combined, RendersUnlabelledTissueThroughTheTipProxy) {
  Driver driver(make_unlabelled_scene({{0, kFat}, {20, kMuscle}}, haptics::ForceModel::kCombined));
  const auto samples = driver.move(50.0, 5.0);
  EXPECT_EQ(punctures(samples), (std::vector<int>{kSkinLayer}));
  EXPECT_GT(peak_between(samples, 15.0, 30.0), 1.0);  // the border from the gradient
  EXPECT_NEAR(axial(samples.back()), 0.2, 1e-6);      // R0 of muscle
}

TEST(SafeStart, InsideTheBodyStartsInsertedWithoutForce) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    Driver driver(make_scene(liver_way(), model));
    const telemetry::TickSample first = driver.to({0, 0, 40.0});
    EXPECT_LT((first.device_f_n - first.f_weight_n).norm(), 1e-6) << to_string(model);
    EXPECT_EQ(first.events[0].kind, telemetry::EventKind::kLimit);
    EXPECT_EQ(first.events[0].id, static_cast<std::uint8_t>(telemetry::LimitReason::kResumedInside));
    EXPECT_NEAR(first.depth_mm, 40.0, 1e-6);
    EXPECT_EQ(first.phase, telemetry::InsertionPhase::kInserted);
    EXPECT_TRUE(punctures(driver.hold(0.1)).empty());
    driver.jump_to(41.0);
    EXPECT_LT(driver.hold(0.3).back().device_f_n.norm(), 3.0);
  }
}

TEST(SafeStart, DoesNotPierceBone) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    for (const double in_bone_mm : {0.3, 1.0, 3.0}) {
      Driver driver(make_scene({{0, kFat}, {30, kBone}}, model));
      driver.to({0.0, 0.0, 30.0 + in_bone_mm});
      const auto samples = driver.move(45.0, 20.0);
      EXPECT_TRUE(punctures(samples).empty());
      EXPECT_GT(-samples.back().f_total_n.z(), 5.0) << to_string(model) << ' ' << in_bone_mm;
      EXPECT_LT(samples.back().tip_mm.z(), 36.0) << to_string(model) << ' ' << in_bone_mm;
    }
  }
}

TEST(SafeStart, RestartsAfterAJumpWithoutAForceStep) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    Driver driver(make_scene(liver_way(), model));
    driver.move(15.0, 10.0);
    const telemetry::TickSample there = driver.to({10.0, 0, 60.0});
    EXPECT_LT((there.device_f_n - there.f_weight_n).norm(), 1e-6) << to_string(model);
    EXPECT_EQ(there.events[0].id, static_cast<std::uint8_t>(telemetry::LimitReason::kJumped));
    const telemetry::TickSample back = driver.to({10.0, 0, -30.0});
    EXPECT_LT((back.device_f_n - back.f_weight_n).norm(), 1e-6);
    EXPECT_EQ(back.phase, telemetry::InsertionPhase::kOutside);
  }
}

class Models : public ::testing::TestWithParam<haptics::ForceModel> {};
INSTANTIATE_TEST_SUITE_P(All, Models,
                         ::testing::Values(haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy,
                                           haptics::ForceModel::kCombined),
                         [](const auto& the) { return std::string(to_string(the.param)); });

TEST_P(Models, StayFiniteAndNeverAllocateForAnyInput) {
  const auto scene = make_scene({{0, kFat}, {12, kMuscle}, {24, kLiver}, {60, kBone}}, GetParam());
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Random random(7);
  haptics::HapticState state;
  int flagged = 0;
  std::size_t allocations = 0;
  Vec3 tip(0, 0, -5);
  for (int i = 0; i < 20000; ++i) {
    haptics::HapticInput input;
    tip += Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.4, 0.5));
    if (tip.z() > 90.0) tip = {0, 0, -5};
    Vec3 here = tip;
    switch (random.next() % 40) {
      case 0:
        here.x() = kNan;
        break;
      case 1:
        here.y() = kInfinity;
        break;
      case 2:
        here.z() = 10000.0;
        break;
      case 3:
        input.dt_s = random.next() % 2 == 0 ? 0.0 : 5.0;
        break;
      case 4:
        here += Vec3(30, -20, 40);
        break;
      default:
        break;
    }
    const Vec3 axis = Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1.0).normalized();
    input.tool = telemetry::to_tool_pose(needle_pose(here, axis));
    const AllocationGuard guard;
    const haptics::HapticOutput output = haptics::tick(state, input, *scene);
    allocations += guard.count();
    ASSERT_TRUE(output.total_W.force_n.allFinite() && output.total_W.torque_nmm.allFinite());
    ASSERT_TRUE(output.sample.tip_mm.allFinite() && output.sample.f_total_n.allFinite());
    ASSERT_LE(output.total_W.force_n.norm(), 37.5 + 1e-9);
    flagged += output.sample.limited ? 1 : 0;
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(flagged, 500);
}

TEST(ProxyScene, RefusesAMissingCtTransferOrLabels) {
  haptics::HapticOptions options;
  options.force_model = haptics::ForceModel::kProxy;
  auto no_ct = layered_patient(liver_way());
  no_ct->ct = {};
  const auto without_ct = haptics::make_haptic_scene(no_ct, paper_tissues(), {}, {}, options);
  ASSERT_FALSE(without_ct);
  EXPECT_NE(without_ct.error().text().find("CT"), std::string::npos);
  anatomy::TissueTable no_transfer = paper_tissues();
  no_transfer.transfer = {};
  EXPECT_FALSE(haptics::make_haptic_scene(layered_patient(liver_way()), no_transfer, {}, {}, options));
  auto no_labels = layered_patient(liver_way());
  no_labels->labels = {};
  EXPECT_TRUE(haptics::make_haptic_scene(no_labels, paper_tissues(), {}, {}, options));
  options.force_model = haptics::ForceModel::kInsertion;
  EXPECT_FALSE(haptics::make_haptic_scene(no_labels, paper_tissues(), {}, {}, options));
}

}  // namespace
}  // namespace trocar::testing
