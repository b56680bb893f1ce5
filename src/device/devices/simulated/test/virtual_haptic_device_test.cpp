#include "devices/simulated/virtual_haptic_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "devices/test/server_periods.h"
#include "haptics/option_texts.h"
#include "haptics/test/layered_patient.h"
#include "haptics/tick.h"

namespace trocar::devices {
namespace {

using namespace trocar::testing;

class ReleasedInAir : public ::testing::TestWithParam<const char*> {};

TEST_P(ReleasedInAir, StaysPutWithWeightCompensation) {
  const stylus::DevicePreset preset = preset_of(GetParam());
  Bench bench(preset);
  const Pose X_DS(rotation_from_vector({0.3, 2.0, -0.4}), {10.0, -20.0, 30.0});
  DeviceReading reading = bench.period(placed_at(X_DS), {});
  for (int i = 0; i < 5000; ++i) reading = bench.period(DeviceHand{}, weight_compensation(preset, reading.X_DS));
  EXPECT_LT((bench.device.X_DS().p() - X_DS.p()).norm(), 0.5);  // what it falls before the first wrench acts
  EXPECT_LT(rotation_vector(bench.device.X_DS().R() * X_DS.R().transpose()).norm(), 0.02);
}

TEST_P(ReleasedInAir, SinksWithoutCompensation) {
  const stylus::DevicePreset preset = preset_of(GetParam());
  Bench bench(preset);
  bench.period(placed_at(Pose()), {});
  for (int i = 0; i < 3000; ++i) bench.period(DeviceHand{}, {});
  const Vec3 p_D = bench.device.X_DS().p();
  EXPECT_LT(p_D.z(), -0.9 * preset.workspace_radius_mm);  // onto its end stop
  EXPECT_GT(p_D.z(), -1.1 * preset.workspace_radius_mm);
  EXPECT_LT(bench.device.v_D().norm(), 1.0);  // and lies there
}
INSTANTIATE_TEST_SUITE_P(Presets, ReleasedInAir, ::testing::Values("premium", "omni", "omega7", "inverse3", "falcon"));

TEST(ReleasedStylus, TickOfAServerCarriesTheStylus) {
  const stylus::DevicePreset preset = preset_of("premium");
  for (const bool is_carried : {true, false}) {
    haptics::HapticOptions options;
    options.has_weight_compensation = is_carried;
    haptics::apply_device_preset(preset, options);
    const auto made =
        haptics::make_haptic_scene(layered_patient(liver_way()), paper_tissues(), {}, preset.capability, options);
    ASSERT_TRUE(made) << made.error().text();
    haptics::HapticScene scene = **made;
    // Down in D is down in P, and the needle is far above the skin.
    scene.X_PW = Pose(rotation_between(-Vec3::UnitZ(), scene.gravity_P), -800.0 * scene.gravity_P);
    Bench bench(preset);
    DeviceReading reading = bench.period(placed_at(Pose(rotation_from_vector({2.0, 0.5, 0.0}), Vec3::Zero())), {});
    haptics::HapticState state;
    for (int i = 0; i < 2000; ++i) {
      haptics::HapticInput input;
      input.time_s = bench.time_s;
      input.tool = haptics::tool_pose(scene, reading.X_DS);
      const haptics::HapticOutput output = haptics::tick(state, input, scene);
      reading = bench.period(DeviceHand{}, {output.total_W.force_n, output.total_W.torque_nmm});
    }
    const double sunk_mm = -bench.device.X_DS().p().z();
    if (is_carried) {
      EXPECT_LT(std::abs(sunk_mm), 0.5);
    } else {
      EXPECT_GT(sunk_mm, 100.0);
    }
  }
}

TEST(VirtualHapticDevice, FallsAccordingToItsWeightAndMass) {
  const stylus::DevicePreset preset = ideal();
  Bench bench(preset, without_friction());
  bench.period(placed_at(Pose::translation({0.0, 0.0, 50.0})), {});
  for (int i = 0; i < 100; ++i) bench.period(std::nullopt, {});
  const double acceleration = preset.capability.stylus_weight_n / preset.apparent_mass_kg * 1000.0;
  // S is the body's centre in this model (H2), so the lever turns it but does not bend its fall.
  EXPECT_NEAR(bench.device.X_DS().p().z(), 50.0 - 0.5 * acceleration * 0.01, 1e-6);
  EXPECT_NEAR(bench.device.X_DS().p().x(), 0.0, 1e-9);
}

TEST(VirtualHapticDevice, RestsInItsHolderUntilGrasped) {
  Bench bench(preset_of("premium"));
  for (int i = 0; i < 100; ++i) bench.period(std::nullopt, {{1.0, 0.0, 0.0}, Vec3::Zero()});
  EXPECT_EQ(bench.device.X_DS().p().norm(), 0.0);
}

TEST(VirtualHapticDevice, AppliesAWrenchAfterItsDelay) {
  for (const int delay : {0, 1, 3}) {
    SimulatedDeviceParams params = without_friction();
    params.force_delay = delay;
    stylus::DevicePreset preset = ideal();
    preset.capability.stylus_weight_n = 0.0;
    Bench bench(preset, params);
    bench.period(placed_at(Pose()), {});
    const Wrench push{{2.0, 0.0, 0.0}, Vec3::Zero()};
    int waited = 0;
    bench.period(std::nullopt, push);
    while (!(bench.device.X_DS().p().x() > 0.0) && waited < 20) {
      bench.period(std::nullopt, push);
      ++waited;
    }
    EXPECT_EQ(waited, delay + 1) << delay;  // the period after the write is the first it can act in
  }
}

TEST(VirtualHapticDevice, LastWrenchActsUntilAnotherIsWritten) {
  stylus::DevicePreset preset = ideal();
  preset.capability.stylus_weight_n = 0.0;
  Bench bench(preset, without_friction());
  bench.period(placed_at(Pose()), {});
  bench.period(std::nullopt, {{0.1, 0.0, 0.0}, Vec3::Zero()});
  for (int i = 0; i < 101; ++i) bench.device.read(bench.time_s += kDt_s);
  EXPECT_NEAR(bench.device.v_D().x(), 0.1 / preset.apparent_mass_kg * 1000.0 * 0.1, 1e-6);
}

TEST(VirtualHapticDevice, DelaysReadings) {
  SimulatedDeviceParams params;
  params.reading_delay = 2;
  Bench bench(ideal(), params);
  DeviceHand hand = holding(Pose(), 0.0);
  hand.is_rigid = true;
  bench.period(hand, {});
  for (int i = 1; i < 20; ++i) {
    hand.X_DS = Pose::translation({static_cast<double>(i), 0.0, 0.0});
    hand.time_s = bench.time_s;
    const DeviceReading reading = bench.period(hand, {});
    if (i > 4) {
      EXPECT_EQ(reading.X_DS.p().x(), i - 3.0) << i;  // one for the hold after the read, two of delay
    }
  }
}

TEST(VirtualHapticDevice, QuantisesPositionsAndAnglesToEncoderCounts) {
  const stylus::DevicePreset preset = preset_of("omni");
  Bench bench(preset);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    DeviceHand hand = placed_at(Pose(rotation_from_vector({random.uniform(-1, 1), random.uniform(-1, 1), 0.2}),
                                     {random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50)}));
    hand.time_s = bench.time_s;
    bench.period(hand, {});
    const DeviceReading reading = bench.period(std::nullopt, {});
    for (const double x : reading.X_DS.p()) {
      EXPECT_NEAR(std::remainder(x, preset.encoder.count_mm), 0.0, 1e-9);
    }
    const Pose X_DS = bench.device.X_DS();
    EXPECT_LE((reading.X_DS.p() - X_DS.p()).cwiseAbs().maxCoeff(), 0.5 * preset.encoder.count_mm + 1e-9);
    EXPECT_LE(rotation_vector(reading.X_DS.R() * X_DS.R().transpose()).norm(),
              0.5 * std::sqrt(3.0) * preset.encoder.count_rad + 1e-9);
  }
}

