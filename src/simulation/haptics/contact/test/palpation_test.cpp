#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptics/contact/contact.h"
#include "haptics/contact/test/flat_skin.h"

namespace trocar::testing {
namespace {

using LabelAt = std::function<std::uint8_t(const Vec3&)>;

std::shared_ptr<const haptics::HapticScene> finger_on(const LabelAt& label_at) {
  return make_face_scene(haptics::Tool::kFinger, label_at);
}
haptics::Palpation press(const LabelAt& label_at, double pressed_mm) {
  return haptics::press(*finger_on(label_at), Vec3::Zero(), Vec3::UnitZ(), pressed_mm);
}
haptics::Palpation palpate(const LabelAt& label_at, const Vec3& at_P = Vec3::Zero(),
                           double force_n = haptics::kPalpating_n) {
  return haptics::palpate(*finger_on(label_at), at_P, Vec3::UnitZ(), force_n);
}
haptics::Palpation over_bone(double depth_mm) {
  return palpate([depth_mm](const Vec3& p) { return p.z() < depth_mm ? kFat : kBone; });
}

TEST(Palpation, PressOnThickTissueIsHertzianContact) {
  constexpr double kRadius_mm = 8.0, kPress_mm = 4.0;
  const double modulus = 5e-3 / (1.0 - haptics::kPoisson * haptics::kPoisson);
  const double hertz_n = 4.0 / 3.0 * modulus * std::sqrt(kRadius_mm) * std::pow(kPress_mm, 1.5);
  // B9 is within 10 % of Hertz for linear tissue; tissue that stiffens and ends at 40 mm adds 1/(1 - p/L), 11 %.
  EXPECT_NEAR(press(all_fat, kPress_mm).force_n, 1.11 * hertz_n, 0.1 * hertz_n);
}

TEST(Palpation, ShallowerBoneFeelsHarder) {
  const haptics::Palpation none = palpate(all_fat);
  EXPECT_FALSE(none.bone_mm);
  double harder_n_per_mm = std::numeric_limits<double>::infinity();
  for (const double depth_mm : {7.0, 10.0, 15.0, 22.0, 30.0}) {
    const haptics::Palpation felt = over_bone(depth_mm);
    ASSERT_TRUE(felt.bone_mm) << depth_mm;
    EXPECT_NEAR(*felt.bone_mm, depth_mm - 0.5, 0.15) << "the border of the first voxel; a 4 mm step halved four times";
    EXPECT_LT(felt.stiffness_n_per_mm, harder_n_per_mm) << depth_mm;
    EXPECT_GT(felt.stiffness_n_per_mm, none.stiffness_n_per_mm) << depth_mm;
    harder_n_per_mm = felt.stiffness_n_per_mm;
  }
}

TEST(Palpation, IgnoresALayerWithoutThickness) {
  const auto with_muscle = [](double to_mm) {
    return palpate([to_mm](const Vec3& p) { return p.z() >= 10.0 && p.z() < to_mm ? kMuscle : kFat; });
  };
  EXPECT_DOUBLE_EQ(with_muscle(10.0).pressed_mm, palpate(all_fat).pressed_mm);
  EXPECT_LT(with_muscle(16.0).pressed_mm, palpate(all_fat).pressed_mm) << "muscle is stiffer than fat";
  EXPECT_LT(with_muscle(30.0).pressed_mm, with_muscle(16.0).pressed_mm);
}

TEST(Palpation, ForceAndHardnessRiseWithThePress) {
  double before_n = 0.0, slope_before = 0.0;
  for (const double pressed_mm : {1.0, 2.0, 4.0, 6.0, 8.0}) {
    const haptics::Palpation felt = press([](const Vec3& p) { return p.z() < 12.0 ? kFat : kBone; }, pressed_mm);
    EXPECT_GT(felt.force_n, before_n);
    EXPECT_GT(felt.stiffness_n_per_mm, slope_before);
    before_n = felt.force_n;
    slope_before = felt.stiffness_n_per_mm;
  }
  constexpr double kStep_mm = 0.01;
  const double slope =
      (press(all_fat, 4.0 + kStep_mm).force_n - press(all_fat, 4.0 - kStep_mm).force_n) / (2.0 * kStep_mm);
  EXPECT_NEAR(press(all_fat, 4.0).stiffness_n_per_mm, slope, 0.02 * slope);
}

TEST(Palpation, FindsTheIndentationOfAForce) {
  for (const double force_n : {0.5, 2.0, 5.0, 10.0}) {
    const haptics::Palpation felt = palpate(all_fat, Vec3::Zero(), force_n);
    EXPECT_NEAR(felt.force_n, force_n, 0.01 * felt.stiffness_n_per_mm);
    EXPECT_NEAR(press(all_fat, felt.pressed_mm).force_n, felt.force_n, 1e-12);
  }
}

TEST(Palpation, FindsTheGapBetweenTwoSpinousProcesses) {
  // Ridges of bone 7 mm below the skin, 12 mm wide, 16 mm apart.
  const auto spine = [](const Vec3& p) {
    const double along = std::abs(p.x());
    return p.z() >= 7.0 && p.z() < 30.0 && along > 8.0 && along < 20.0 ? kBone : kFat;
  };
  const haptics::Palpation gap = palpate(spine), process = palpate(spine, {14.0, 0.0, 0.0});
  EXPECT_FALSE(gap.bone_mm);
  ASSERT_TRUE(process.bone_mm);
  EXPECT_GT(process.stiffness_n_per_mm, 1.5 * gap.stiffness_n_per_mm);
  EXPECT_LT(process.pressed_mm, gap.pressed_mm);
}

TEST(Palpation, ALigamentIsNotAsHardAsBone) {
  anatomy::TissueTable tissues = soft_tissues();
  tissues.tissues[*tissues.find_tissue("liver")].young_kpa = 1e4;  // as a ligament: in tension along its fibres
  const auto below = [&](std::uint8_t label) {
    const auto layers = [label](const Vec3& p) { return p.z() < 8.0 ? kFat : label; };
    return haptics::palpate(*make_face_scene(haptics::Tool::kFinger, layers, {}, tissues), Vec3::Zero(), Vec3::UnitZ());
  };
  const haptics::Palpation ligament = below(kLiver), bone = below(kBone);
  EXPECT_FALSE(ligament.bone_mm);
  EXPECT_GT(bone.stiffness_n_per_mm, 1.3 * ligament.stiffness_n_per_mm);
  EXPECT_LT(ligament.pressed_mm, below(kMuscle).pressed_mm);
}

TEST(Palpation, IsEmptyWithoutAPressOrAPosition) {
  for (const double nothing : {0.0, -3.0, std::nan("")}) {
    EXPECT_EQ(press(all_fat, nothing).force_n, 0.0);
    EXPECT_EQ(palpate(all_fat, Vec3::Zero(), nothing).force_n, 0.0);
  }
  EXPECT_EQ(palpate(all_fat, {std::nan(""), 0.0, 0.0}).force_n, 0.0);
  EXPECT_EQ(haptics::palpate(*finger_on(all_fat), Vec3::Zero(), Vec3::Zero()).force_n, 0.0);
}

}  // namespace
}  // namespace trocar::testing
