#include "server/stylus_weighing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/testing/allocation_guard.h"
#include "server/device_trial.h"
#include "server/test/weighing_scale.h"

namespace trocar::server {
namespace {

TEST(StylusWeighing, FindsWeightFrictionAndLeverOfEveryPreset) {
  for (const stylus::DevicePreset& preset : presets_with_force()) {
    for (const double weight_n : {preset.capability.stylus_weight_n, 0.5 + kAttachment_n}) {
      const Course course = weigh(preset, weighing(weight_n, 35.0));
      expect_weight(course, weight_n, preset.name);
      const WeighResult& result = *course.result;
      EXPECT_NEAR(result.friction_n, preset.friction_n, kWeight_n) << preset.name;
      EXPECT_LT(result.horizontal_n, kWeight_n) << preset.name;
      EXPECT_LT(result.spread_n, kWeight_n) << preset.name;
      ASSERT_EQ(result.lever_mm.has_value(), preset.has_torque()) << preset.name;
      if (result.lever_mm) {
        EXPECT_NEAR(*result.lever_mm, 35.0, kLever_mm) << preset.name;
      }
    }
  }
}

TEST(StylusWeighing, FindsAnAttachmentInFrontOfTheGrip) {
  const Course course = weigh(testing::device_preset("sigma7"), weighing(0.8, -30.0));
  expect_weight(course, 0.8, "sigma7");
  EXPECT_NEAR(course.result->lever_mm.value_or(0.0), -30.0, kLever_mm);
}

TEST(StylusWeighing, CancelsFrictionAsLargeAsTheWeight) {
  stylus::DevicePreset preset = testing::device_preset("falcon");
  preset.friction_n = 0.45;
  const Course course = weigh(preset, weighing(0.4));
  expect_weight(course, 0.4, "falcon");
  EXPECT_NEAR(course.result->friction_n, 0.45, kWeight_n);
}

TEST(StylusWeighing, ALeverNeedsALevelStylus) {
  const Pose upright(rotation_between(Vec3::UnitZ(), -Vec3::UnitZ()), Vec3::Zero());
  const Course course = weigh(testing::device_preset("premium"), weighing(0.5), upright);
  expect_weight(course, 0.5, "upright");
  EXPECT_FALSE(course.result->lever_mm.has_value());
}

/// Light and heavy styluses with more delay: no fault, and a quiet stylus.
TEST(StylusWeighing, HoldsEveryPresetQuietly) {
  constexpr double kSettled_s = 4.0;       // the hand has let go for 3 s
  constexpr double kFast_mm_per_s = 25.0;  // 2 mm/s and slips after sticking; an oscillation reaches hundreds
  constexpr double kBeyond_n = 0.4;        // above weight and friction: single counts of 0.06 mm in a period
  for (const stylus::DevicePreset& given : presets_with_force()) {
    for (const auto& [mass_kg, delay] : {std::pair(0.045, 3), std::pair(0.5, 1), std::pair(0.5, 3)}) {
      stylus::DevicePreset preset = given;
      preset.apparent_mass_kg = mass_kg;
      SimulatedDeviceParams params = weighing(0.5 + kAttachment_n);
      params.force_delay = delay;
      params.reading_delay = delay - 1;
      VirtualHapticDevice device(preset, params);
      Scale scale(device);
      scale.trial().weigh(kLevel);
      const double farthest_mm = scale.run(kSettled_s).farthest_mm;
      const Course course = scale.run(kLongest_s);
      const std::string what = fmt::format("{}, {} kg, delay {}", preset.name, mass_kg, delay);
      expect_weight(course, 0.8, what);
      EXPECT_LT(course.fastest_mm_per_s, kFast_mm_per_s) << what;
      EXPECT_LT(std::max(farthest_mm, course.farthest_mm), StylusWeighing::kWay_mm + 5.0) << what;
      EXPECT_LT(course.most_n, 0.8 + preset.friction_n + kBeyond_n) << what;
    }
  }
}

TEST(StylusWeighing, IsIndependentOfTheRate) {
  for (const double rate_hz : {250.0, 500.0, 4000.0})
    expect_weight(weigh(testing::device_preset("delta6"), weighing(0.7), kLevel, rate_hz), 0.7,
                  fmt::format("{} Hz", rate_hz));
}

/// A device whose base is tilted about its x, which it does not know.
class TiltedDevice final : public devices::HapticDevice {
 public:
  TiltedDevice(VirtualHapticDevice& device, double tilt_rad)
      : device_(device), R_(Eigen::AngleAxisd(tilt_rad, Vec3::UnitX())) {}
  const stylus::DevicePreset& preset() const noexcept override { return device_.preset(); }
  std::string name() const override { return "tilted"; }
  devices::DeviceReading read(double now_s) noexcept override {
    devices::DeviceReading reading = device_.read(now_s);
    reading.X_DS = Pose(R_, Vec3::Zero()) * reading.X_DS;
    return reading;
  }
  bool write(const Wrench& wrench) noexcept override {
    return device_.write({R_.transpose() * wrench.force_n, R_.transpose() * wrench.torque_nmm});
  }
  void hold(const devices::DeviceHand& hand) noexcept override { device_.hold(hand); }
  bool is_in_real_hand() const noexcept override { return false; }
  Status reconnect() override { return {}; }