TEST(VirtualHapticDevice, ReportsIdentityRotationWithoutAngleSensors) {
  Bench bench(preset_of("falcon"));
  bench.period(placed_at(Pose(rotation_from_vector({0.5, 0.5, 0.0}), {1.0, 2.0, 3.0})), {});
  const DeviceReading reading = bench.period(std::nullopt, {});
  EXPECT_EQ(reading.X_DS.R(), Mat3::Identity().eval());
  EXPECT_NEAR(reading.X_DS.p().x(), 1.0, 0.1);
}

TEST(VirtualHapticDevice, WithoutTorqueMotorsIgnoresTorque) {
  for (const char* name : {"omni", "premium"}) {
    const stylus::DevicePreset preset = preset_of(name);
    Bench bench(preset);
    bench.period(placed_at(Pose()), {});
    const Wrench twist{Vec3(0.0, 0.0, preset.capability.stylus_weight_n), {0.0, 0.0, 100.0}};
    for (int i = 0; i < 50; ++i) bench.period(DeviceHand{}, twist);
    const double turned = rotation_vector(bench.device.X_DS().R()).norm();
    EXPECT_EQ(turned > 0.1, preset.has_torque()) << name << " " << turned;
  }
}

TEST(VirtualHapticDevice, LimitsMotorsToTheirPeaks) {
  stylus::DevicePreset preset = ideal();
  preset.capability.stylus_weight_n = 0.0;
  for (const double wanted_n : {10.0, 37.5, 100.0, 15000.0}) {
    Bench bench(preset, without_friction());
    bench.period(placed_at(Pose()), {});
    for (int i = 0; i < 7; ++i) bench.period(std::nullopt, {{wanted_n, 0.0, 0.0}, Vec3::Zero()});
    const double force_n = std::min(wanted_n, preset.capability.peak_force_n);
    const double acted_s = (7 - 1 - 1) * kDt_s;  // the first read knew of none, and it acts a period late
    EXPECT_NEAR(bench.device.v_D().x(), force_n / preset.apparent_mass_kg * 1000.0 * acted_s, 1e-6) << wanted_n;
  }
}

