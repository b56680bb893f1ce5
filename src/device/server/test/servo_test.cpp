#include "server/servo.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/allocation_guard.inc.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

using testing::AllocationGuard;
using testing::has_event;
using testing::has_limit;
using testing::needle_at_depth;
using testing::ServoRig;

TEST(Servo, WritesNoForceBeforeItIsRequested) {
  ServoRig rig;
  rig.input.is_wanted = false;
  rig.move_to(3.0, 20.0);
  EXPECT_EQ(rig.most_n, 0.0);
}

TEST(Servo, RendersSkinContactAndPuncture) {
  ServoRig rig;
  rig.start();
  EXPECT_EQ(rig.servo.mode(), telemetry::GateMode::kOn);
  const auto records = rig.move_to(20.0, 10.0);
  EXPECT_TRUE(has_event(records, telemetry::EventKind::kPuncture));
  const auto drop = std::find_if(records.begin(), records.end(), [](const ServoRecord& r) { return r.drop_n > 1.0; });
  EXPECT_NE(drop, records.end()) << "the gate reports the fall of the force";
  for (const ServoRecord& record : records) {
    const Vec3 written_P = testing::layered_request().X_PW.R() * record.written_D.force_n;
    const Vec3 turned_P = testing::layered_request().X_PW.R() * record.written_D.torque_nmm;
    ASSERT_NEAR((written_P - record.sample.device_f_n).norm(), 0.0, 1e-12) << "what is recorded is what was written";
    ASSERT_NEAR((turned_P - record.sample.device_tau_nmm).norm(), 0.0, 1e-12);
    ASSERT_EQ(record.sample.gate_mode, record.sample.gate_mode);
    ASSERT_EQ(record.sample.gate_fault, record.sample.gate_fault);
    ASSERT_EQ(record.sample.gate_scale, record.sample.gate_scale);
  }
}

TEST(Servo, PassesTheTickWrenchUnchangedWithoutFaults) {
  ServoRig rig;
  rig.start();
  int untouched = 0;
  for (const ServoRecord& record : rig.move_to(20.0, 10.0)) {
    if (record.actions != 0) continue;
    ++untouched;
    ASSERT_NEAR((record.written_D.force_n - record.wanted_D.force_n).norm(), 0.0, 1e-9) << record.sample.time_s;
  }
  EXPECT_GT(untouched, 2500) << "of 3000 periods";
}

TEST(Servo, FadesOnASilentClientAndReturnsWithoutAJump) {
  ServoRig rig;
  rig.start();
  rig.move_to(2.0, 10.0);
  const double before_n = rig.hold(0.5).back().written_D.force_n.norm();
  ASSERT_GT(before_n, 0.5);
  for (int i = 1; i <= 450; ++i) {
    rig.input.silence_s = 0.001 * i;
    const ServoRecord record = rig.step();
    if (i <= 250) {
      ASSERT_EQ(record.actions & haptics::kGateStale, 0) << i;
    }
  }
  EXPECT_LT(rig.device.written.force_n.norm(), 1e-9);
  rig.input.silence_s = 0.0;
  rig.largest_rise_n = 0.0;
  const auto records = rig.hold(1.5);
  EXPECT_NEAR(records.back().written_D.force_n.norm(), before_n, 0.1 * before_n);
  EXPECT_LT(rig.largest_rise_n, 0.05 * before_n);
}

TEST(Servo, LatchesALostDeviceUntilAReset) {
  ServoRig rig;
  rig.start();
  rig.move_to(2.0, 10.0);
  rig.device.reading.status = devices::DeviceStatus::kDisconnected;
  for (int i = 0; i < 30; ++i) rig.step();
  EXPECT_EQ(rig.device.written.force_n.norm(), 0.0);
  rig.device.reading.status = devices::DeviceStatus::kFresh;
  EXPECT_EQ(rig.hold(0.5).back().sample.gate_fault, telemetry::GateFault::kDeviceLost) << "until somebody resets it";
  rig.input.is_reset = true;
  rig.step();
  rig.move_to(-10.0, 50.0);
  EXPECT_EQ(rig.hold(2.0).back().sample.gate_fault, telemetry::GateFault::kNone);
  EXPECT_EQ(rig.servo.mode(), telemetry::GateMode::kOn);
}

TEST(Servo, TreatsRefusedWritesAsALostDevice) {
  ServoRig rig;
  rig.start();
  rig.device.takes_writes = false;
  rig.hold(0.1);
  EXPECT_EQ(rig.step().sample.gate_fault, telemetry::GateFault::kDeviceLost);
}