 private:
  VirtualHapticDevice& device_;
  const Mat3 R_;
};

TEST(StylusWeighing, ShowsATiltedBase) {
  constexpr double kTilt_rad = 0.3;
  VirtualHapticDevice inner(testing::device_preset("omega6"), weighing(0.5));
  TiltedDevice device(inner, kTilt_rad);
  const Course course = Scale(device).weigh();
  expect_weight(course, 0.5 * std::cos(kTilt_rad), "tilted");
  EXPECT_NEAR(course.result->horizontal_n, 0.5 * std::sin(kTilt_rad), kWeight_n);
  EXPECT_NE(weigh_text(*course.result, device.preset()).find("tilted base"), std::string::npos);
}

/// Distance that a released stylus moves within a time while the server compensates the preset's weight.
double drift_mm(const stylus::DevicePreset& compensated, const SimulatedDeviceParams& params, double for_s) {
  VirtualHapticDevice device(compensated, params);
  SceneBuilder builder(testing::layered_opener(), testing::data_file("tissues.toml"), compensated);
  const ServoScene scene = builder.load(testing::layered_request()).value();
  Servo servo(device, servo_params(compensated));
  devices::DeviceHand hand = hand_of(0.5);
  hand.X_DS = testing::needle_at_depth(-40.0);
  device.hold(hand);
  ServoInput input;
  input.scene = &scene;
  input.is_wanted = true;
  const auto run = [&](double run_s) {
    for (const double end_s = input.now_s + run_s; input.now_s < end_s;) {
      input.now_s += kPeriod_s;
      EXPECT_EQ(servo.step(input).sample.gate_fault, telemetry::GateFault::kNone);
    }
  };
  run(1.5);  // past the safe start
  const Vec3 released_D = device.X_DS().p();
  hand.is_held = false;
  device.hold(hand);
  run(for_s);
  return (device.X_DS().p() - released_D).norm();
}

TEST(StylusWeighing, CompensatesAWeighedAttachment) {
  for (const char* name : {"premium", "desktop", "sigma7", "inverse3"}) {
    stylus::DevicePreset preset = testing::device_preset(name);
    const SimulatedDeviceParams params = weighing(preset.capability.stylus_weight_n + kAttachment_n, 10.0);
    EXPECT_GT(drift_mm(preset, params, 0.25), 15.0) << name << ": it sinks with the preset's weight";
    const Course course = weigh(preset, params);
    expect_weight(course, *params.weight_n, name);
    preset.capability.stylus_weight_n = course.result->weight_n;
    if (course.result->lever_mm) preset.capability.stylus_lever_mm = *course.result->lever_mm;
    EXPECT_LT(drift_mm(preset, params, 2.0), 0.05) << name << ": friction holds what is not compensated";
  }
}

TEST(StylusWeighing, IgnoresAPushAndCanBeRepeated) {
  VirtualHapticDevice device(testing::device_preset("premium"), weighing(0.6));
  Scale scale(device);
  scale.trial().weigh(kLevel);
  scale.run(5.0);
  scale.trial().push();
  scale.trial().weigh(kLevel);
  const Course first = scale.run(kLongest_s);
  expect_weight(first, 0.6, "once");
  EXPECT_EQ(scale.run(1.0).most_n, 0.0) << "no push is left";
  scale.trial().push();
  scale.run(0.7);
  expect_weight(scale.weigh(), 0.6, "again, and the push ends");
}

TEST(StylusWeighing, AllocatesNothing) {
  VirtualHapticDevice device(testing::device_preset("premium"), weighing(0.6));
  Scale scale(device);
  const testing::AllocationGuard guard;
  const Course course = scale.weigh();
  EXPECT_EQ(guard.count(), 0u);
  expect_weight(course, 0.6, "premium");
}

TEST(StylusWeighing, StaysWithinItsForceForAnyReading) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const stylus::DevicePreset preset = testing::device_preset("sigma7");
  const haptics::GateParams gate;
  for (const double odd : {kNan, 0.0, -1.0, 1e300, 1e-300}) {
    StylusWeighing weighing(preset, gate);
    weighing.start();
    StylusWeighing::Input input;
    for (int i = 0; i < 3000; ++i) {
      input.X_DS = i % 3 == 0 ? std::optional<Pose>() : Pose::translation(Vec3::Constant(std::isnan(odd) ? 0.0 : odd));
      input.dt_s = i % 5 == 0 ? odd : kPeriod_s;
      input.mode = i < 100 ? telemetry::GateMode::kOff : telemetry::GateMode::kOn;
      const StylusWeighing::Demand demand = weighing.step(input);
      const double force_n = (demand.wanted_D.force_n + demand.weight_D.force_n).norm();
      ASSERT_TRUE(force_n <= 3.0 + 1e-9) << odd << " in period " << i;
    }
  }
}

}  // namespace
}  // namespace trocar::server
