#include "haptics/tick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "core/testing/allocation_guard.inc.h"
#include "haptics/test/layered_patient.h"
#include "haptics/test/tick_period.h"
#include "stylus/virtual_stylus.h"

namespace trocar::testing {
namespace {

TEST(Tick, NeverAllocates) {
  Driver driver(make_scene(liver_way()));
  const auto scene = make_scene(liver_way());
  haptics::HapticState state;
  haptics::HapticInput input;
  std::size_t events = 0;
  for (int i = 0; i < 12000; ++i) {
    const double z = i < 8000 ? -10.0 + 0.01 * i : 70.0 - 0.02 * (i - 8000);
    input.tool = telemetry::to_tool_pose(needle_pose({0, 0, z}, Vec3::UnitZ()));
    const AllocationGuard guard;
    haptics::tick(state, input, *scene);
    events += guard.count();
  }
  EXPECT_EQ(events, 0u);
  EXPECT_EQ(state.needle.path.memory.channels[0].is_used, true);
}

TEST(AllocationGuard, CountsAnAllocation) {
  const AllocationGuard guard;
  auto owned = std::make_unique<int>(3);
  EXPECT_GT(guard.count(), 0u);
}

/// In 20 mm deep, aside there, on to 45 mm and out again: every term of the model acts at some tick.
std::vector<telemetry::TickSample> in_aside_and_out(haptics::ForceModel model) {
  Driver driver(make_scene(liver_way(), model));
  std::vector<telemetry::TickSample> samples = driver.move(20.0, 10.0);
  for (int i = 1; i <= 200; ++i) samples.push_back(driver.to({0.01 * i, 0.0, 20.0}));
  for (int i = 1; i <= 2500; ++i) samples.push_back(driver.to({2.0, 0.0, 20.0 + 0.01 * i}));
  for (int i = 1; i <= 5000; ++i) samples.push_back(driver.to({2.0, 0.0, 45.0 - 0.01 * i}));
  return samples;
}

TEST(Tick, ComposesTheTotalFromAllItsParts) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    double most_axial_n = 0.0;
    double most_proxy_n = 0.0;
    double most_constraint_n = 0.0;
    for (const telemetry::TickSample& s : in_aside_and_out(model)) {
      const double axial_n = s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n + s.f_body_axial_n;
      const Vec3 expected = s.axis * axial_n + s.f_constraint_n + s.f_tip_proxy_n + s.f_weight_n;
      ASSERT_LT((s.f_total_n - expected).norm(), 1e-12);
      ASSERT_LT((s.device_f_n - s.f_total_n - s.axis * s.f_stick_n).norm(), 1e-12);
      most_axial_n = std::max(most_axial_n, std::abs(axial_n));
      most_proxy_n = std::max(most_proxy_n, s.f_tip_proxy_n.norm());
      most_constraint_n = std::max(most_constraint_n, s.f_constraint_n.norm());
    }
    EXPECT_GT(most_axial_n, 0.1) << to_string(model);
    EXPECT_GT(most_constraint_n, 0.01) << to_string(model);
    EXPECT_EQ(most_proxy_n > 0.1, model != haptics::ForceModel::kInsertion) << to_string(model);
  }
}

/// Nothing touches a needle in the air: the stylus' weight is all there is, also on a device without torque.
TEST(Tick, SeparatesWeightFromTissueForce) {
  for (const double peak_torque_nmm : {515.0, 0.0}) {
    stylus::DeviceCapability device;
    device.peak_torque_nmm = peak_torque_nmm;
    const auto scene = haptics::make_haptic_scene(layered_patient(liver_way()), paper_tissues(), {}, device, {});
    ASSERT_TRUE(scene) << scene.error().text();
    haptics::HapticState state;
    haptics::HapticInput input;
    input.tool = telemetry::to_tool_pose(needle_pose({0, 0, -10.0}, Vec3(0.3, 0.2, 1.0).normalized()));
    const haptics::HapticOutput output = haptics::tick(state, input, **scene);
    EXPECT_EQ(output.tissue_W.force_n, Vec3::Zero());
    EXPECT_EQ(output.tissue_W.torque_nmm, Vec3::Zero());
    EXPECT_NEAR(output.weight_W.force_n.norm(), device.stylus_weight_n, 1e-12);
    EXPECT_GT(output.sample.tau_nmm.norm(), 1.0) << "its lever";
  }
}

