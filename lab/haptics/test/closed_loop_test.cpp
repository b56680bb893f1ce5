// A device in closed loop with the tick: trocar bench stability and trocar bench contact run the whole matrix, here a
// few.
#include "lab/haptics/closed_loop.h"

#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "haptics/option_texts.h"
#include "haptics/test/layered_patient.h"
#include "lab/haptics/push_trial.h"
#include "lab/haptics/stability_trial.h"

namespace trocar::haptics {
namespace {

using testing::AllocationGuard;
using testing::layered_patient;
using testing::liver_way;
using testing::paper_tissues;
using testing::Slab;

stylus::DevicePreset device(const char* name) {
  auto preset = stylus::load_device_preset(data_dir() / "devices.toml", name);
  TROCAR_CHECK(preset.has_value());
  return *preset;
}

std::shared_ptr<const HapticScene> scene_for(const stylus::DevicePreset& preset, const std::vector<Slab>& slabs) {
  HapticOptions options;
  apply_device_preset(preset, options);
  auto scene = make_haptic_scene(layered_patient(slabs), paper_tissues(), {}, preset.capability, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

class RestInTheHand : public ::testing::TestWithParam<const char*> {};

TEST_P(RestInTheHand, IsReachedWithoutEnergyGrowth) {
  const stylus::DevicePreset preset = device(GetParam());
  const auto scene = scene_for(preset, liver_way());
  for (const Holder holder : {Holder::kHand, Holder::kGuidingHand}) {
    for (const double depth_mm : {0.5, 8.0, 12.5, 24.5, 50.0}) {
      SCOPED_TRACE(::testing::Message() << to_string(holder) << " " << depth_mm << " mm");
      StabilityTrial trial;
      trial.depth_mm = depth_mm;
      trial.seconds = 6.0;
      const StabilityOutcome outcome = run_stability_trial(scene, preset, holder, trial);
      EXPECT_TRUE(outcome.is_bounded()) << outcome.position_mm << " mm, " << outcome.force_n << " N";
      EXPECT_TRUE(outcome.is_passive()) << outcome.growth_mj << " mJ";
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Devices, RestInTheHand, ::testing::Values("premium", "omni", "omega6", "sigma7", "falcon"));

TEST(Rest, IsReachedByABareMassOnThePath) {
  const stylus::DevicePreset preset = device("omega6");
  const auto scene = scene_for(preset, liver_way());
  for (const Holder holder : {Holder::kBare45g, Holder::kBare150g}) {
    const StabilityOutcome outcome = run_stability_trial(scene, preset, holder, {50.0, 6.0});
    EXPECT_TRUE(outcome.is_stable()) << outcome.position_mm << " mm, " << outcome.growth_mj << " mJ";
  }
}

TEST(PassivityObserver, ExcludesWorkAgainstTheCompensatedWeight) {
  const stylus::DevicePreset preset = device("premium");
  ClosedLoop loop(scene_for(preset, liver_way()), preset, Holder::kBare150g);
  for (int i = 0; i < 10; ++i) loop.carry({0.0, 0.0, -40.0}, Vec3::UnitZ());
  loop.restart_observer();
  loop.stylus().v_P = Vec3(0.0, -100.0, 100.0);
  double risen_mm = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 before_P = loop.tip_P();
    loop.run(stylus::StylusHold{});
    risen_mm = std::max(risen_mm, (loop.tip_P() - before_P).norm());
  }
  EXPECT_GT(risen_mm, 0.05) << "it moves";
  EXPECT_GT(loop.wrench_P().force_n.norm(), 0.4) << "its weight is carried";
  EXPECT_LT(loop.observer().growth_mj(), 1e-9);
}

class RestOnThePath : public ::testing::TestWithParam<const char*> {};

TEST_P(RestOnThePath, IsReachedByABareMassOnADeviceWithTorque) {
  const stylus::DevicePreset preset = device(GetParam());
  ASSERT_TRUE(preset.has_torque());
  const auto scene = scene_for(preset, liver_way());
  for (const Holder holder : {Holder::kBare45g, Holder::kBare150g}) {
    const StabilityOutcome outcome = run_stability_trial(scene, preset, holder, {40.0, 6.0});
    EXPECT_TRUE(outcome.is_stable()) << outcome.force_n << " N, " << outcome.growth_mj << " mJ";
  }
}
INSTANTIATE_TEST_SUITE_P(Devices, RestOnThePath, ::testing::Values("premium", "sigma7", "delta6"));

TEST(ClosedSkin, YieldsToTheProxyAtAnyEncoderCount) {
  const auto presets = stylus::load_device_presets(data_dir() / "devices.toml");
  const auto table = anatomy::load_tissue_table(data_dir() / "tissues.toml");
  ASSERT_TRUE(presets && table);
  for (const stylus::DevicePreset& preset : *presets) {  // some tell a tip that lies just on the skin
    HapticOptions options;
    options.force_model = ForceModel::kProxy;
    apply_device_preset(preset, options);
    const auto scene = make_haptic_scene(layered_patient(liver_way()), *table, {}, preset.capability, options);
    ASSERT_TRUE(scene);
    PushTrial trial;
    trial.to_mm = 20.0;
    EXPECT_TRUE(judge_loss_of_resistance(run_push_trial(*scene, preset, trial), 0).has_given_way) << preset.name;
  }
}

TEST(StabilityTrial, DetectsATooStiffLoop) {
  stylus::DevicePreset preset = device("omega6");
  preset.coupling = {5.0, 0.0};  // what the device bears, and no damping: the delay feeds the spring
  const StabilityOutcome outcome =
      run_stability_trial(scene_for(preset, liver_way()), preset, Holder::kBare45g, {50.0, 3.0});
  EXPECT_FALSE(outcome.is_stable());
}

TEST(ClosedLoopWithStylus, NeverAllocates) {
  const stylus::DevicePreset preset = device("premium");
  ClosedLoop loop(scene_for(preset, liver_way()), preset, Holder::kHand);
  loop.carry({0, 0, -5}, Vec3::UnitZ());
  stylus::StylusHold hold = stylus::make_hand();
  std::size_t events = 0;
  for (int i = 0; i < 3000; ++i) {
    hold.X_PS = Pose::translation({0.0, 0.0, -155.0 + 0.01 * i});
    const AllocationGuard guard;
    loop.run(hold);
    events += guard.count();
  }
  EXPECT_EQ(events, 0u);
}

TEST(ClosedLoopWithStylus, DelaysTheWrenchByOneTick) {
  const stylus::DevicePreset preset = device("omega6");
  ClosedLoop loop(scene_for(preset, liver_way()), preset, Holder::kBare45g);
  loop.run({});  // nothing has been computed yet: falls
  const double falling = loop.stylus().v_P.y();
  EXPECT_NEAR(falling, 0.5 / 0.045e-3 * 1e-3, 1e-9);
  loop.run({});  // the lift of the first tick is on its way
  EXPECT_NEAR(loop.stylus().v_P.y(), 2.0 * falling, 1e-9);
  loop.run({});
  EXPECT_NEAR(loop.stylus().v_P.y(), 2.0 * falling, 1e-9);  // and carries now
}

TEST(BoneContact, IsTheCouplingInSeriesWithTheBone) {
  const stylus::DevicePreset preset = device("premium");
  PushTrial trial;
  trial.to_mm = 20.0;
  const auto samples = run_push_trial(scene_for(preset, {{0, testing::kFat}, {12, testing::kBone}}), preset, trial);
  const BoneContact contact = judge_bone_contact(samples, trial, 12.0, preset.capability.peak_force_n);
  // The coupling before a bone of 20 N/mm and more: at most its own stiffness.
  const double k_c = preset.coupling.stiffness_n_per_mm;
  EXPECT_GT(contact.slope_n_per_mm, 0.8 * k_c);
  EXPECT_LE(contact.slope_n_per_mm, 1.05 * k_c);
  // Hand and coupling share the way that the hand wants to go on: 8 mm of 0.6 N/mm and coupling on bone in series.
  const double stiff = 0.95 * k_c;
  EXPECT_NEAR(contact.steady_n, 8.0 * 0.6 * stiff / (0.6 + stiff), 0.3);
  EXPECT_LT(contact.overshoot, 0.2);
  EXPECT_FALSE(contact.is_limited);
}

TEST(LossOfResistance, OccursAtAPuncturedLayer) {
  const stylus::DevicePreset preset = device("omega6");
  PushTrial trial;
  trial.to_mm = 30.0;
  const auto samples = run_push_trial(scene_for(preset, {{0, testing::kFat}, {12, testing::kMuscle}}), preset, trial);
  const LossOfResistance muscle = judge_loss_of_resistance(samples, 1);
  ASSERT_TRUE(muscle.has_given_way);
  EXPECT_GT(muscle.peak_n, 2.5);  // the layer's, and friction
  EXPECT_GT(muscle.drop_n, 1.0);
  EXPECT_GT(muscle.jump_mm, 0.5);                                    // the hand was pressed back and follows
  EXPECT_FALSE(judge_loss_of_resistance(samples, 2).has_given_way);  // no liver here
}

}  // namespace
}  // namespace trocar::haptics
