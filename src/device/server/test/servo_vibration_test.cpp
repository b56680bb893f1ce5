// The servo in closed loop with a simulated device in a simulated hand: what vibrates is a fault, what a hand does is
// none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/random.h"
#include "devices/simulated/virtual_haptic_device.h"
#include "server/test/servo_rig.h"

namespace trocar::server {
namespace {

using Motion = std::function<link::HandTarget(double time_s)>;

struct Outcome {
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  double fault_s = 0.0;
  double largest_n = 0.0;  ///< Until the fault.
  double speed_rms = 0.0;  ///< mm/s, of the last second before the fault.
  double after_n = 0.0;    ///< Largest force from 25 ms after the fault on.
};

Outcome run(const ServoScene& scene, const stylus::DevicePreset& preset, const Motion& motion, double seconds) {
  devices::VirtualHapticDevice device(preset, {});
  Servo servo(device, servo_params(preset));
  Outcome outcome;
  ServoInput input;
  input.scene = &scene;
  input.is_wanted = true;
  double sum = 0.0;
  while (input.now_s < seconds) {
    input.now_s += input.dt_s;
    input.hand = motion(input.now_s);
    input.hand->server_time_s = input.now_s;
    input.hand->is_placed = input.now_s < 0.0015;
    const ServoRecord record = servo.step(input);
    const double written_n = record.written_D.force_n.norm();
    if (record.sample.gate_fault != telemetry::GateFault::kNone && outcome.fault == telemetry::GateFault::kNone) {
      outcome.fault = record.sample.gate_fault;
      outcome.fault_s = input.now_s;
    }
    if (outcome.fault == telemetry::GateFault::kNone) {
      outcome.largest_n = std::max(outcome.largest_n, written_n);
      sum += 0.001 * (device.v_D().squaredNorm() - sum);
      outcome.speed_rms = std::sqrt(sum);
    } else if (input.now_s > outcome.fault_s + 0.025) {
      outcome.after_n = std::max(outcome.after_n, written_n);
    }
  }
  return outcome;
}

ServoScene load(SceneBuilder& builder, const std::string& model, const std::string& tool = "needle") {
  link::LoadScene request = testing::layered_request(model);
  request.tool = tool;
  auto scene = builder.load(request);
  TROCAR_CHECK(scene.has_value());
  if (tool == "needle") return *scene;
  // The device stands where its tool meets the skin.
  request.X_PW = Pose(request.X_PW.R(), {0.0, 0.0, -scene->scene->X_SN.p().z()});
  scene = builder.load(request);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

SceneBuilder builder_for(const stylus::DevicePreset& preset) {
  return {testing::layered_opener(), testing::data_file("tissues.toml"), preset};
}

link::HandTarget at(const Vec3& tip_P, const Vec3& axis_P = Vec3::UnitZ()) {
  link::HandTarget hand;
  hand.X_PN = needle_pose(tip_P, axis_P);
  return hand;
}

/// Down to a depth within a second, then still.
link::HandTarget hold_at(double depth_mm, double time_s) {
  return at({0.0, 0.0, std::min(depth_mm, -10.0 + (depth_mm + 10.0) * time_s)});
}

/// The same scene with a damper that no way in lets through.
ServoScene with_damping(const ServoScene& scene, double damping_ns_per_mm) {
  auto changed = std::make_shared<haptics::HapticScene>(*scene.scene);
  changed->options.coupling.damping_ns_per_mm = damping_ns_per_mm;
  return {changed, scene.number, scene.continues};
}

SceneBuilder builder_with_bone(const stylus::DevicePreset& preset) {
  return {
      [](const std::string&, std::uint64_t, const Progress&) -> Result<std::shared_ptr<const anatomy::VirtualPatient>> {
        return testing::layered_patient({{0, testing::kFat}, {12, testing::kMuscle}, {16, testing::kBone}});
      },
      testing::data_file("tissues.toml"), preset};
}

// 1 N s/mm is 200 times what the device bears. In soft tissue the needle slides along with the device and nothing
// vibrates; bone holds it.
TEST(ServoVibration, FaultsOnADamperBeyondTheDeviceLimit) {
  const stylus::DevicePreset preset = testing::device_preset();
  SceneBuilder builder = builder_with_bone(preset);
  const ServoScene good = load(builder, "proxy");
  const ServoScene bad = with_damping(good, 1.0);
  const Motion hold = [](double t) { return at({0.0, 0.0, std::min(20.0, -10.0 + 20.0 * t)}); };
  const Motion swing = [](double t) {
    return at({0.0, 0.0, std::min(10.0 + 10.0 * std::sin(3.0 * t), -10.0 + 20.0 * t)});
  };
  for (const Motion* motion : {&hold, &swing}) {
    EXPECT_EQ(run(good, preset, *motion, 4.0).fault, telemetry::GateFault::kNone);
    const Outcome outcome = run(bad, preset, *motion, 4.0);
    EXPECT_EQ(outcome.fault, telemetry::GateFault::kVibration)
        << to_string(outcome.fault) << ' ' << outcome.speed_rms << " mm/s";
    EXPECT_EQ(outcome.after_n, 0.0);
  }
}

class GoodMotion : public ::testing::TestWithParam<const char*> {};

TEST_P(GoodMotion, RaisesNoVibrationOrMotionFault) {
  const stylus::DevicePreset preset = testing::device_preset(GetParam());
  SceneBuilder builder = builder_for(preset);
  Random random(3);
  std::array<double, 6> phases{};
  for (double& phase : phases) phase = random.uniform(0.0, 6.0);
  const Motion push = [](double t) { return at({0.0, 0.0, std::min(45.0, -10.0 + 20.0 * t)}); };
  const Motion stab = [](double t) {
    return at({0.0, 0.0, t < 1.0 ? -10.0 : std::min(45.0, -10.0 + 300.0 * (t - 1.0))});
  };
  const Motion rough = [&](double t) {  // in and out and to the sides, up to 0.5 m/s
    const double depth = 10.0 + 25.0 * std::sin(9.0 * t + phases[0]) + 6.0 * std::sin(37.0 * t + phases[1]);
    return at({8.0 * std::sin(11.0 * t + phases[2]), 8.0 * std::sin(13.0 * t + phases[3]), depth},
              Vec3(0.2 * std::sin(7.0 * t + phases[4]), 0.2 * std::sin(6.0 * t + phases[5]), 1.0).normalized());
  };
  const Motion tremor = [](double t) {
    const link::HandTarget hold = hold_at(20.0, t);
    return at(hold.X_PN.p() + Vec3(0.3 * std::sin(50.0 * t), 0.3 * std::sin(60.0 * t), 0.5 * std::sin(70.0 * t)));
  };
  const Motion let_go = [](double t) {
    link::HandTarget hand = hold_at(20.0, t);
    hand.is_held = t < 2.0;
    return hand;
  };
  for (const char* model : {"insertion", "proxy", "combined"}) {
    const ServoScene scene = load(builder, model);
    const std::array<std::pair<const char*, const Motion*>, 5> motions{
        {{"push", &push}, {"stab", &stab}, {"rough", &rough}, {"tremor", &tremor}, {"let go", &let_go}}};
    for (const auto& [name, motion] : motions) {
      const Outcome outcome = run(scene, preset, *motion, 5.0);
      EXPECT_EQ(outcome.fault, telemetry::GateFault::kNone) << to_string(outcome.fault) << ", " << model << ' ' << name;
      EXPECT_GT(outcome.largest_n, 0.1) << model << ' ' << name;
    }
  }
}

TEST_P(GoodMotion, PalpationRaisesNoVibrationFault) {
  const stylus::DevicePreset preset = testing::device_preset(GetParam());
  for (const char* tool : {"finger", "probe"}) {
    SceneBuilder builder = builder_for(preset);
    const ServoScene scene = load(builder, "insertion", tool);
    const Motion tap = [](double t) {  // y of T points into the body
      link::HandTarget hand;
      Mat3 R_PT;
      R_PT.col(0) = Vec3::UnitX();
      R_PT.col(1) = Vec3::UnitZ();
      R_PT.col(2) = -Vec3::UnitY();
      hand.X_PN = Pose(R_PT, {20.0 * std::sin(2.0 * t), 0.0, -3.0 + 8.0 * std::sin(12.0 * t)});
      return hand;
    };
    const Outcome outcome = run(scene, preset, tap, 5.0);
    EXPECT_EQ(outcome.fault, telemetry::GateFault::kNone) << to_string(outcome.fault) << ", " << tool;
    EXPECT_GT(outcome.largest_n, 0.1) << tool;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryDevice, GoodMotion,
                         ::testing::Values("premium", "omni", "desktop", "omega6", "omega7", "sigma7", "delta6",
                                           "falcon", "inverse3"),
                         [](const auto& param) { return std::string(param.param); });

}  // namespace
}  // namespace trocar::server
