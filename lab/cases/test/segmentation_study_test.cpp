#include "lab/cases/segmentation_study.h"

#include <gtest/gtest.h>

#include <set>

#include "haptics/test/layered_patient.h"

namespace trocar::cases {
namespace {

using testing::kFat;
using testing::kLiver;
using testing::layered_patient;
using testing::liver_way;
using testing::paper_tissues;

constexpr std::uint8_t kCapsule = 2;  ///< Row of the liver's capsule in the layers of paper_tissues.

/// capsule_n: the force at which the liver's capsule gives way.
std::shared_ptr<const haptics::HapticScene> scene_of(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                                     double capsule_n = 1.5) {
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  anatomy::TissueTable tissues = paper_tissues();
  tissues.layers[kCapsule].puncture_force_n = capsule_n;
  auto scene = haptics::make_haptic_scene(std::move(patient), tissues, {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

/// Ways from different places of the skin to 35 mm, in the liver.
std::vector<PrescribedMotion> motions(std::size_t count) {
  std::vector<PrescribedMotion> made;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i) - 2.0;
    made.push_back(study_motion({{x, 0.0, 0.0}, {0.0, 1.0, 35.0}}, i, {}));
  }
  return made;
}

TEST(SegmentationStudy, FindsNoErrorBetweenIdenticalScenes) {
  const auto scene = scene_of(layered_patient(liver_way()));
  const auto same = scene_of(layered_patient(liver_way()));
  const auto errors = compare_forces(*scene, *same, motions(4));
  ASSERT_EQ(errors.size(), 4U);
  for (const PathError& error : errors) {
    EXPECT_EQ(error.rms_n, 0.0);
    EXPECT_EQ(error.max_n, 0.0);
    EXPECT_EQ(error.torque_max_nmm, 0.0);
    EXPECT_EQ(error.affected, 0);
    EXPECT_GT(error.full_rms_n, 0.1);  // there was something to be compared
    EXPECT_NEAR(error.ticks, error.line_P.length_mm() * 100.0, 2.0);
  }
  EXPECT_TRUE(worst_places(errors, paper_tissues()).empty());
}

std::shared_ptr<const anatomy::VirtualPatient> partly_of(const anatomy::VirtualPatient& full, Rest rest) {
  auto partly = partly_segmented(full, kPartlySegmented, rest);
  TROCAR_CHECK(partly.has_value());
  return std::make_shared<const anatomy::VirtualPatient>(std::move(*partly));
}

TEST(SegmentationStudy, DetectsAMissingLabel) {
  const auto full = layered_patient(liver_way());
  const auto errors = compare_forces(*scene_of(full), *scene_of(partly_of(*full, Rest::kUnlabelled)), motions(4));
  const StudyFigures figures = study_figures(errors);
  EXPECT_EQ(figures.paths, 4U);
  // The muscle's surface gives way at 2.5 N and is not there any more.
  EXPECT_GT(figures.mean_max_n, 1.5);
  EXPECT_GT(figures.mean_rms_n, 0.1);
  EXPECT_GT(figures.affected, 0.0);
  EXPECT_LT(figures.affected, 1.0);
  EXPECT_GE(figures.max_n, figures.mean_max_n);
  const auto places = worst_places(errors, paper_tissues());
  ASSERT_FALSE(places.empty());
  EXPECT_NE(places.front().place.find("muscle"), std::string::npos);
}

TEST(SegmentationStudy, FindsLayersOfDerivedTissues) {
  const auto full = layered_patient(liver_way());
  const auto errors = compare_forces(*scene_of(full), *scene_of(partly_of(*full, Rest::kFound)), motions(4));
  const double unlabelled_n =
      study_figures(compare_forces(*scene_of(full), *scene_of(partly_of(*full, Rest::kUnlabelled)), motions(4)))
          .mean_rms_n;
  for (const PathError& error : errors) {
    EXPECT_LT(error.rms_n, 0.2 * unlabelled_n);
    EXPECT_EQ(error.worst_apart.layer, haptics::kNoLayer);
  }
}

TEST(SegmentationStudy, ExcludesPuncturesCommonToBothScenes) {
  // A hundredth of a newton more: the capsule gives way a few ticks later.
  const auto patient = layered_patient(liver_way());
  const auto errors = compare_forces(*scene_of(patient), *scene_of(patient, 1.51), motions(4));
  for (const PathError& error : errors) {
    EXPECT_GT(error.max_n, 0.1);  // one has lost the capsule's resistance, the other has not
    EXPECT_LT(error.max_apart_n, 0.1 * error.max_n);
    EXPECT_EQ(error.worst.layer, haptics::kNoLayer);
    EXPECT_EQ(error.worst_apart.layer, haptics::kNoLayer);
  }
}

TEST(SegmentationStudy, CountsAPunctureAtAnotherDepth) {
  const auto patient = layered_patient(liver_way());
  for (const double capsule_n : {2.2, 0.8}) {
    for (const PathError& error : compare_forces(*scene_of(patient), *scene_of(patient, capsule_n), motions(4))) {
      EXPECT_GT(error.max_n, 0.5);
      EXPECT_EQ(error.max_apart_n, error.max_n);
      EXPECT_EQ(error.worst_apart.layer, kCapsule);
      EXPECT_EQ(error.worst_apart.depth_mm, error.worst.depth_mm);
    }
  }
}

TEST(SegmentationStudy, CountsALayerThatIsMissingInEither) {
  // Fat in place of the liver: its capsule is missing, the other layers give way at the same places.
  const auto with = scene_of(layered_patient({{0, kFat}, {20, kLiver}}));
  const auto without = scene_of(layered_patient({{0, kFat}}));
  for (const auto& [full, partly] : {std::pair(with, without), std::pair(without, with)}) {
    for (const PathError& error : compare_forces(*full, *partly, motions(4))) {
      EXPECT_GT(error.max_apart_n, 1.0);
      EXPECT_EQ(error.max_apart_n, error.max_n);
      EXPECT_EQ(error.worst_apart.layer, kCapsule);
      EXPECT_GT(error.worst_apart.depth_mm, 20.0);
      EXPECT_NEAR(error.worst_apart.time_s, 1.0 + error.worst_apart.depth_mm / 10.0, 2e-3);  // 10 mm at 10 mm/s before
    }
  }
}

/// The combined model, with another force at the border of fat and muscle in the CT.
std::shared_ptr<const haptics::HapticScene> border_scene(double border_n) {
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  options.force_model = haptics::ForceModel::kCombined;
  anatomy::TissueTable tissues = paper_tissues();
  for (std::size_t i = 0; i < tissues.transfer.knot_count; ++i) tissues.transfer.laws[i].normal_n *= border_n / 2.5;
  auto scene =
      haptics::make_haptic_scene(layered_patient({{0, kFat}, {15, testing::kMuscle}}), tissues, {}, {}, options);
  TROCAR_CHECK(scene.has_value());
  return *scene;
}

TEST(SegmentationStudy, TreatsACtBorderAsALayer) {
  const auto full = border_scene(2.5);
  for (const PathError& error : compare_forces(*full, *border_scene(2.51), motions(4))) {
    EXPECT_GT(error.max_n, 0.1);  // one has lost the border's resistance, the other has not
    EXPECT_LT(error.max_apart_n, 0.1 * error.max_n);
  }
  // Another place counts, and is named where the difference is largest just before it.
  for (const double border_n : {1.2, 2.2}) {
    for (const PathError& error : compare_forces(*full, *border_scene(border_n), motions(4))) {
      EXPECT_GT(error.max_apart_n, 0.5) << border_n;
      EXPECT_EQ(error.max_apart_n, error.max_n) << border_n;
      EXPECT_EQ(error.worst_apart.layer, border_n > 2.0 ? kBorder : haptics::kNoLayer);
    }
  }
}

TEST(SegmentationStudy, IsDeterministic) {
  const auto full = scene_of(layered_patient(liver_way()));
  const auto other = scene_of(layered_patient({{0, kFat}, {20, kLiver}}));
  const auto first = compare_forces(*full, *other, motions(5));
  const auto second = compare_forces(*full, *other, motions(5));
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].rms_n, second[i].rms_n);
  EXPECT_NE(first[0].rms_n, first[4].rms_n);
}

TEST(PartlySegmented, KeepsOnlyTheNamedTissues) {
  const auto full = layered_patient(liver_way());
  const auto partly = partly_of(*full, Rest::kUnlabelled);
  EXPECT_EQ(anatomy::find_label(*partly, {0.0, 0.0, 5.0}), nullptr);   // fat
  EXPECT_EQ(anatomy::find_label(*partly, {0.0, 0.0, 15.0}), nullptr);  // muscle
  ASSERT_NE(anatomy::find_label(*partly, {0.0, 0.0, 30.0}), nullptr);
  EXPECT_EQ(anatomy::find_label(*partly, {0.0, 0.0, 30.0})->name, "liver");
  EXPECT_EQ(partly->label_table.find("muscle"), nullptr);
  EXPECT_EQ(partly->skin_distance_mm.voxels, full->skin_distance_mm.voxels);
}

TEST(PartlySegmented, DerivesFatAndMuscleLikeABuild) {
  const auto full = layered_patient(liver_way());
  const auto partly = partly_of(*full, Rest::kFound);
  for (const double z : {5.0, 15.0, 30.0}) {
    ASSERT_NE(anatomy::find_label(*partly, {0.0, 0.0, z}), nullptr);
    EXPECT_EQ(anatomy::find_label(*partly, {0.0, 0.0, z})->name, anatomy::find_label(*full, {0.0, 0.0, z})->name);
  }
  EXPECT_TRUE(partly->label_table.find("muscle")->is_derived);
  EXPECT_FALSE(partly->label_table.find("liver")->is_derived);
}

TEST(SpreadChoice, SelectsUniqueItemsOverTheWholeRange) {
  for (const std::size_t available : {0UL, 1UL, 7UL, 1000UL, 1001UL}) {
    for (const std::size_t count : {1UL, 7UL, 100UL}) {
      const auto chosen = spread_choice(available, count, 3);
      const std::set<std::size_t> different(chosen.begin(), chosen.end());
      EXPECT_EQ(chosen.size(), std::min(available, count));
      EXPECT_EQ(different.size(), chosen.size());
      for (const std::size_t number : chosen) EXPECT_LT(number, available);
    }
  }
  EXPECT_NE(spread_choice(1000, 10, 1), spread_choice(1000, 10, 2));
  EXPECT_GE(spread_choice(1000, 10, 1).back(), 900U);
}

TEST(PrescribedMotion, RunsFromOutsideTheSkinToTheTargetWithDrift) {
  const auto scene = scene_of(layered_patient(liver_way()));
  PrescribedMotion motion;
  motion.line_P = {{1.0, 2.0, 0.0}, {1.0, 2.0, 40.0}};
  motion.drift_P = {0.5, 0.0, 0.0};
  motion.tilt_rad_P = {0.0, 0.01, 0.0};
  const auto tip_at = [&](int tick) { return input_at(motion, tick).tool.pose(); };
  constexpr double kRounding = 1e-9;
  EXPECT_TRUE(tip_at(0).p().isApprox(Vec3(1.0, 2.0, -10.0), kRounding));
  EXPECT_NEAR(angle_between_rad(tip_at(0).R().col(2), Vec3::UnitZ()), 0.0, kRounding);
  const int last = tick_count(motion);
  EXPECT_EQ(last, 5000);
  EXPECT_TRUE(tip_at(last).p().isApprox(Vec3(1.5, 2.0, 40.0), kRounding));
  EXPECT_NEAR(angle_between_rad(tip_at(last).R().col(2), Vec3::UnitZ()), 0.01, 1e-6);
}

}  // namespace
}  // namespace trocar::cases
