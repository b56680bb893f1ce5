#include "haptics/proxy/body_proxies.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "haptics/insertion/insertion_law.h"
#include "haptics/test/layered_patient.h"
#include "stylus/virtual_stylus.h"

namespace trocar::testing {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

haptics::NeedleGeometry needle_22g() {
  haptics::NeedleGeometry needle;
  needle.radius_mm = 0.359;
  return needle;
}

anatomy::TissueTable tissues() {
  anatomy::TissueTable table = paper_tissues();
  for (anatomy::TissueParams& tissue : table.tissues) tissue.young_kpa = 30.0;
  table.tissues[5].young_kpa = 1e6;  // bone
  table.transfer.knot_count = 2;
  table.transfer.hu = {-200.0, 200.0};
  anatomy::HuLaw& soft = table.transfer.laws[0];
  soft.young_kpa = 30.0;
  soft.shaft_n_per_mm = 0.002;
  soft.shaft_viscosity_ns_per_mm = 0.01;
  anatomy::HuLaw& dense = table.transfer.laws[1] = soft;
  dense.shaft_n_per_mm = 0.010;
  dense.shaft_viscosity_ns_per_mm = 0.03;
  return table;
}

struct World {
  std::shared_ptr<const haptics::HapticScene> scene;
  haptics::Channel channel;
};

World make_world(const std::vector<Slab>& slabs, bool has_bending = true,
                 const haptics::NeedleGeometry& needle = needle_22g()) {
  haptics::HapticOptions options;
  options.force_model = haptics::ForceModel::kProxy;
  options.has_bending = has_bending;
  World world;
  world.scene = *make_haptic_scene(layered_patient(slabs), tissues(), needle, {}, options);
  world.channel.is_used = true;
  for (int i = 0; i < 20; ++i) haptics::look_ahead(world.channel, *world.scene, 0.0, 100.0);
  return world;
}

/// A needle whose grip is moved and turned from where the straight insertion to `tip_mm` has it.
Pose displaced(const World& world, double tip_mm, const Vec3& shift, const Vec3& turn) {
  const double length_mm = world.scene->needle.length_mm;
  const double angle = turn.norm();
  const Mat3 R = angle > 0.0 ? Mat3(Eigen::AngleAxisd(angle, turn / angle)) : Mat3(Mat3::Identity());
  return {R, Vec3(0.0, 0.0, tip_mm - length_mm) + shift + R * Vec3(0.0, 0.0, length_mm)};
}

Vector6 wrench_at(const World& world, double tip_mm, const Vector6& move, const Vec3& tip_force = Vec3::Zero()) {
  const Pose X_PN = displaced(world, tip_mm, move.head<3>(), move.tail<3>());
  const haptics::HeldShaft shaft = haptics::hold_shaft(world.channel, *world.scene, X_PN, tip_mm, true);
  const Wrench wrench = haptics::react(shaft, *world.scene, tip_force).wrench_P;
  return (Vector6() << wrench.force_n, wrench.torque_nmm).finished();
}

/// Stiffness that the hand meets at the grip, by central differences.
Matrix6 grip_stiffness(const World& world, double tip_mm) {
  Matrix6 stiffness;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = (i < 3 ? 1e-3 : 1e-5) * Vector6::Unit(i);
    stiffness.col(i) = (wrench_at(world, tip_mm, -step) - wrench_at(world, tip_mm, step)) / (2.0 * step.norm());
  }
  return stiffness;
}

TEST(ShaftResistance, SumsOverTissues) {
  const World world = make_world({{0, kFat}, {12, kMuscle}, {24, kLiver}});
  const haptics::ShaftResistance resistance = haptics::shaft_resistance(world.channel, *world.scene, 50.0);
  const double skin = 2.0, fat = 10.0, muscle = 12.0, liver = 26.0;
  const double voxel_mm = 0.5;  // Labels begin at the border of their nearest voxel; cells of 2 mm then round to it.
  // Fat of -100 and muscle of 50 HU have no wall: what the HU say, although they are labelled.
  const auto dry_of_hu = [](double hu) { return 0.002 + 0.008 * (hu + 200.0) / 400.0; };
  const auto viscosity_of_hu = [](double hu) { return 0.01 + 0.02 * (hu + 200.0) / 400.0; };
  const double dry = 0.004 * skin + dry_of_hu(-100.0) * fat + dry_of_hu(50.0) * muscle + 0.004 * liver;
  EXPECT_NEAR(resistance.dry_n, dry, 0.003 * 2.0 * voxel_mm);
  const double r = world.scene->needle.radius_mm;
  const double viscous =
      0.02 * haptics::contact_area_cm2(r, skin) + viscosity_of_hu(-100.0) * haptics::contact_area_cm2(r, fat) +
      viscosity_of_hu(50.0) * haptics::contact_area_cm2(r, muscle) + 0.02 * haptics::contact_area_cm2(r, liver);
  EXPECT_NEAR(resistance.viscous_ns_per_mm, viscous, 0.02 * haptics::contact_area_cm2(r, 2.0 * voxel_mm) + 1e-12);
}