TEST(VirtualHapticDevice, DryFrictionHoldsUntilItIsOvercome) {
  stylus::DevicePreset preset = preset_of("omni");
  preset.capability.stylus_weight_n = 0.0;
  preset.viscosity_ns_per_mm = 0.0;
  const auto pushed_mm = [&](double force_n) {
    Bench bench(preset);
    bench.period(placed_at(Pose()), {});
    for (int i = 0; i < 102; ++i) bench.period(DeviceHand{}, {{force_n, 0.0, 0.0}, Vec3::Zero()});
    return bench.device.X_DS().p().x();
  };
  EXPECT_EQ(pushed_mm(0.99 * preset.friction_n), 0.0);
  const double excess_n = 0.1;
  EXPECT_NEAR(pushed_mm(preset.friction_n + excess_n), 0.5 * excess_n / preset.apparent_mass_kg * 1000.0 * 0.01, 0.02);
}

TEST(VirtualHapticDevice, DryFrictionStopsAMotionByItsWork) {
  stylus::DevicePreset preset = preset_of("omni");
  preset.capability.stylus_weight_n = 0.0;
  preset.viscosity_ns_per_mm = 0.0;
  Bench bench(preset);
  DeviceHand hand = holding(Pose(), bench.time_s);
  hand.v_D = Vec3(200.0, 0.0, 0.0);
  hand.is_rigid = true;
  bench.period(hand, {});
  bench.period(hand, {});
  const double start_mm = bench.device.X_DS().p().x();
  bench.device.hold({});
  for (int i = 0; i < 500; ++i) bench.period(std::nullopt, {});
  const double speed = 200.0;  // m v^2 / 2 = F s
  const double way_mm = 0.5 * preset.apparent_mass_kg / 1000.0 * speed * speed / preset.friction_n;
  EXPECT_NEAR(bench.device.X_DS().p().x() - start_mm, way_mm, speed * kDt_s);  // at most the last step is lost
  EXPECT_EQ(bench.device.v_D().norm(), 0.0);
}

