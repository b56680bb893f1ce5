// The work of prescribed motions against known forces, and a few random motions of every model: trocar bench passivity
// runs thousands.
#include "lab/haptics/passivity_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "haptics/test/layered_patient.h"
#include "lab/haptics/random_motion.h"

namespace trocar::haptics {
namespace {

using testing::layered_patient;
using testing::liver_way;
using testing::paper_tissues;

constexpr double kAllowed_mj = 0.1;

HapticOptions options_for(ForceModel model, Tool tool = Tool::kNeedle) {
  HapticOptions options;
  options.tool = tool;
  options.force_model = model;
  options.has_weight_compensation = false;
  return options;
}

std::shared_ptr<const HapticScene> passive_scene(const HapticOptions& options,
                                                 const anatomy::TissueTable& tissues = paper_tissues(),
                                                 const stylus::DeviceCapability& device = {}) {
  auto scene = make_haptic_scene(layered_patient(liver_way()), tissues, {}, device, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

Pose over_skin() {
  return needle_pose({0.0, 0.0, -5.0}, Vec3::UnitZ());
}

TEST(PassivityTrial, StoresTheWorkOfTheLayerLaw) {
  anatomy::TissueTable tissues = paper_tissues();
  HapticOptions options = options_for(ForceModel::kInsertion);
  remove_losses(tissues, options);
  close_layers(tissues, ClosedLayers::kAll);
  const auto scene = passive_scene(options, tissues);
  ClosedMotion motion(over_skin(), 0.0);
  motion.go({0.0, 0.0, 7.0}, Vec3::Zero(), 20.0);  // 2 mm past the resting skin
  motion.close(20.0);
  const PassivityOutcome outcome = run_passivity_trial(*scene, {nullptr, &motion, 0.001});

  // Layer and coupling in series: their energies, by the integral of P1 and F^2/2k.
  const LoadingLaw& law = scene->layers[0].loading;
  const double k_n_per_mm = options.coupling.stiffness_n_per_mm;
  double low = 0.0, high = 2.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (x + prepuncture_force_n(x, 0.0, law) / k_n_per_mm < 2.0 ? low : high) = x;
  }
  const double x = low, dx = law.delta_x_mm;
  const double force_n = prepuncture_force_n(x, 0.0, law);
  const double layer_mj = law.stiffness_n_per_mm * x * x * (0.25 * x * x + x * dx + dx * dx) / (6.0 * dx * dx);
  const double expected_mj = layer_mj + 0.5 * force_n * force_n / k_n_per_mm;
  EXPECT_NEAR(outcome.peak_force_n, force_n, 1e-6);
  EXPECT_NEAR(outcome.stored_mj, expected_mj, 1e-3 * expected_mj);  // the trapezoidal rule at 1 kHz
  EXPECT_NEAR(outcome.end_mj, 0.0, 1e-9);                           // the same poses on both ways
  EXPECT_LT(outcome.most_mj, 1e-9);
}

TEST(PassivityTrial, DissipatesEnergyInAViscousLayer) {
  const auto scene = passive_scene(options_for(ForceModel::kInsertion));
  ClosedMotion motion(over_skin(), 0.0);
  motion.go({0.0, 0.0, 6.0}, Vec3::Zero(), 50.0);
  motion.close(50.0);
  const PassivityOutcome outcome = run_passivity_trial(*scene, {nullptr, &motion, 0.001});
  EXPECT_EQ(outcome.punctures, 0);
  EXPECT_LT(outcome.end_mj, -0.01);
  EXPECT_TRUE(outcome.is_free_at_end);
}

TEST(PassivityTrial, CountsGeneratedEnergy) {
  // A device without torque does not return what a rotation about S puts in, and a shift of S gets it back: energy.
  anatomy::TissueTable tissues = paper_tissues();
  HapticOptions options = options_for(ForceModel::kCombined);
  remove_losses(tissues, options);
  stylus::DeviceCapability device;
  device.peak_torque_nmm = 0.0;
  const auto scene = passive_scene(options, tissues, device);
  ClosedMotion before(over_skin(), 0.0);
  before.go({0.0, 0.0, 25.0}, Vec3::Zero(), 50.0);
  before.close(50.0);
  const Vec3 deep(0.0, 0.0, 20.0), aside(4.0, 0.0, 20.0), turned(0.0, 0.05, 0.0);
  double made_mj = 0.0;
  for (const double sign : {1.0, -1.0}) {  // one of the two directions of the same loop
    ClosedMotion motion(over_skin(), scene->needle.length_mm);
    motion.go(deep, Vec3::Zero(), 50.0);
    motion.go(deep, sign * turned, 50.0);
    motion.go(aside, sign * turned, 50.0);
    motion.go(aside, Vec3::Zero(), 50.0);
    motion.go(deep, Vec3::Zero(), 50.0);
    motion.close(50.0);
    made_mj = std::max(made_mj, run_passivity_trial(*scene, {&before, &motion, 0.001}).device_mj);
  }
  EXPECT_GT(made_mj, kAllowed_mj);
}

TEST(ClosedMotion, ReturnsToItsStartAndTurnsAboutItsPivot) {
  ClosedMotion motion(over_skin(), 150.0);
  motion.pass({3.0, 1.0, 2.0}, {0.1, 0.2, -0.3}, 20.0);
  motion.pass({-2.0, 4.0, 5.0}, {-0.2, 0.1, 0.4}, 40.0);
  motion.go({1.0, 0.0, 1.0}, {0.3, 0.0, 0.0}, 30.0);
  motion.wait(0.2);
  const double turned_s = motion.seconds();
  motion.close(50.0);
  const Pose X_turned = motion.at(turned_s), X_start = motion.start();
  const auto pivot = [](const Pose& X) -> Vec3 { return X.p() - 150.0 * X.R().col(2); };
  EXPECT_LT((pivot(X_turned) - pivot(X_start) - Vec3(1.0, 0.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((motion.at(turned_s - 0.1).p() - X_turned.p()).norm(), 1e-12);  // it waits
  for (const double end_s : {0.0, motion.seconds(), motion.seconds() + 1.0}) {
    EXPECT_LT((motion.at(end_s).p() - X_start.p()).norm(), 1e-12);
    EXPECT_LT((motion.at(end_s).R() - X_start.R()).norm(), 1e-12);
  }
  Vec3 before = X_start.p();  // no jump: at most 1.5 times 50 mm/s, and the swing of 150 mm
  for (double t = 0.0; t < motion.seconds(); t += 0.001) {
    EXPECT_LT((motion.at(t).p() - before).norm(), 0.3);
    before = motion.at(t).p();
  }
}

/// What moves, as in trocar bench passivity.
struct Moved {
  const char* name;
  Tool tool;
  ForceModel model;
};
void PrintTo(const Moved& moved, std::ostream* out) {
  *out << moved.name;
}
class RandomMotions : public ::testing::TestWithParam<Moved> {};

/// The energy of one motion that must not exceed the allowance (physics.md H8).
double error_of(const Moved& moved, MotionKind kind, int number) {
  Random random(mix64(static_cast<std::uint64_t>(number)));
  anatomy::TissueTable tissues = paper_tissues();
  tissues.layers[0].load_spread_mm = 2.0;  // the tissue below the skin gives way
  HapticOptions options = options_for(moved.model, moved.tool);
  if (is_elastic(kind)) remove_losses(tissues, options);
  if (kind == MotionKind::kElasticSkin) close_layers(tissues, ClosedLayers::kAll);
  if (kind == MotionKind::kElasticWall) close_layers(tissues, ClosedLayers::kAllButSkin);
  HapticScene scene = *passive_scene(options, tissues);
  if (is_elastic(kind)) scene.face.friction_mu = 0.0;
  const bool is_needle = moved.tool == Tool::kNeedle;
  MotionPlace place;
  const double angle_rad = random.uniform(0.0, is_needle ? 0.8 : 0.4);
  place.axis_P = {std::sin(angle_rad), 0.0, std::cos(angle_rad)};
  place.length_mm = scene.X_SN.p().norm();
  place.closed_mm = 5.0;
  place.deepest_mm = is_needle ? 40.0 : 5.0;
  place.tempo_mm_per_s = random.uniform(20.0, 200.0);
  place.widest_rad = is_needle ? 0.3 : 0.2;
  if (is_elastic(kind)) {
    place.tempo_mm_per_s = 60.0;
  } else if (is_needle) {
    place.closed_mm = find_skin_puncture_mm(scene, place.skin_P, place.axis_P, 20.0).value_or(5.0);
  }
  const auto before = motion_before(kind, place);
  const ClosedMotion motion = make_random_motion(kind, place, random);
  const PassivityOutcome outcome = run_passivity_trial(scene, {before ? &*before : nullptr, &motion, 0.001});
  EXPECT_TRUE(outcome.is_finite && outcome.is_free_at_start);
  return outcome.most_mj;
}

TEST_P(RandomMotions, GenerateNoEnergy) {
  constexpr int kOfEachKind = 8;
  std::vector<MotionKind> kinds;
  if (GetParam().tool == Tool::kNeedle) {
    kinds.assign(kNeedleKinds.begin(), kNeedleKinds.end());
    kinds.insert(kinds.end(), kElasticKinds.begin(), kElasticKinds.end());
  } else {  // without friction a face makes some energy: physics.md H8
    kinds.insert(kinds.end(), kFaceKinds.begin(), kFaceKinds.end());
  }
  for (const MotionKind kind : kinds)
    for (int number = 0; number < kOfEachKind; ++number)
      EXPECT_LE(error_of(GetParam(), kind, number), kAllowed_mj) << to_string(kind) << " " << number;
}

INSTANTIATE_TEST_SUITE_P(Moved, RandomMotions,
                         ::testing::Values(Moved{"insertion", Tool::kNeedle, ForceModel::kInsertion},
                                           Moved{"proxy", Tool::kNeedle, ForceModel::kProxy},
                                           Moved{"combined", Tool::kNeedle, ForceModel::kCombined},
                                           Moved{"probe", Tool::kTransducer, ForceModel::kInsertion},
                                           Moved{"finger", Tool::kFinger, ForceModel::kInsertion}),
                         [](const auto& moved) { return moved.param.name; });

}  // namespace
}  // namespace trocar::haptics