TEST(ShaftResistance, IgnoresLabelsOfTissueWithoutAWall) {
  for (const haptics::ForceModel model : {haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    const std::vector<Slab> slabs{{0, kFat}, {12, kMuscle}, {24, kFat}, {40, kMuscle}};
    double dry_n[2], viscous_ns_per_mm[2];
    for (const bool is_labelled : {false, true}) {
      const auto scene = is_labelled ? testing::make_scene(slabs, model, tissues())
                                     : testing::make_unlabelled_scene(slabs, model, tissues());
      haptics::Channel channel;
      channel.is_used = true;
      for (int i = 0; i < 20; ++i) haptics::look_ahead(channel, *scene, 0.0, 100.0);
      const haptics::ShaftResistance resistance = haptics::shaft_resistance(channel, *scene, 60.0);
      dry_n[is_labelled] = resistance.dry_n;
      viscous_ns_per_mm[is_labelled] = resistance.viscous_ns_per_mm;
    }
    EXPECT_GT(dry_n[0], 0.1);
    EXPECT_EQ(dry_n[0], dry_n[1]);
    EXPECT_EQ(viscous_ns_per_mm[0], viscous_ns_per_mm[1]);
  }
}

TEST(ShaftResistance, ReadsIntensitiesWhereNothingIsLabelled) {
  const World world = make_world({});  // HU 0: half-way between the two knots.
  const haptics::ShaftResistance resistance = haptics::shaft_resistance(world.channel, *world.scene, 42.0);
  EXPECT_NEAR(resistance.dry_n, 0.004 * 2.0 + 0.006 * 40.0, 1e-12);
  const double r = world.scene->needle.radius_mm;
  EXPECT_NEAR(resistance.viscous_ns_per_mm,
              0.02 * haptics::contact_area_cm2(r, 2.0) + 0.02 * haptics::contact_area_cm2(r, 40.0), 1e-12);
}

TEST(ShaftResistance, HasNoStepsAsTheNeedleSlides) {
  const World world = make_world({{0, kFat}, {12, kMuscle}, {24, kLiver}});
  constexpr double kSlide_mm = 0.01;
  haptics::ShaftResistance before = haptics::shaft_resistance(world.channel, *world.scene, -1.0);
  EXPECT_EQ(before.dry_n, 0.0);
  for (double tip = -1.0; tip < 90.0; tip += kSlide_mm) {
    const haptics::ShaftResistance now = haptics::shaft_resistance(world.channel, *world.scene, tip);
    EXPECT_LE(std::abs(now.dry_n - before.dry_n),
              0.00721 * kSlide_mm + 1e-12);  // The stickiest tissue's a mm: 0.002 + 0.008 (60 + 200)/400.
    EXPECT_GE(now.dry_n, before.dry_n - 1e-12);
    before = now;
  }
}

TEST(HoldShaft, MatchesVesicsFoundation) {
  const World world = make_world({{0, kMuscle}});
  const double tip_mm = 60.0;
  const haptics::HeldShaft shaft =
      haptics::hold_shaft(world.channel, *world.scene, displaced(world, tip_mm, {1, 0, 0}, {0, 0, 0}), tip_mm, true);
  const double young = 0.030, d = 0.718, ei = bending_stiffness_n_mm2(world.scene->needle, true);
  const double k = 0.65 * young / 0.75 * std::pow(young * std::pow(d, 4.0) / ei, 1.0 / 12.0);
  double sum = 0.0;
  for (const double stiffness : shaft.bed.stiffness_n_per_mm) sum += stiffness;
  EXPECT_NEAR(sum, k * tip_mm, 0.6 * k);  // the first millimetre begins at zero
  EXPECT_NEAR(shaft.bed.stiffness_n_per_mm[16], 0.5 * k * 150.0 / 17.0, 1e-9);
  EXPECT_NEAR(shaft.bed.stiffness_n_per_mm[15], k * 150.0 / 17.0, 1e-9);
  EXPECT_EQ(shaft.bed.stiffness_n_per_mm[8], 0.0);  // Its piece ends before the skin.
  EXPECT_NEAR((shaft.bed.offset_mm[16] - Vec3(-1, 0, 0)).norm(), 0.0, 1e-12);
}

TEST(HoldShaft, LimitsStiffnessInBoneToTheDevice) {
  for (const bool has_bending : {false, true}) {
    haptics::NeedleGeometry needle;
    needle.radius_mm = 2.5;
    const World world = make_world({{0, kBone}}, has_bending, needle);
    for (const double tip_mm : {3.0, 30.0, 99.0}) {
      const haptics::HeldShaft shaft = haptics::hold_shaft(
          world.channel, *world.scene, displaced(world, tip_mm, {1, 0, 0}, {0, 0, 0}), tip_mm, true);
      double sum = 0.0;
      for (const double k : shaft.bed.stiffness_n_per_mm) {
        EXPECT_LE(k, world.scene->options.coupling.stiffness_n_per_mm + 1e-12);
        sum += k;
      }
      EXPECT_GT(sum, 0.01);
      EXPECT_LE(sum, 0.5 * world.scene->device.max_stiffness_n_per_mm + 1e-12);
      const Matrix6 stiffness = grip_stiffness(world, tip_mm);
      EXPECT_LE(stiffness(0, 0), sum + 1e-9);
      EXPECT_LE(stiffness(3, 3), haptics::kMostTurning_nmm_per_rad * (1.0 + 1e-6));
    }
  }
}

TEST(HoldShaft, IsAPassiveSpringForTheHand) {
  // Symmetric and positive semidefinite at the grip: no closed way of the hand gains energy.
  const std::vector<std::vector<Slab>> patients = {
      {{0, kMuscle}}, {{0, kFat}, {20, kBone}}, {{0, kFat}, {9, kLiver}}, {}};
  for (const bool has_bending : {false, true}) {
    for (const auto& slabs : patients) {
      const World world = make_world(slabs, has_bending);
      for (double tip_mm = 1.0; tip_mm < 100.0; tip_mm += 7.3) {
        const Matrix6 stiffness = grip_stiffness(world, tip_mm);
        const double size = stiffness.norm();
        constexpr double kDifferences = 1e-6;  // Of the central differences, relative.
        EXPECT_LE((stiffness - stiffness.transpose()).norm(), kDifferences * size);
        const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(0.5 * (stiffness + stiffness.transpose()));
        EXPECT_GE(eigen.eigenvalues().minCoeff(), -kDifferences * size);
        EXPECT_NEAR(stiffness.row(2).norm(), 0.0, kDifferences * size);  // The shaft slides
        EXPECT_NEAR(stiffness.row(5).norm(), 0.0, kDifferences * size);  // and rolls freely.
      }
    }
  }
}

TEST(HoldShaft, DoesAlmostNoWorkAroundACircle) {
  // Forces are kept across the shaft and about the straight one: exact for small turns, here 3 mm and 0.05 rad.
  constexpr int kSteps = 500;
  for (const bool has_bending : {false, true}) {
    const World world = make_world({{0, kMuscle}}, has_bending);
    for (const double sense : {-1.0, 1.0}) {
      const auto place = [&](double t) {
        const double turn = 0.05 * std::sin(sense * t + 0.5);
        return (Vector6() << 3.0 * std::cos(t), 2.0 * std::sin(sense * t), 0.0, 0.0, turn, 0.0).finished();
      };
      double gained = 0.0, exchanged = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        const double t = 2.0 * std::numbers::pi * i / kSteps, dt = 2.0 * std::numbers::pi / kSteps;
        const double work = wrench_at(world, 60.0, place(t + 0.5 * dt)).dot(place(t + dt) - place(t));
        gained += work;
        exchanged += 0.5 * std::abs(work);
      }
      EXPECT_LT(std::abs(gained), 0.01 * exchanged);
    }
  }
}