/// A tip that stops on the skin to within rounding has met it when it goes on.
TEST(Tick, TouchesTheSkinAfterStoppingOnIt) {
  for (const haptics::ForceModel model :
       {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
    for (const double stop_mm : {-1e-9, 0.0, 1e-14, 3e-14, 1e-13, 1e-12, 1e-9}) {
      Driver driver(make_scene(liver_way(), model));
      driver.move(-0.02, 20.0);
      driver.to({0.0, 0.0, stop_mm});
      for (double z = 0.02; z < 2.0; z += 0.02) {
        const telemetry::TickSample sample = driver.to({0.0, 0.0, z});
        ASSERT_EQ(sample.events[0].kind, telemetry::EventKind::kNone) << to_string(model) << " from " << stop_mm;
        if (z > 0.5) {
          ASSERT_EQ(sample.phase, telemetry::InsertionPhase::kLoading) << to_string(model) << " from " << stop_mm;
        }
      }
    }
  }
}

TEST(Tick, SendsTheCouplingForceToTheDevice) {
  // physics.md V1: along the path the device is pushed back by k_c (s_D - s) + b_c (v_D - v), which balances all
  // resistances. Here from the recorded places alone, without the recorded terms.
  const stylus::CouplingParams coupling;
  Driver driver(make_scene(liver_way()));
  const std::vector<telemetry::TickSample> samples = driver.move(50.0, 10.0);
  int checked = 0;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    const auto has_event = [](const telemetry::TickSample& s) {
      return s.events[0].kind == telemetry::EventKind::kPuncture;
    };
    if (has_event(samples[i]) || has_event(samples[i - 1])) continue;  // these ticks are shorter and longer
    const auto way = [&](const Vec3 telemetry::TickSample::*place) {
      return std::pair((samples[i].*place).z(), ((samples[i].*place) - (samples[i - 1].*place)).z() / kDt_s);
    };
    const auto [s_device, v_device] = way(&telemetry::TickSample::device_mm);
    const auto [s_needle, v_needle] = way(&telemetry::TickSample::tip_mm);
    const double coupling_n =
        coupling.stiffness_n_per_mm * (s_device - s_needle) + coupling.damping_ns_per_mm * (v_device - v_needle);
    ASSERT_NEAR((samples[i].device_f_n - samples[i].f_weight_n).z(), -coupling_n, 1e-6) << samples[i].depth_mm;
    checked += coupling_n > 0.1 ? 1 : 0;
  }
  EXPECT_GT(checked, 1000);
}

TEST(Tick, CompensatesTheWeightUpwards) {
  Driver driver(make_scene(liver_way()));
  const telemetry::TickSample sample = driver.to({0, 0, -10});
  EXPECT_LT((sample.f_weight_n - Vec3(0, -0.5, 0)).norm(), 1e-12);  // supine: up is -y
  haptics::HapticOptions off;
  off.has_weight_compensation = false;
  EXPECT_EQ(Driver(make_scene(liver_way(), off)).to({0, 0, -10}).f_total_n.norm(), 0.0);
}

TEST(Tick, ClampsToTheDeviceAndFlagsIt) {
  Driver driver(make_scene({{0, kFat}, {10, kBone}}));
  const telemetry::TickSample sample = driver.move(80.0, 50.0).back();
  EXPECT_NEAR(sample.device_f_n.norm(), 37.5, 1e-9);
  EXPECT_TRUE(sample.limited);
}