TEST(Servo, LatchesAFaultOnANonFinitePose) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    ServoRig rig;
    rig.start();
    rig.move_to(2.0, 10.0);
    rig.device.reading.X_DS = Pose(Mat3::Identity(), {bad, 0.0, 0.0});
    EXPECT_EQ(rig.step().sample.gate_fault, telemetry::GateFault::kNotFinite);
    for (int i = 0; i < 30; ++i) rig.step();
    EXPECT_EQ(rig.device.written.force_n.norm(), 0.0);
  }
}

TEST(Servo, DetectsAStuckEncoderUnderForce) {
  ServoRig rig;
  rig.start();
  rig.move_to(3.0, 10.0);
  ASSERT_GT(rig.device.written.force_n.norm(), ServoParams{}.stuck_n);
  ServoRecord record;
  int periods = 0;
  for (; periods < 7000 && record.sample.gate_fault == telemetry::GateFault::kNone; ++periods) record = rig.step();
  EXPECT_EQ(record.sample.gate_fault, telemetry::GateFault::kEncoderStuck);
  EXPECT_NEAR(periods * rig.input.dt_s, ServoParams{}.stuck_s, 0.01);
}

TEST(Servo, DoesNotMistakeATremblingHandForAStuckEncoder) {
  ServoRig rig;
  rig.start();
  rig.move_to(3.0, 10.0);
  EXPECT_EQ(rig.hold(8.0).back().sample.gate_fault, telemetry::GateFault::kNone);
}

