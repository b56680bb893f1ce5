#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/simulated/faulty_device.h"
#include "server/device_trial.h"
#include "server/test/weighing_scale.h"

namespace trocar::server {
namespace {

TEST(StylusWeighingRefuses, ADeviceWithoutForceOrWithSelfSupport) {
  EXPECT_EQ(refusal_of(weigh(testing::device_preset("mouse"), {})), WeighRefusal::kNoForce);
  stylus::DevicePreset carried = testing::device_preset("omega6");
  carried.capability.stylus_weight_n = 0.0;
  EXPECT_EQ(refusal_of(weigh(carried, {})), WeighRefusal::kCarriedByDevice);
}

TEST(StylusWeighingRefuses, AWeightAboveTheContinuousForce) {
  const stylus::DevicePreset omni = testing::device_preset("omni");  // continuously 0.88 N
  EXPECT_EQ(refusal_of(weigh(omni, weighing(0.85))), WeighRefusal::kNone);
  for (const double weight_n : {0.95, 1.2, 2.0}) {
    const Course course = weigh(omni, weighing(weight_n));
    EXPECT_EQ(refusal_of(course), WeighRefusal::kTooHeavy) << weight_n;
    EXPECT_DOUBLE_EQ(course.result->limit_n, 0.88);
    EXPECT_LE(course.most_n, 1.5 * 0.88 + 1e-9);
  }
}

TEST(StylusWeighingRefuses, AnArmThatPullsUp) {
  EXPECT_EQ(refusal_of(weigh(testing::device_preset("premium"), weighing(-0.2))), WeighRefusal::kPullsUp);
}

TEST(StylusWeighingRefuses, AStylusInItsHolder) {
  VirtualHapticDevice device(testing::device_preset("premium"), {});
  const Course course = Scale(device).weigh(std::nullopt);
  EXPECT_EQ(refusal_of(course), WeighRefusal::kHeld);
  EXPECT_LT(course.most_n, 2.0) << "a stuck encoder looks the same";
}

TEST(StylusWeighingRefuses, AStylusThatAHandStillHolds) {
  for (const char* name : {"premium", "omni", "inverse3"}) {
    for (const double stiffness_n_per_mm : {0.1, 0.5, 2.0}) {
      VirtualHapticDevice device(testing::device_preset(name), {});
      device.hold(hand_of(stiffness_n_per_mm));
      const WeighRefusal refusal = refusal_of(Scale(device).weigh(std::nullopt));
      EXPECT_TRUE(refusal == WeighRefusal::kHeld || refusal == WeighRefusal::kUnsteady)
          << name << ", " << stiffness_n_per_mm << " N/mm: " << static_cast<int>(refusal);
    }
  }
}

/// Weighs a Premium in a hand that follows a path: position (mm) at a time (s).
template <class Path>
Course weigh_in_moving_hand(const Path& path) {
  VirtualHapticDevice device(testing::device_preset("premium"), {});
  devices::DeviceHand hand = hand_of(1.0);
  Scale scale(device);
  scale.trial().weigh();
  Course course;
  while (!course.result && scale.now_s < kLongest_s) {
    hand.time_s = scale.now_s;
    hand.X_DS = Pose(kLevel.R(), path(scale.now_s));
    device.hold(hand);
    course = scale.run(kPeriod_s / 2.0);
  }
  return course;
}

TEST(StylusWeighingRefuses, AStylusThatAHandMoves) {
  const auto tremor = [](double time_s) { return Vec3(4.0 * std::sin(6.0 * std::numbers::pi * time_s), 0.0, 0.0); };
  EXPECT_EQ(refusal_of(weigh_in_moving_hand(tremor)), WeighRefusal::kNotAtRest);
  const auto away = [](double time_s) { return Vec3(30.0 * std::max(0.0, time_s - 2.0), 0.0, 0.0); };
  EXPECT_EQ(refusal_of(weigh_in_moving_hand(away)), WeighRefusal::kMoved);
}

TEST(StylusWeighingRefuses, ADeviceThatAcceptsNoForces) {
  testing::ScriptedDevice device(testing::device_preset("omni"));
  device.takes_writes = false;
  Scale scale(device);
  scale.trial().weigh();
  const Course course = scale.run(kLongest_s);
  EXPECT_EQ(refusal_of(course), WeighRefusal::kForcesOff);
}

TEST(StylusWeighing, AGateFaultEndsItAtZeroForce) {
  struct Case {
    const char* fault;
    telemetry::GateFault expected;
  };
  // Placed and held until 0.55 s, at rest until 4 s, then moving.
  for (const Case& c :
       {Case{"nan@0.4", telemetry::GateFault::kNotFinite}, Case{"nan@2", telemetry::GateFault::kNotFinite},
        Case{"disconnect@6", telemetry::GateFault::kDeviceLost}, Case{"dropped@9", telemetry::GateFault::kDeviceSilent},
        Case{"jump:20@12", telemetry::GateFault::kImpossibleMotion}}) {
    VirtualHapticDevice* inner = nullptr;
    auto owned = std::make_unique<VirtualHapticDevice>(testing::device_preset("premium"), weighing(0.5));
    inner = owned.get();
    devices::DeviceHand hand = hand_of(0.5);
    inner->hold(hand);
    devices::FaultyDevice device(std::move(owned), {*devices::parse_fault(c.fault)}, 1);
    Scale scale(device);
    scale.trial().weigh();
    bool is_released = false;
    Course course;
    double before_n = 0.0;
    while (!course.result && scale.now_s < kLongest_s) {
      before_n = course.last_n;
      course = scale.run(kPeriod_s / 2.0);
      if (!is_released && scale.now_s > 2.2) {
        hand.is_held = false;
        inner->hold(hand);
        is_released = true;
      }
    }
    ASSERT_TRUE(course.result) << c.fault;
    EXPECT_EQ(course.result->refusal, WeighRefusal::kFault) << c.fault;
    EXPECT_EQ(course.result->fault, c.expected) << c.fault;
    EXPECT_GT(before_n, 0.1) << c.fault << ": there was a force";
    EXPECT_LT(course.last_n, before_n) << c.fault << ": it falls in the period of the fault";
    scale.run(haptics::GateParams{}.fault_ramp_s);
    EXPECT_EQ(scale.run(1.0).most_n, 0.0) << c.fault;
    EXPECT_NE(weigh_error(*course.result, "premium").what.find(to_string(c.expected)), std::string::npos);
  }
}

TEST(StylusWeighing, RunsAfterAClearedFault) {
  VirtualHapticDevice inner(testing::device_preset("omni"), weighing(0.6));
  testing::ScriptedDevice gone(testing::device_preset("omni"));
  gone.reading.status = devices::DeviceStatus::kDisconnected;
  Scale scale(gone);
  EXPECT_EQ(refusal_of(scale.weigh()), WeighRefusal::kFault);
  EXPECT_EQ(refusal_of(scale.weigh()), WeighRefusal::kFault) << "still unplugged";
  gone.reading.status = devices::DeviceStatus::kFresh;
  scale.trial().weigh();
  scale.run(2.0);
  EXPECT_TRUE(scale.step().is_weighing);
  EXPECT_GT(scale.step().written_D.force_n.z(), 0.4) << "the preset's weight";
}

TEST(WeighReport, EveryRefusalStatesCauseAndAdviceInOneLine) {
  for (auto refusal = WeighRefusal::kNoForce; refusal <= WeighRefusal::kPullsUp;
       refusal = static_cast<WeighRefusal>(static_cast<int>(refusal) + 1)) {
    WeighResult result;
    result.refusal = refusal;
    const Error error = weigh_error(result, "virtual:omni");
    EXPECT_FALSE(error.what.empty());
    EXPECT_FALSE(error.advice.empty());
    EXPECT_EQ(error.text().find_first_of("\n\t"), std::string::npos);
  }
}

TEST(WeighReport, StatesWhyThereIsNoLever) {
  WeighResult result;
  result.weight_n = 0.81;
  EXPECT_NE(weigh_text(result, testing::device_preset("omni")).find("no torque"), std::string::npos);
  EXPECT_NE(weigh_text(result, testing::device_preset("premium")).find("level"), std::string::npos);
  result.lever_mm = 12.0;
  EXPECT_NE(weigh_text(result, testing::device_preset("premium")).find("12 mm behind the grip"), std::string::npos);
}

}  // namespace
}  // namespace trocar::server