TEST(HoldShaft, IsStableOnABareStylusWithOneTickDelay) {
  // 45 g and 50 kg mm^2 without a hand, the wrench of one tick acts during the next but one, the pose is taken a
  // damping time (4 ms) ahead. Without the limit on turning a straight 18 G shaft would ring: 100 mm of muscle are 10 N
  // m/rad.
  for (const bool has_bending : {false, true}) {
    for (const auto& slabs : {std::vector<Slab>{{0, kMuscle}}, std::vector<Slab>{{0, kFat}, {20, kBone}}}) {
      const World world = make_world(slabs, has_bending, {});
      for (const double tip_mm : {5.0, 45.0, 99.0}) {
        constexpr double kDt_s = 0.001, kAhead_s = 0.004;
        const stylus::VirtualStylusParams stylus{0.045, 50.0, 0.0, 0.0};
        stylus::VirtualStylusState state;
        state.X_PS = displaced(world, tip_mm, {1, 0.5, 0}, {0.02, -0.01, 0}) * world.scene->X_SN.inverse();
        Wrench told, acting;
        double early = 0.0, late = 0.0;
        for (int i = 0; i < 2000; ++i) {
          const Vec3 axis = state.X_PS.R().col(2);
          const Vec3 ahead = (axis + kAhead_s * state.w_P.cross(axis)).normalized();
          const Pose X_PS(rotation_between(axis, ahead) * state.X_PS.R(), state.X_PS.p() + kAhead_s * state.v_P);
          acting = told;
          told =
              haptics::react(haptics::hold_shaft(world.channel, *world.scene, X_PS * world.scene->X_SN, tip_mm, true),
                             *world.scene, Vec3::Zero())
                  .wrench_P;
          stylus::step_stylus(state, stylus, {}, acting, Vec3::UnitY(), kDt_s);
          const double motion = state.v_P.norm() + 100.0 * state.w_P.norm();
          if (i < 500) early = std::max(early, motion);
          if (i >= 1500) late = std::max(late, motion);
        }
        EXPECT_LT(late, 0.7 * early) << has_bending << " " << tip_mm;
      }
    }
  }
}

