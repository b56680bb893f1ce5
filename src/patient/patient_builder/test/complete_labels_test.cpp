#include "patient_builder/complete_labels.h"

#include <gtest/gtest.h>

#include "patient_builder/build_patient.h"
#include "patient_builder/test/make_torso.h"

namespace trocar::patient_builder {
namespace {

constexpr std::string_view kOnlyLiver[] = {"liver"};

bool is_kidney(const Vec3& p_P) {
  return (p_P - Vec3(-30.0, 50.0, p_P.z())).norm() < 18.0;
}
/// Lean tissue of the wall at the right flank, segmented as bowel: a label that HU do not give.
bool is_bowel(const Vec3& p_P) {
  return Torso::is_inside(p_P) && (p_P - Vec3(-118.0, -10.0, p_P.z())).norm() < 8.0;
}

/// A torso with a liver, and with two other structures that need not be segmented.
anatomy::VirtualPatient torso_patient(bool has_others, const DeriveChoice& derive = {}) {
  const volume::GridGeometry grid = Torso::grid({3, 3, 4});
  std::vector<LabelSource> sources{{"liver.nii.gz", Torso::mask(grid, Torso::is_liver), {{1, "liver"}}}};
  if (has_others) {
    sources.insert(sources.begin(), {"kidney.nii.gz", Torso::mask(grid, is_kidney), {{1, "kidney_right"}}});
    sources.push_back({"bowel.nii.gz", Torso::mask(grid, is_bowel), {{1, "small_bowel"}}});
  }
  BuildOptions options{"torso", {}};
  options.derive = derive;
  options.confirmed = {"shifted"};  // the two show in the labels only
  std::vector<std::string> warnings;
  auto patient = build_patient(Torso{}.ct(grid), std::move(sources), options, warnings);
  EXPECT_TRUE(patient) << (patient ? "" : patient.error().text());
  return patient.value_or(anatomy::VirtualPatient{});
}

std::vector<std::string> names_by_voxel(const anatomy::VirtualPatient& patient) {
  std::vector<std::string> names;
  for (const std::uint8_t id : patient.labels.voxels) {
    const anatomy::Label* label = patient.label_table.find(id);
    names.push_back(label != nullptr ? label->name : "");
  }
  return names;
}

TEST(WithSegmentedOnly, EqualsABuildFromTheSmallerSegmentation) {
  const anatomy::VirtualPatient full = torso_patient(true);
  const anatomy::VirtualPatient built = torso_patient(false);
  const auto partly = with_segmented_only(full, kOnlyLiver);
  ASSERT_TRUE(partly) << partly.error().text();
  EXPECT_NE(names_by_voxel(full), names_by_voxel(built));
  EXPECT_EQ(names_by_voxel(*partly), names_by_voxel(built));
  ASSERT_NE(partly->label_table.find("peritoneum"), nullptr);
  EXPECT_TRUE(partly->label_table.find("peritoneum")->is_derived);
  EXPECT_EQ(partly->skin_distance_mm.voxels, full.skin_distance_mm.voxels);
  EXPECT_EQ(partly->content_hash, anatomy::hash_patient(*partly));
}

TEST(WithSegmentedOnly, DerivesOnlyKindsOfTheFullPatient) {
  const anatomy::VirtualPatient full = torso_patient(true, {false, {}});
  const auto partly = with_segmented_only(full, kOnlyLiver);
  ASSERT_TRUE(partly) << partly.error().text();
  EXPECT_EQ(partly->label_table.find("peritoneum"), nullptr);
  EXPECT_NE(partly->label_table.find("muscle"), nullptr);
  EXPECT_EQ(names_by_voxel(*partly), names_by_voxel(torso_patient(false, {false, {}})));
}

TEST(WithSegmentedOnly, WithoutTissuesUsesTheCtOnly) {
  const auto partly = with_segmented_only(torso_patient(true), {});
  ASSERT_TRUE(partly) << partly.error().text();
  for (const anatomy::Label& label : partly->label_table.labels) EXPECT_TRUE(label.is_derived) << label.name;
  EXPECT_EQ(partly->label_table.find("liver"), nullptr);
  EXPECT_EQ(partly->label_table.find("peritoneum"), nullptr);  // no organ, no membrane around it
}

TEST(RemoveFoundLabels, KeepsSegmentedAndThinStructures) {
  anatomy::VirtualPatient patient = torso_patient(false);
  const std::vector<std::string> before = names_by_voxel(patient);
  remove_found_labels(patient);
  const std::vector<std::string> after = names_by_voxel(patient);
  std::size_t removed = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    const bool stays = before[n] == "liver" || before[n] == "peritoneum";
    ASSERT_EQ(after[n], stays ? before[n] : "");
    removed += !stays && !before[n].empty();
  }
  EXPECT_GT(removed, 1000U);
  EXPECT_EQ(patient.label_table.labels.size(), 2U);
  EXPECT_EQ(patient.content_hash, anatomy::hash_patient(patient));
}

TEST(DerivableIn, NamesEachKindOnceWithoutItsSide) {
  anatomy::LabelTable table;
  table.labels = {{1, "liver", "liver"},
                  {2, "pleural_recess_left", "lung", {}, true},
                  {3, "pleural_recess_right", "lung", {}, true},
                  {4, "bile_ducts", "bile_duct"}};
  const DeriveChoice choice = derivable_in(table);
  EXPECT_FALSE(choice.is_all);
  EXPECT_EQ(choice.names, (std::vector<std::string>{"pleural_recess", "bile_ducts"}));
  EXPECT_TRUE(derivable_in({}).names.empty());
}

}  // namespace
}  // namespace trocar::patient_builder