TEST(Tick, StaysFiniteForAnyInput) {
  const auto scene = make_scene(liver_way());
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Random random(3);
  haptics::HapticState state;
  int rejected = 0;
  for (int i = 0; i < 20000; ++i) {
    Vec3 tip(random.uniform(-15, 15), random.uniform(-15, 15), random.uniform(-15, 90));
    haptics::HapticInput input;
    input.dt_s = 0.001;
    switch (random.next() % 12) {
      case 0:
        tip.x() = kNan;
        break;
      case 1:
        tip.z() = kInfinity;
        break;
      case 2:
        tip *= 1e200;
        break;
      case 3:
        input.dt_s = random.next() % 2 == 0 ? 0.0 : kNan;
        break;
      case 4:
        input.dt_s = 1e9;
        break;
      case 5:
        tip *= 100.0;
        break;
      default:
        break;
    }
    input.tool = telemetry::to_tool_pose(needle_pose(tip, Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 1.0)));
    const haptics::HapticOutput output = haptics::tick(state, input, *scene);
    ASSERT_TRUE(output.total_W.force_n.allFinite() && output.total_W.torque_nmm.allFinite());
    ASSERT_TRUE(output.sample.tip_mm.allFinite() && output.sample.f_total_n.allFinite());
    ASSERT_LE(output.total_W.force_n.norm(), 37.5 + 1e-9);
    rejected += output.sample.events[0].kind == telemetry::EventKind::kLimit ? 1 : 0;
  }
  EXPECT_GT(rejected, 4000);
}

/// Of the bound and beyond it, in every force model and with every tool, moving and at rest.
TEST(Tick, GivesNoForceForAnAbsurdlySmallPeriod) {
  constexpr std::array kAbsurd_s{std::numeric_limits<double>::denorm_min(),
                                 std::numeric_limits<double>::min(),
                                 1e-300,
                                 1e-100,
                                 1e-30,
                                 1e-12,
                                 0.999e-6};
  const auto is_rejected = [](const haptics::HapticOutput& output) {
    const telemetry::TickEvent& event = output.sample.events[0];
    return event.kind == telemetry::EventKind::kLimit &&
           event.id == static_cast<int>(telemetry::LimitReason::kInputRejected);
  };
  for (const haptics::Tool tool : {haptics::Tool::kNeedle, haptics::Tool::kTransducer, haptics::Tool::kFinger}) {
    for (const auto model :
         {haptics::ForceModel::kInsertion, haptics::ForceModel::kProxy, haptics::ForceModel::kCombined}) {
      haptics::HapticOptions options;
      options.tool = tool;
      options.force_model = model;
      const auto scene = make_scene(liver_way(), options);
      haptics::HapticState state;
      const auto step = [&](double dt_s, double depth_mm) {
        haptics::HapticInput input;
        input.dt_s = dt_s;
        input.tool = telemetry::to_tool_pose(needle_pose({0.0, 0.0, depth_mm}, Vec3::UnitZ()));
        return haptics::tick(state, input, *scene);
      };
      for (int i = 0; i < 200; ++i) step(0.001, -1.0 + 0.02 * i);
      for (const double dt_s : kAbsurd_s) {
        const haptics::HapticOutput output = step(dt_s, 3.01);
        EXPECT_EQ(output.total_W.force_n.norm(), 0.0) << dt_s;
        EXPECT_EQ(output.total_W.torque_nmm.norm(), 0.0) << dt_s;
        EXPECT_TRUE(is_rejected(output)) << dt_s;
      }
      for (const double dt_s : {haptics::kMinDt_s, 1e-5, 1e-4}) {
        const haptics::HapticOutput output = step(dt_s, 3.01);
        EXPECT_TRUE(output.total_W.force_n.allFinite() && output.sample.f_total_n.allFinite()) << dt_s;
        EXPECT_FALSE(is_rejected(output)) << dt_s;
      }
    }
  }
}