TEST(HoldShaft, ForceGrowsWithDisplacement) {
  for (const bool has_bending : {false, true}) {
    const World world = make_world({{0, kMuscle}}, has_bending);
    double before = 0.0;
    for (double shift = 0.5; shift < 200.0; shift += 0.5) {
      const double force = -wrench_at(world, 60.0, shift * Vector6::Unit(0))(0);
      EXPECT_GE(force, before - 1e-12);
      before = force;
    }
    EXPECT_GT(before, 0.0);
  }
}

TEST(HoldShaft, HasNoStepsAsTheNeedleSlides) {
  const World world = make_world({{0, kFat}, {30, kBone}});
  const Vector6 move = (Vector6() << 2.0, -1.0, 0.0, 0.02, 0.03, 0.0).finished();
  constexpr double kSlide_mm = 0.01;
  Vector6 before = wrench_at(world, 0.0, move);
  EXPECT_EQ(before.norm(), 0.0);
  for (double tip_mm = 0.0; tip_mm < 60.0; tip_mm += kSlide_mm) {
    const Vector6 now = wrench_at(world, tip_mm, move);
    EXPECT_LT((now - before).head<3>().norm(), 0.05 * kSlide_mm / 0.01) << tip_mm;
    before = now;
  }
}

TEST(React, MatchesTheTorqueOfEquationSix) {
  const World world = make_world({{0, kMuscle}});
  const Pose X_PN = displaced(world, 70.0, {2, -1, 0}, {0.03, 0.05, 0.4});
  const haptics::HeldShaft shaft = haptics::hold_shaft(world.channel, *world.scene, X_PN, 70.0, true);
  const Vec3 tip_force(0.3, -0.2, -2.0);
  const haptics::ShaftReaction reaction = haptics::react(shaft, *world.scene, tip_force);
  const Vec3 axis = X_PN.R().col(2);
  const Vec3 grip = X_PN * Vec3(0, 0, -150.0);
  const Vec3 tip_across = tip_force - axis * axis.dot(tip_force);
  Vec3 force = tip_across, torque = 150.0 * axis.cross(tip_across);
  for (int i = 0; i < 17; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Vec3 node = grip + axis * (150.0 * (i + 1) / 17.0);
    const Vec3 bent = shaft.beam.deflection_mm[n] + shaft.beam.per_tip_force_mm_n[n] * tip_across;
    const Vec3 support = shaft.bed.stiffness_n_per_mm[n] * (shaft.bed.offset_mm[n] - bent);
    const Vec3 line = world.channel.direction_P;
    const Vec3 across = support - line * line.dot(support);  // a motion along the channel does not stretch the tissue
    const Vec3 to_line = (world.channel.origin_P - node) - line * line.dot(world.channel.origin_P - node);
    force += across;
    torque += (node - grip).cross(across) + axis.dot(to_line) * axis.cross(support);
  }
  EXPECT_NEAR((reaction.wrench_P.force_n - force).norm(), 0.0, 1e-10);
  EXPECT_NEAR((reaction.wrench_P.torque_nmm - torque).norm(), 0.0, 1e-8);
  EXPECT_GT(torque.norm(), 1.0);
  EXPECT_NEAR(reaction.wrench_P.torque_nmm.dot(axis), 0.0, 1e-10);
}