TEST(VirtualHapticDevice, ViscosityLimitsTheSpeed) {
  stylus::DevicePreset preset = ideal();
  preset.capability.stylus_weight_n = 0.0;
  preset.viscosity_ns_per_mm = 0.005;  // 0.5 N: 100 mm/s, reached with 20 ms
  preset.workspace_radius_mm = 1000.0;
  Bench bench(preset, without_friction());
  bench.period(placed_at(Pose()), {});
  for (int i = 0; i < 400; ++i) bench.period(std::nullopt, {{0.5, 0.0, 0.0}, Vec3::Zero()});
  EXPECT_NEAR(bench.device.v_D().x(), 100.0, 0.01);
}

TEST(VirtualHapticDevice, WorkspaceEndsInASoftWall) {
  const stylus::DevicePreset preset = preset_of("premium");
  Bench bench(preset);
  double farthest_mm = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double reach_mm = std::min(0.2 * i, 200.0);  // 80 mm beyond
    bench.period(holding(Pose::translation({reach_mm, 0.0, 0.0}), bench.time_s), {});
    farthest_mm = std::max(farthest_mm, bench.device.X_DS().p().norm());
  }
  // Balance of the hand's 0.6 N/mm over 80 mm and the wall's 5 N/mm.
  const double beyond_mm = 80.0 * 0.6 / (0.6 + SimulatedDeviceParams{}.wall_stiffness_n_per_mm);
  EXPECT_NEAR(bench.device.X_DS().p().norm() - preset.workspace_radius_mm, beyond_mm, 0.5);
  EXPECT_LT(farthest_mm - preset.workspace_radius_mm, 2.0 * beyond_mm);
}

TEST(VirtualHapticDevice, MotionIsIndependentOfTheServerRate) {
  const auto path = [](double dt_s) {
    Bench bench(ideal(), without_friction());
    DeviceHand hand = holding(Pose::translation({10.0, 0.0, 0.0}), bench.time_s);
    bench.device.hold(placed_at(Pose()));
    bench.device.hold(hand);
    for (double t = 0.0; t < 0.2 - 1e-9; t += dt_s) bench.device.read(bench.time_s += dt_s);
    return bench.device.X_DS().p().x();
  };
  const double fine = path(0.001);
  EXPECT_NEAR(path(0.004), fine, 1e-6);  // steps of 1 ms inside
  EXPECT_NEAR(path(0.02), fine, 1e-6);
  EXPECT_NEAR(path(0.00025), fine, 0.05);  // trapezoidal rule, steps of another length
}

TEST(VirtualHapticDevice, StaysFiniteForGapsAndAnyClock) {
  Bench bench(preset_of("inverse3"));
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    DeviceHand hand = holding(Pose::translation({random.uniform(-50, 50), 0.0, 0.0}), bench.time_s);
    hand.stiffness_n_per_mm = random.uniform() < 0.1 ? 1e6 : 0.6;
    const double roll = random.uniform();
    const double gap_s = roll < 0.1 ? 1e9 : roll < 0.2 ? -1.0 : roll < 0.3 ? 0.0 : random.uniform(0.0, 0.05);
    bench.period(hand, {{random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-8, 8)}, Vec3::Zero()}, gap_s);
    ASSERT_TRUE(bench.device.X_DS().is_finite()) << i;
    ASSERT_LT(bench.device.X_DS().p().norm(), 300.0) << i;
  }
  const DeviceReading reading = bench.device.read(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(reading.status, DeviceStatus::kRepeated);
  EXPECT_TRUE(reading.X_DS.is_finite());
}

TEST(VirtualHapticDevice, MarksAReadAtTheSameTimeAsRepeated) {
  Bench bench(preset_of("premium"));
  EXPECT_EQ(bench.device.read(bench.time_s + kDt_s).status, DeviceStatus::kFresh);
  EXPECT_EQ(bench.device.read(bench.time_s + kDt_s).status, DeviceStatus::kRepeated);
}

}  // namespace
}  // namespace trocar::devices