TEST(Tick, ReplaysBitwise) {
  const auto scene = make_scene(liver_way());
  const auto run = [&] {
    haptics::HapticState state;
    double sum = 0.0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 tip(0.1 * std::sin(0.01 * i), 0.0, -10.0 + 0.012 * i);
      sum += haptics::tick(state, {0.001 * i, 0.001, telemetry::to_tool_pose(needle_pose(tip, Vec3::UnitZ()))}, *scene)
                 .total_W.force_n.z();
    }
    return sum;
  };
  EXPECT_EQ(run(), run());
}

/// A device whose position is quantised, in closed loop with the tick, its force one tick late; held by a hand.
class ClosedLoop : public ::testing::TestWithParam<double> {};

TEST_P(ClosedLoop, ComesToRestInEveryTissue) {
  constexpr double kCount_mm = 0.03;  // one encoder count of a 860 dpi device
  for (const double depth : {0.0, 1.0, 8.0, 11.9, 13.0, 23.9, 24.5, 50.0}) {
    const auto scene = make_scene(liver_way());
    haptics::HapticState state;
    stylus::VirtualDeviceState device{needle_pose({0, 0, -5}, Vec3::UnitZ()), Vec3::Zero()};
    stylus::HandHold hand{Vec3::Zero(), Vec3::Zero(), 0.5, 0.005, 0.05};
    Vec3 force_P = Vec3::Zero();
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < 6000; ++i) {
      hand.anchor_P.z() = -5.0 + (depth + 5.0) * std::min(1.0, i / 2000.0);
      stylus::step_device(device, {GetParam(), 0.5}, hand, force_P, scene->gravity_P, 0.001);
      const Vec3 tip = (device.X_PN.p() / kCount_mm).array().round() * kCount_mm;
      force_P = haptics::tick(state, {0.001 * i, 0.001, telemetry::to_tool_pose({device.X_PN.R(), tip})}, *scene)
                    .total_W.force_n;
      if (i < 5500) continue;
      low = std::min(low, device.X_PN.p().z());
      high = std::max(high, device.X_PN.p().z());
    }
    EXPECT_LT(high - low, 4 * kCount_mm) << "depth " << depth;  // no limit cycle beyond a few counts
  }
}
INSTANTIATE_TEST_SUITE_P(BareMasses, ClosedLoop, ::testing::Values(0.045, 0.15));

TEST(Tick, LimitsTheTorqueAboutTheStylusToItsOwnPeak) {
  // A transducer pressed into the skin and turned about its own long axis; gel leaves little friction.
  haptics::HapticOptions options;
  options.tool = haptics::Tool::kTransducer;
  options.has_weight_compensation = false;
  stylus::DeviceCapability device;
  for (const double most_nmm : {0.0, 0.5}) {
    device.peak_roll_nmm = most_nmm;
    const auto scene = haptics::make_haptic_scene(layered_patient({{0, kFat}}), paper_tissues(), {}, device, options);
    ASSERT_TRUE(scene.has_value());
    haptics::HapticState state;
    double roll_nmm = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double depth_mm = std::min(8.0, -5.0 + 0.01 * i);
      const double turn_rad = std::max(0.0, 0.0005 * (i - 1500));
      const Mat3 R_PT =
          (Eigen::AngleAxisd(turn_rad, Vec3::UnitZ()) * Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()))
              .toRotationMatrix();
      const haptics::HapticOutput output =
          haptics::tick(state, {0.001 * i, 0.001, telemetry::to_tool_pose(Pose(R_PT, {0.0, 0.0, depth_mm}))}, **scene);
      const Vec3 stylus_P = (Pose(R_PT, Vec3::Zero()) * (*scene)->X_SN.inverse()).R().col(2);
      roll_nmm = std::max(roll_nmm, std::abs(output.total_W.torque_nmm.dot(stylus_P)));
    }
    if (most_nmm > 0.0)
      EXPECT_NEAR(roll_nmm, most_nmm, 1e-9);
    else
      EXPECT_GT(roll_nmm, 1.0);
  }
}

}  // namespace
}  // namespace trocar::testing
