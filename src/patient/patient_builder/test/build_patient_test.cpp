#include "patient_builder/build_patient.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "anatomy/label_statistics.h"
#include "anatomy/testing/shipped_structures.h"
#include "core/testing/data_folder.h"
#include "patient_builder/test/make_torso.h"
#include "volume/sampling.h"
#include "volume/test/make_grids.h"

namespace trocar::patient_builder {
namespace {

const Vec3 kSpacingMm{3, 3, 4};

LabelSource source(std::string name, volume::LabelGrid mask) {
  return {name + ".nii.gz", std::move(mask), {{1, name}}};
}

LabelSource liver(const Vec3& spacing_mm = kSpacingMm) {
  return source("liver", Torso::mask(Torso::grid(spacing_mm), Torso::is_liver));
}

struct Built {
  Result<anatomy::VirtualPatient> patient;
  std::vector<std::string> warnings;
};

Built build(std::vector<LabelSource> sources, const Torso& torso = {}) {
  std::vector<std::string> warnings;
  auto patient = build_patient(torso.ct(Torso::grid(kSpacingMm)), std::move(sources), {"test", {"made"}}, warnings);
  return {std::move(patient), std::move(warnings)};
}

std::string name_at(const anatomy::VirtualPatient& patient, const Vec3& p_P) {
  const anatomy::Label* label = anatomy::find_label(patient, p_P);
  return label == nullptr ? "" : label->name;
}

bool has_warning(const Built& built, const std::string& text) {
  return std::any_of(built.warnings.begin(), built.warnings.end(),
                     [&](const std::string& warning) { return warning.find(text) != std::string::npos; });
}

TEST(BuildPatient, LayersFatMuscleAndLiverFromTheFlank) {
  const Built built = build({liver()});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  std::vector<std::string> crossed;
  for (double x = -160.0; x < -60.0; x += 0.5) {
    const std::string name = name_at(*built.patient, {x, -10.0, 0.0});
    if (crossed.empty() || crossed.back() != name) crossed.push_back(name);
  }
  // Between wall and liver the torso has visceral fat.
  EXPECT_EQ(crossed, (std::vector<std::string>{"", "fat", "muscle", "fat", "peritoneum", "liver"}));
}

TEST(BuildPatient, LabelsExactlyTheVoxelsOfTheBody) {
  const Built built = build({liver()});
  ASSERT_TRUE(built.patient);
  const anatomy::VirtualPatient& patient = *built.patient;
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n)
    ASSERT_EQ(patient.labels.voxels[n] != 0, patient.skin_distance_mm.voxels[n] < 0.0F) << n;
  const anatomy::KnownStructures known = trocar::testing::shipped_structures();
  for (const anatomy::Label& label : patient.label_table.labels)
    EXPECT_NE(known.find(label.name), nullptr) << label.name;
}

TEST(BuildPatient, LabelsInnerAirAsLungOrGas) {
  const Built built = build({liver()});
  ASSERT_TRUE(built.patient);
  EXPECT_EQ(name_at(*built.patient, {60.0, 20.0, 10.0}), "lung");
  EXPECT_EQ(name_at(*built.patient, {45.0, -45.0, 0.0}), "gas");
}

TEST(BuildPatient, MeasuresDistanceToTheSkinNotToTheScanEnds) {
  const Built built = build({liver()});
  ASSERT_TRUE(built.patient);
  const volume::GridGeometry& geometry = built.patient->ct.geometry;
  const auto distance = [&](const volume::Index3& ijk) { return built.patient->skin_distance_mm[ijk]; };
  const auto middle = [&](std::int64_t k) { return distance({geometry.size[0] / 2, geometry.size[1] / 2, k}); };
  // The trunk is a cylinder along z: the first slice is as deep as the middle one.
  EXPECT_NEAR(middle(0), middle(geometry.size[2] / 2), 1e-3);
  EXPECT_NEAR(middle(0), -Torso::kHalfDepthMm, kSpacingMm.x());
}

TEST(BuildPatient, PrefersTheMoreSpecificOfOverlappingMasks) {
  const auto ball = [](double radius_mm) {
    return [radius_mm](const Vec3& p_P) { return (p_P - Vec3(-50.0, -10.0, 0.0)).norm() < radius_mm; };
  };
  const volume::GridGeometry geometry = Torso::grid(kSpacingMm);
  LabelSource tumour = source("livertumor1", Torso::mask(geometry, ball(10.0)));
  LabelSource vein = source("portalvein", Torso::mask(geometry, ball(20.0)));
  for (const bool reversed : {false, true}) {
    std::vector<LabelSource> sources{liver(), vein, tumour};
    if (reversed) std::reverse(sources.begin(), sources.end());
    const Built built = build(std::move(sources));
    ASSERT_TRUE(built.patient);
    EXPECT_EQ(name_at(*built.patient, {-50.0, -10.0, 0.0}), "livertumor1");
    EXPECT_EQ(name_at(*built.patient, {-35.0, -10.0, 0.0}), "portalvein");
    EXPECT_EQ(name_at(*built.patient, {-25.0, -10.0, 0.0}), "liver");
  }
}

TEST(BuildPatient, NumbersLabelsInFileOrder) {
  LabelSource colon = source("colon", Torso::mask(Torso::grid(kSpacingMm), [](const Vec3& p_P) {
                               return (p_P - Vec3(80.0, -20.0, 0.0)).norm() < 15.0;
                             }));
  const Built built = build({colon, liver()});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(built.patient->label_table.find("colon")->id, 1);
  EXPECT_EQ(built.patient->label_table.find("liver")->id, 2);
  EXPECT_EQ(built.patient->label_table.find("liver")->tissue, "liver");
}

TEST(BuildPatient, ResamplesAMaskOnAnotherGrid) {
  // Turned by 90 degrees about z, other spacing, cut down to a box around the liver.
  volume::GridGeometry turned;
  turned.R_PV << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  turned.spacing_mm = {2, 2.5, 3};
  turned.size = {50, 40, 40};
  turned.origin_P = Vec3(-50.0, -10.0, 0.0) - turned.R_PV * Vec3(49.0, 48.75, 58.5);
  const auto is_ball = [](const Vec3& p_P) { return (p_P - Vec3(-50.0, -10.0, 0.0)).norm() < 35.0; };
  const Built built = build({source("liver", Torso::mask(turned, is_ball))});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  const anatomy::VirtualPatient& patient = *built.patient;
  for (const anatomy::LabelStatistics& statistics : anatomy::label_statistics(patient)) {
    if (statistics.id != patient.label_table.find("liver")->id) continue;
    EXPECT_NEAR(statistics.volume_ml, 4.0 / 3.0 * M_PI * 35.0 * 35.0 * 35.0 / 1000.0, 4.0);
    EXPECT_LT((statistics.centroid_P - Vec3(-50.0, -10.0, 0.0)).norm(), 1.0);
    EXPECT_NEAR(statistics.mean_hu, Torso::kLiver, 1.0);
  }
}

TEST(BuildPatient, DoesNotTreatABodyMaskAsAnOrgan) {
  LabelSource skin = source("skin", Torso::mask(Torso::grid(kSpacingMm), Torso::is_inside));
  const Built built = build({skin, liver()});
  ASSERT_TRUE(built.patient);
  EXPECT_EQ(built.patient->label_table.find("skin"), nullptr);
  EXPECT_FALSE(has_warning(built, "mask of the body"));
  EXPECT_EQ(name_at(*built.patient, {0.0, -105.0, 0.0}), "fat");
}

TEST(BuildPatient, KeepsTheLungInsideAHollowBodyMask) {
  LabelSource skin = source("skin", Torso::mask(Torso::grid(kSpacingMm), [](const Vec3& p_P) {
                              return Torso::radius(p_P) < 0.99 && !Torso().is_lung(p_P);
                            }));
  const Built built = build({skin, liver()});
  ASSERT_TRUE(built.patient);
  EXPECT_EQ(name_at(*built.patient, {60.0, 20.0, 0.0}), "lung");
  // Believed, and told: the rim that it leaves out is outside now.
  EXPECT_TRUE(has_warning(built, "the skin, from which depths are measured, follows the mask"));
  EXPECT_EQ(name_at(*built.patient, {0.0, -109.5, 0.0}), "");
}

TEST(BuildPatient, IsIndependentOfTheStorageOrder) {
  // Table and sheet, a lung that leaves the scan at both ends, a mask on its own finer grid.
  constexpr double kLength_mm = 48.0;  // short: 49 patients
  const volume::CtGrid ct = Torso().ct(Torso::grid({6, 5, 8}, kLength_mm));
  const LabelSource mask = source("liver", Torso::mask(Torso::grid({4, 5, 6}, kLength_mm), Torso::is_liver));
  const auto build_stored = [&](const auto& axis, const auto& is_turned) {
    LabelSource stored = mask;
    stored.labels = stored_in_order(mask.labels, axis, is_turned);
    std::vector<std::string> warnings;
    return *build_patient(stored_in_order(ct, axis, is_turned), {stored}, {"test", {"made"}}, warnings);
  };
  const anatomy::VirtualPatient axial = build_stored(std::array<std::size_t, 3>{0, 1, 2}, std::array<bool, 3>{});
  EXPECT_EQ(name_at(axial, {60, 20, -20}), "lung");  // the end of the lung's channel
  EXPECT_LT(volume::sample_linear(axial.skin_distance_mm, {60, 20, -20}), -20.0);
  volume::for_each_storage_order([&](const auto& axis, const auto& is_turned) {
    const anatomy::VirtualPatient patient = build_stored(axis, is_turned);
    EXPECT_EQ(name_at(patient, {60, 20, -20}), "lung") << axis[0] << axis[1] << axis[2];
    EXPECT_LT(volume::sample_linear(patient.skin_distance_mm, {60, 20, -20}), -20.0);
    ASSERT_TRUE(patient.ct.geometry.matches(axial.ct.geometry));
    EXPECT_EQ(patient.ct.voxels, axial.ct.voxels);
    EXPECT_EQ(patient.labels.voxels, axial.labels.voxels) << axis[0] << axis[1] << axis[2];
    EXPECT_EQ(patient.skin_distance_mm.voxels, axial.skin_distance_mm.voxels);
    EXPECT_EQ(patient.content_hash, axial.content_hash);
  });
}

TEST(BuildPatient, IgnoresAnImplausibleBodyMask) {
  LabelSource skin = source("skin", Torso::mask(Torso::grid(kSpacingMm), [](const Vec3& p_P) {
                              return Torso::radius(p_P) < 1.0 && Torso::radius(p_P) > 0.95;
                            }));
  const Built built = build({skin, liver()});
  ASSERT_TRUE(built.patient);
  EXPECT_EQ(name_at(*built.patient, {-50.0, -10.0, 0.0}), "liver");
}

TEST(BuildPatient, RefusesAnUnknownNameAndSuggestsTheNearest) {
  LabelSource wrong = liver();
  wrong.names = {{1, "livr"}};
  wrong.file = "seg.nii.gz";
  const Built built = build({wrong});
  ASSERT_FALSE(built.patient);
  const std::string text = built.patient.error().text();
  for (const char* part : {"livr", "seg.nii.gz", "liver", "label 1"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(BuildPatient, AValueWithoutANameIsRefused) {
  LabelSource wrong = liver();
  wrong.labels.voxels[0] = 9;
  const Built built = build({wrong});
  ASSERT_FALSE(built.patient);
  EXPECT_NE(built.patient.error().text().find("label values without a name: 9"), std::string::npos);
}

TEST(BuildPatient, EveryUnknownLabelOfEveryFileIsListed) {
  LabelSource first = liver();
  first.names = {{1, "my_roi"}, {2, "livr"}};
  first.labels.voxels[0] = 2;
  first.labels.voxels[1] = 7;
  LabelSource second = source("plan_2", volume::LabelGrid(Torso::grid(kSpacingMm), 1));
  const Built built = build({first, liver(), second});
  ASSERT_FALSE(built.patient);
  const std::string text = built.patient.error().text();
  for (const char* part : {"\"my_roi\" (label 1)", "\"livr\" (label 2, perhaps liver)", "\"plan_2\" (label 1)",
                           "without a name: 7", "plan_2.nii.gz", "ignore"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_EQ(text.find("thyroid"), std::string::npos) << text;
}

TEST(BuildPatient, IgnoredAndBackgroundLabelsAreLeftOut) {
  LabelSource organs = liver();
  organs.labels.voxels[0] = 2;
  organs.labels.voxels[1] = 3;
  organs.names = {{1, "liver"}, {2, "Clear Label"}, {3, std::string(kIgnoredStructure)}};
  const LabelSource background = source("background", volume::LabelGrid(Torso::grid(kSpacingMm), 1));
  const Built built = build({organs, background});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(name_at(*built.patient, {-50.0, -10.0, 0.0}), "liver");
  const anatomy::KnownStructures known = trocar::testing::shipped_structures();
  for (const anatomy::Label& label : built.patient->label_table.labels)
    EXPECT_NE(known.find(label.name), nullptr) << label.name;
}

TEST(BuildPatient, AStructureFoundFromHuMustBeKnown) {
  const trocar::testing::OwnDataFolder own;
  own.change(anatomy::kStructuresFile, "\"bone_other\", ", "");
  const Built built = build({liver()});
  ASSERT_FALSE(built.patient);
  EXPECT_NE(built.patient.error().what.find("\"bone_other\""), std::string::npos) << built.patient.error().text();
  own.remove(anatomy::kStructuresFile);
  const Built none = build({liver()});
  ASSERT_FALSE(none.patient);
  EXPECT_NE(none.patient.error().where.find("structures.toml"), std::string::npos) << none.patient.error().text();
}

TEST(BuildPatient, WarnsOfEmptyMasksUnlessAllAreEmpty) {
  const LabelSource empty = source("spleen", volume::LabelGrid(Torso::grid(kSpacingMm)));
  const Built built = build({liver(), empty});
  ASSERT_TRUE(built.patient);
  EXPECT_TRUE(has_warning(built, "spleen"));
  EXPECT_EQ(built.patient->label_table.find("spleen"), nullptr);
  const Built nothing = build({empty, source("kidney_left", volume::LabelGrid(Torso::grid(kSpacingMm)))});
  ASSERT_FALSE(nothing.patient);
  EXPECT_NE(nothing.patient.error().text().find("empty"), std::string::npos);
}

TEST(BuildPatient, RefusesASegmentationElsewhere) {
  LabelSource far = liver();
  far.labels.geometry.origin_P.x() += 2000.0;
  far.file = "other.nrrd";
  const Built built = build({far});
  ASSERT_FALSE(built.patient);
  EXPECT_NE(built.patient.error().text().find("other.nrrd"), std::string::npos);
  EXPECT_NE(built.patient.error().text().find("does not overlap"), std::string::npos);
}

TEST(BuildPatient, AcceptsAPartialSegmentationAndReportsItsShare) {
  volume::GridGeometry half = Torso::grid(kSpacingMm);
  half.size[2] /= 2;
  const volume::LabelGrid mask = Torso::mask(half, Torso::is_liver);
  const Built built = build({source("liver", mask)});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(name_at(*built.patient, {-50.0, -10.0, -30.0}), "liver");
  EXPECT_NE(name_at(*built.patient, {-50.0, -10.0, 30.0}), "liver");
  EXPECT_TRUE(has_warning(built, "covers 50 % of the CT; beyond it, structures have no label: liver.nii.gz"));
  // A segmentation object is as small as its structures: nothing is missing beyond it.
  LabelSource object = source("liver", mask);
  object.is_described = true;
  EXPECT_FALSE(has_warning(build({object}), "% of the CT"));
  EXPECT_FALSE(has_warning(build({liver()}), "% of the CT"));
}

TEST(BuildPatient, MergesLabelsOfOneNameWithAWarning) {
  const auto is_left_half = [](const Vec3& p_P) { return Torso::is_liver(p_P) && p_P.x() > -50.0; };
  LabelSource both = liver();
  for (std::size_t n = 0; n < both.labels.voxels.size(); ++n)
    if (both.labels.voxels[n] != 0 && is_left_half(both.labels.geometry.centre_mm(both.labels.geometry.index_of(n))))
      both.labels.voxels[n] = 7;
  both.names = {{1, "liver"}, {7, "Liver"}};
  const Built built = build({both});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(built.patient->labels.voxels, build({liver()}).patient->labels.voxels);
  EXPECT_TRUE(has_warning(
      built,
      "2 labels are named \"liver\" and become one structure: label 1 of liver.nii.gz, label 7 of liver.nii.gz"));
  // In two files, and not for labels that do not occur.
  EXPECT_TRUE(has_warning(build({liver(), liver()}), "2 labels are named"));
  LabelSource unused = liver();
  unused.names.emplace_back(9, "liver");
  EXPECT_FALSE(has_warning(build({unused}), "labels are named"));
}

TEST(BuildPatient, GivesOverlapsToTheSmallerStructureWithAWarning) {
  // A pancreas of the liver's priority that covers a corner of it.
  const LabelSource pancreas = source("pancreas", Torso::mask(Torso::grid(kSpacingMm), [](const Vec3& p_P) {
                                        return (p_P - Vec3(-30.0, -10.0, p_P.z())).norm() < 25.0;
                                      }));
  const Built built = build({liver(), pancreas});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(name_at(*built.patient, {-35.0, -10.0, 0.0}), "pancreas");
  EXPECT_TRUE(has_warning(built, "ml of pancreas and liver (now pancreas)"));
  const Built other = build({pancreas, liver()});
  EXPECT_EQ(name_at(*other.patient, {-35.0, -10.0, 0.0}), "pancreas");
  EXPECT_TRUE(has_warning(other, "ml of pancreas and liver (now pancreas)"));
  // Priority counts before size: a lesion as large as its liver.
  const LabelSource lesion = source("liver_tumor", liver().labels);
  EXPECT_EQ(name_at(*build({lesion, liver()}).patient, {-50.0, -10.0, 0.0}), "liver_tumor");
  EXPECT_FALSE(has_warning(build({liver()}), "overlapping"));
}

TEST(BuildPatient, SkipsRegionsOfSeveralStructuresWithAWarning) {
  const Built built =
      build({liver(), source("abdominal_cavity", Torso::mask(Torso::grid(kSpacingMm), Torso::is_inside))});
  ASSERT_TRUE(built.patient) << built.patient.error().text();
  EXPECT_EQ(name_at(*built.patient, {-50.0, -10.0, 0.0}), "liver");
  EXPECT_TRUE(has_warning(built, "regions that hold several structures were left out: abdominal_cavity"));
}

TEST(BuildPatient, NamesStructuresCutByTheScan) {
  const Built built = build({liver()});  // a cylinder through the whole scan
  ASSERT_TRUE(built.patient);
  EXPECT_TRUE(has_warning(built, "cut off by the border of the CT: liver"));
}

TEST(BuildPatient, ACtWithoutABodyIsRefused) {
  std::vector<std::string> warnings;
  const auto patient = build_patient(volume::CtGrid(Torso::grid(kSpacingMm), -1000), {liver()}, {"air", {}}, warnings);
  ASSERT_FALSE(patient);
  EXPECT_NE(patient.error().text().find("too little fat and soft tissue"), std::string::npos);
}

TEST(BuildPatient, GivesNoiseIslandsTheSurroundingTissue) {
  // Single voxels of muscle HU in the subcutaneous fat and the other way round.
  const volume::GridGeometry geometry = Torso::grid(kSpacingMm);
  volume::CtGrid ct = Torso().ct(geometry);
  std::vector<Vec3> in_fat;
  std::vector<Vec3> in_muscle;
  for (double z = -40.0; z < 41.0; z += 20.0) {
    in_fat.emplace_back(-138.0, -10.0, z);
    in_muscle.emplace_back(-110.0, -10.0, z);
  }
  const auto set = [&](const Vec3& p_P, std::int16_t hu) {
    const Vec3 index = geometry.to_index(p_P);
    ct[{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())}] = hu;
  };
  for (const Vec3& p_P : in_fat) set(p_P, Torso::kMuscle);
  for (const Vec3& p_P : in_muscle) set(p_P, Torso::kFat);
  std::vector<std::string> warnings;
  const auto patient = build_patient(ct, {liver()}, {"noise", {}}, warnings);
  ASSERT_TRUE(patient);
  for (const Vec3& p_P : in_fat) EXPECT_EQ(name_at(*patient, p_P), "fat");
  for (const Vec3& p_P : in_muscle) EXPECT_EQ(name_at(*patient, p_P), "muscle");
}

}  // namespace
}  // namespace trocar::patient_builder