TEST(React, ScalesTheWrenchByItsShareForAStiffBed) {
  // A shaft that turns the grip too stiffly gives a share of all its forces: bed and tip still balance.
  haptics::NeedleGeometry needle;
  needle.radius_mm = 1.0;
  const World world = make_world({{0, kFat}, {20, kBone}}, true, needle);
  const Pose X_PN = displaced(world, 99.0, {0, 0, 0}, {0, 0, 0});
  const haptics::HeldShaft shaft = haptics::hold_shaft(world.channel, *world.scene, X_PN, 99.0, true);
  EXPECT_LT(shaft.share, 0.5);
  haptics::HeldShaft whole = shaft;
  whole.share = 1.0;
  const Wrench all = haptics::react(whole, *world.scene, {1, 0, 0}).wrench_P;
  const Wrench told = haptics::react(shaft, *world.scene, {1, 0, 0}).wrench_P;
  EXPECT_NEAR((told.force_n - shaft.share * all.force_n).norm(), 0.0, 1e-12);
  EXPECT_NEAR((told.torque_nmm - shaft.share * all.torque_nmm).norm(), 0.0, 1e-10);
}

TEST(React, AppliesTheFullLeverToATipForceInAir) {
  const World world = make_world({{0, kMuscle}});
  const haptics::HeldShaft shaft =
      haptics::hold_shaft(world.channel, *world.scene, displaced(world, 0.0, {0, 0, 0}, {0, 0, 0}), 0.0, true);
  const haptics::ShaftReaction reaction = haptics::react(shaft, *world.scene, {0.1, 0.0, -1.0});
  EXPECT_NEAR((reaction.wrench_P.force_n - Vec3(0.1, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((reaction.wrench_P.torque_nmm - Vec3(0, 15.0, 0)).norm(), 0.0, 1e-10);
  ASSERT_EQ(reaction.bent.node_count, 17);
}

TEST(React, BendsASmallTipForceAsACantilever) {
  const World world = make_world({{0, kMuscle}});
  const haptics::HeldShaft shaft =
      haptics::hold_shaft(world.channel, *world.scene, displaced(world, 0.0, {0, 0, 0}, {0, 0, 0}), 0.0, true);
  const double force = 0.005;
  const haptics::ShaftReaction reaction = haptics::react(shaft, *world.scene, {force, 0.0, 0.0});
  const double closed = force * std::pow(150.0, 3.0) / (3.0 * bending_stiffness_n_mm2(world.scene->needle, true));
  EXPECT_NEAR(reaction.bent.deflection_mm[16].x(), closed, 1e-9 * closed);
}

TEST(React, IsIndependentOfRoll) {
  const World world = make_world({{0, kMuscle}});
  Vector6 move = (Vector6() << 1.0, 2.0, 0.0, 0.0, 0.0, 0.0).finished();
  const Vector6 still = wrench_at(world, 70.0, move);
  move(5) = 2.1;
  EXPECT_NEAR((wrench_at(world, 70.0, move) - still).norm(), 0.0, 1e-9);
}

TEST(React, ThinNeedlesBendWithTheTissueAndRigidOnesDoNot) {
  // Hub turned by 5 degrees, 40 mm in muscle: the thin shaft stays near its line, a straight one pushes harder.
  const double tip_mm = 40.0;
  const Vector6 turned = 5.0 / 180.0 * std::numbers::pi * Vector6::Unit(3);
  const World bending = make_world({{0, kMuscle}});
  const World straight = make_world({{0, kMuscle}}, false);
  EXPECT_LT(wrench_at(bending, tip_mm, turned).norm(), 0.3 * wrench_at(straight, tip_mm, turned).norm());
  const Pose X_PN = displaced(bending, tip_mm, {0, 0, 0}, turned.tail<3>());
  const auto reaction = haptics::react(haptics::hold_shaft(bending.channel, *bending.scene, X_PN, tip_mm, true),
                                       *bending.scene, {0, 0, 0});
  EXPECT_LT(std::abs(X_PN.p().y() + reaction.bent.deflection_mm[16].y()), 0.2 * std::abs(X_PN.p().y()));
}

TEST(Bevel, DeflectsAnAdvancingTipAwayFromItsFace) {
  haptics::NeedleGeometry needle;
  needle.bevel_share = 0.1;
  const Pose X_PN = needle_pose({1, 2, 3}, Vec3(0.2, 0.1, 1.0).normalized());
  const Vec3 force = haptics::bevel_force_P(needle, X_PN, 2.0);
  EXPECT_NEAR((force + 0.2 * X_PN.R().col(1)).norm(), 0.0, 1e-12);
  EXPECT_EQ(haptics::bevel_force_P(needle, X_PN, -2.0).norm(), 0.0);
  EXPECT_EQ(haptics::bevel_force_P(needle, X_PN, std::numeric_limits<double>::quiet_NaN()).norm(), 0.0);
}

TEST(BodyProxies, StayFiniteForAnyInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const World world = make_world({{0, kMuscle}});
  const haptics::Channel unknown;
  for (const double bad : {nan, infinity, -infinity, 0.0, 1e4, 1e12, 1e300, -1e300}) {
    for (const haptics::Channel* channel : {&world.channel, &unknown}) {
      const haptics::ShaftResistance resistance = haptics::shaft_resistance(*channel, *world.scene, bad);
      EXPECT_TRUE(std::isfinite(resistance.dry_n) && std::isfinite(resistance.viscous_ns_per_mm)) << bad;
      for (const Pose& X_PN : {Pose::translation({bad, 0, 0}), Pose(Mat3::Constant(bad), {0, 0, 0}), Pose()}) {
        for (const double tip_mm : {bad, 50.0}) {
          const haptics::HeldShaft shaft = haptics::hold_shaft(*channel, *world.scene, X_PN, tip_mm, false);
          for (const Vec3& force : {Vec3(bad, 0, bad), Vec3(0, 1, 0)}) {
            const haptics::ShaftReaction reaction = haptics::react(shaft, *world.scene, force);
            EXPECT_TRUE(reaction.wrench_P.force_n.allFinite() && reaction.wrench_P.torque_nmm.allFinite()) << bad;
            for (const Vec3& mm : reaction.bent.deflection_mm) EXPECT_TRUE(mm.allFinite() || bad != bad) << bad;
          }
        }
      }
    }
  }
}

TEST(BodyProxies, FlagAPoseFarOffTheLine) {
  const World world = make_world({{0, kMuscle}});
  for (const double x_mm : {1e4, std::nan(""), 1.0}) {
    const Pose X_PN = Pose::translation({x_mm, 0, 0});
    EXPECT_EQ(haptics::hold_shaft(world.channel, *world.scene, X_PN, 50.0, true).beam.is_bound, x_mm != 1.0);
  }
}

TEST(BodyProxies, NeverAllocate) {
  const World world = make_world({{0, kMuscle}});
  const Pose X_PN = displaced(world, 70.0, {2, 0, 0}, {0.03, 0.0, 0.0});
  const AllocationGuard guard;
  const haptics::ShaftResistance resistance = haptics::shaft_resistance(world.channel, *world.scene, 70.0);
  const haptics::HeldShaft shaft = haptics::hold_shaft(world.channel, *world.scene, X_PN, 70.0, true);
  const haptics::ShaftReaction reaction =
      haptics::react(shaft, *world.scene, haptics::bevel_force_P(world.scene->needle, X_PN, 1.0));
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(resistance.dry_n + reaction.wrench_P.force_n.norm(), 0.0);
}

}  // namespace
}  // namespace trocar::testing