TEST(Servo, NeverAllocates) {
  ServoRig rig;
  rig.start();
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) {
    rig.device.reading.X_DS = testing::needle_at_depth(0.01 * i);
    if (i == 2000) rig.device.reading.status = devices::DeviceStatus::kDisconnected;
    rig.input.hand = link::HandTarget{};
    rig.input.silence_s = i == 1000 ? 0.4 : 0.0;
    rig.servo.step(rig.input);
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(Servo, IsDeterministic) {
  const auto run = [] {
    ServoRig rig("premium", "proxy");
    rig.start();
    rig.move_to(30.0, 25.0);
    return rig.device.written;
  };
  const Wrench first = run(), second = run();
  EXPECT_EQ(first.force_n, second.force_n);
  EXPECT_EQ(first.torque_nmm, second.torque_nmm);
}

TEST(Servo, KeepsTheInsertionWhenOnlyNumbersChange) {
  ServoRig rig;
  rig.start();
  rig.move_to(30.0, 20.0);
  const double before_mm = rig.hold(0.3).back().sample.depth_mm;
  ASSERT_GT(before_mm, 15.0);
  auto changed = rig.builder.change({.tissues = std::vector<link::TissueSetting>{{"liver", "mu", 0.1}}});
  ASSERT_TRUE(changed) << changed.error().text();
  rig.input.scene = &*changed;
  const auto records = rig.hold(0.3);
  EXPECT_NEAR(records.back().sample.depth_mm, before_mm, 1.0);
  EXPECT_EQ(rig.servo.mode(), telemetry::GateMode::kOn);
  EXPECT_FALSE(has_limit(records, telemetry::LimitReason::kSafeStart));
}

TEST(Servo, RunsTheSafeStartForAnotherScene) {
  ServoRig rig;
  rig.start();
  rig.move_to(30.0, 20.0);
  auto other = rig.builder.load(testing::layered_request("proxy"));
  ASSERT_TRUE(other);
  rig.input.scene = &*other;
  rig.largest_rise_n = 0.0;
  const auto records = rig.hold(0.1);
  EXPECT_TRUE(has_limit(records, telemetry::LimitReason::kSafeStart));
  EXPECT_LT(rig.largest_rise_n, 0.2);
}

/// Without forces a stylus sags across the needle's channel. The needle begins where it is put, not where it sagged.
TEST(Servo, RestartsWhereTheNeedleIsPlaced) {
  ServoRig rig;
  rig.input.is_wanted = false;
  const Pose X_DS_put = testing::needle_at_depth(20.0);
  rig.device.reading.X_DS = Pose(X_DS_put.R(), X_DS_put.p() + Vec3(3.0, 0.0, 0.0));
  for (int i = 0; i < 100; ++i) rig.step();
  link::HandTarget put;
  put.X_PN = rig.scene.scene->X_PW * X_DS_put * rig.scene.scene->X_SN;
  put.is_placed = put.is_rigid = true;
  rig.input.hand = put;
  rig.step();
  rig.device.reading.X_DS = X_DS_put;
  for (int i = 0; i < 100; ++i) rig.step();
  rig.input.is_wanted = true;
  std::vector<ServoRecord> records;
  for (int i = 0; i < 1000; ++i) records.push_back(rig.step());
  EXPECT_EQ(rig.servo.mode(), telemetry::GateMode::kOn);
  EXPECT_EQ(records.back().sample.gate_fault, telemetry::GateFault::kNone);
  EXPECT_LT(records.back().sample.f_constraint_n.norm(), 0.05);
  EXPECT_NEAR(records.back().sample.depth_mm, 20.0, 0.1);
}

TEST(Servo, ScalesForcesToAWeakDevice) {
  ServoRig strong, weak("omni");
  for (ServoRig* rig : {&strong, &weak}) {
    rig->start();
    rig->move_to(30.0, 10.0);
  }
  EXPECT_LE(weak.most_n, weak.preset.capability.peak_force_n + 1e-9);
  EXPECT_LT(weak.most_n, 0.7 * strong.most_n);
}

TEST(Servo, LatchesAFaultAfterALongTimeGapButNotAShortOne) {
  for (const double hole_s : {0.045, 3.0}) {
    ServoRig rig;
    rig.start();
    rig.move_to(20.0, 20.0);
    rig.input.now_s += hole_s;
    rig.input.dt_s = hole_s;
    rig.step();
    rig.input.dt_s = 0.001;
    rig.largest_rise_n = 0.0;
    const auto records = rig.hold(1.0);
    EXPECT_TRUE(records.back().written_D.force_n.allFinite());
    EXPECT_LE(rig.largest_rise_n, haptics::GateParams{}.slew_n_per_s * rig.input.dt_s + 1e-9);
    EXPECT_EQ(records.back().sample.gate_fault,
              hole_s > 1.0 ? telemetry::GateFault::kLoopStalled : telemetry::GateFault::kNone);
  }
}

TEST(Servo, CountsDeviceSilenceOnlyWhileItsLoopRuns) {
  for (const bool is_back : {true, false}) {
    ServoRig rig;
    rig.start();
    rig.move_to(20.0, 20.0);
    const double before_s = rig.input.now_s;
    rig.device.reading.status = devices::DeviceStatus::kRepeated;
    rig.input.dt_s = 0.025;  // the driver, delayed by the same machine, has brought nothing yet
    EXPECT_EQ(rig.step().sample.gate_fault, telemetry::GateFault::kNone);
    rig.input.dt_s = 0.001;
    if (is_back) rig.device.reading.status = devices::DeviceStatus::kFresh;
    const auto records = rig.hold(0.1);
    const auto fault = std::ranges::find(records, telemetry::GateFault::kDeviceSilent,
                                         [](const ServoRecord& record) { return record.sample.gate_fault; });
    if (is_back) {
      EXPECT_EQ(fault, records.end());
    } else {
      ASSERT_NE(fault, records.end());
      EXPECT_LT(fault->sample.time_s, before_s + 0.025 + 0.02);
    }
  }
}

/// A slow loop finds an unplugged device after five of its periods, whatever their length.
TEST(Servo, DetectsASilentDeviceInASlowLoop) {
  const double max_unread_s = haptics::GateParams{}.max_unread_s;
  for (const auto& [period_s, expected] : {std::pair{0.00099, 21}, {0.003, 7}, {0.006, 5}, {0.1, 5}}) {
    detail::ReadingAge age;
    EXPECT_EQ(age.advance(true, period_s, max_unread_s), period_s);
    int periods = 0;
    while (age.unread_s() <= max_unread_s) {
      ++periods;
      EXPECT_NEAR(age.advance(false, period_s, max_unread_s), periods * period_s, 1e-12);
    }
    EXPECT_EQ(periods, expected) << period_s;
    EXPECT_NEAR(age.advance(true, period_s, max_unread_s), (periods + 1) * period_s, 1e-12) << "a velocity's time";
    EXPECT_EQ(age.unread_s(), 0.0);
  }
}

/// A loop that is late for reasons of its own is weakened with the first late period; a machine is excused one hole.
TEST(Servo, WeakensTheCouplingOfASlowLoopAtOnce) {
  for (const bool is_own : {true, false}) {
    ServoRig rig;
    rig.start();
    rig.move_to(3.0, 10.0);
    const double before_n = rig.hold(0.3).back().written_D.force_n.norm();
    ASSERT_GT(before_n, 1.0);
    rig.input.dt_s = 0.009;
    rig.input.busy_s = is_own ? 0.008 : 0.0;
    const ServoRecord first = rig.step();
    EXPECT_EQ(first.sample.coupling_share < 1.0, is_own);
    EXPECT_EQ((first.actions & haptics::kGateSlowLoop) != 0, is_own);
    const ServoRecord second = rig.step();
    // 0.0035 N s/mm of device and loose hand over 1.5 k_c * 9 ms - b_c.
    const stylus::CouplingParams coupling = testing::device_preset().coupling;
    const double lost_ns_per_mm = 1.5 * coupling.stiffness_n_per_mm * 0.009 - coupling.damping_ns_per_mm;
    EXPECT_NEAR(second.sample.coupling_share, 0.0035 / lost_ns_per_mm, 1e-3);
    EXPECT_LT(second.written_D.force_n.norm(), 0.7 * before_n);
    double slow_s = 0.018;
    ServoRecord record = second;
    while (record.sample.gate_fault == telemetry::GateFault::kNone && slow_s < 1.0) {
      record = rig.step();
      slow_s += rig.input.dt_s;
    }
    EXPECT_EQ(record.sample.gate_fault, telemetry::GateFault::kLoopSlow);
    EXPECT_LE(slow_s, 0.055) << "50 ms, and the period in which they end";
  }
}

TEST(Servo, ToleratesSingleStallsOfABusyMachine) {
  ServoRig rig;
  rig.start();
  rig.move_to(3.0, 10.0);
  for (const double hole_s : {0.006, 0.01, 0.02, 0.03, 0.045}) {
    rig.input.dt_s = hole_s;
    const ServoRecord record = rig.step();
    EXPECT_EQ(record.sample.coupling_share, 1.0) << hole_s;
    rig.input.dt_s = 0.001;
    EXPECT_EQ(rig.hold(0.1).back().sample.gate_fault, telemetry::GateFault::kNone) << hole_s;
  }
}

TEST(Servo, LatchesImmediatelyOnAnImpossibleJump) {
  for (const double jump_mm : {4.0, 10.0, 50.0, 100.0}) {
    ServoRig rig;
    rig.start();
    rig.move_to(3.0, 10.0);
    const double before_n = rig.hold(0.2).back().written_D.force_n.norm();
    rig.most_n = 0.0;
    // There and back every 20 ms, as a loose plug does.
    ServoRecord record;
    int periods = 0;
    for (int i = 0; i < 2000; ++i) {
      const Pose X_DS = needle_at_depth(rig.depth);
      rig.device.reading.X_DS = Pose(X_DS.R(), X_DS.p() + Vec3((i / 20) % 2 == 0 ? jump_mm : 0.0, 0.0, 0.0));
      record = rig.step();
      if (record.sample.gate_fault == telemetry::GateFault::kNone) ++periods;
      if (i == 25) {
        EXPECT_EQ(rig.last_n, 0.0);
      }
    }
    EXPECT_EQ(record.sample.gate_fault, telemetry::GateFault::kImpossibleMotion) << jump_mm;
    EXPECT_EQ(periods, 0) << "in the very period";
    EXPECT_LE(rig.most_n, before_n) << "no brake is pressed for it";
    EXPECT_EQ(rig.last_n, 0.0);
  }
}

TEST(Servo, NeverExceedsDeviceLimitsForAnyHandMotion) {
  for (const char* model : {"insertion", "proxy", "combined"}) {
    ServoRig rig("premium", model);
    rig.start();
    Random random(11);
    for (int i = 0; i < 20'000; ++i) {
      const Vec3 p(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-60, 60));
      const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (i % 50 == 0 && axis.norm() > 0.1)
        rig.device.reading.X_DS = Pose(rotation_between(Vec3::UnitZ(), axis.normalized()), p);
      const ServoRecord record = rig.step();
      ASSERT_TRUE(record.written_D.force_n.allFinite());
      ASSERT_LE(record.written_D.force_n.norm(), rig.preset.capability.peak_force_n + 1e-9);
      ASSERT_LE(record.written_D.torque_nmm.norm(), rig.preset.capability.peak_torque_nmm + 1e-9);
    }
  }
}

}  // namespace
}  // namespace trocar::server
