#include "case_builder/checks.h"

#include <gtest/gtest.h>

#include "case_builder/case_draft.h"
#include "case_builder/case_edits.h"
#include "case_builder/test/made_draft.h"

namespace trocar::case_builder {
namespace {

using namespace testing;

std::vector<CaseCheck> checks_of(const CaseDraft& draft) {
  DraftPatient patients;
  return check_draft(draft, *patients.of(draft), shipped_needle(), shipped_tissues());
}

/// The check of that level which has the words in it; nullptr: none.
const CaseCheck* find(const std::vector<CaseCheck>& checks, CheckLevel level, const std::string& words) {
  for (const CaseCheck& check : checks)
    if (check.level == level && check.text.find(words) != std::string::npos) return &check;
  return nullptr;
}

CaseDraft valid_draft() {
  return *set_expert_path(made_draft(), good_path(shipped_needle()));
}

TEST(Checks, SoundDraftHasNoError) {
  const auto checks = checks_of(valid_draft());
  for (const CaseCheck& check : checks) EXPECT_NE(check.level, CheckLevel::kError) << check.text;
  EXPECT_EQ(worst_level(checks, CaseStep::kPath), CheckLevel::kOk);
  EXPECT_NE(find(checks, CheckLevel::kOk, "the path is 6"), nullptr);
  EXPECT_NE(find(checks, CheckLevel::kOk, "the target is in lesion"), nullptr);
}

TEST(Checks, LocateLabelsOutsideTheBody) {
  CaseDraft draft = made_draft();
  auto imported = std::make_shared<ImportedPatient>(*draft.imported);
  volume::LabelGrid& labels = imported->patient.labels;
  std::size_t painted = 0;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (imported->patient.skin_distance_mm.voxels[n] < 5.0F || painted > 500) continue;
    labels.voxels[n] = 8;  // a gallbladder beside the patient
    ++painted;
  }
  draft.imported = imported;
  const auto checks = checks_of(draft);
  const CaseCheck* check = find(checks, CheckLevel::kError, "of gallbladder is outside the body");
  ASSERT_NE(check, nullptr);
  ASSERT_TRUE(check->where_P);
  EXPECT_GT(BoxPatient::skin_distance(*check->where_P), 0.0);
}

TEST(Checks, ImplausibleVolumeIsAWarning) {
  BoxPatient box;
  box.lesion_radius_mm = 0.0;
  box.special = [](const Vec3& p) { return (p - Vec3(-40.0, 0.0, 0.0)).norm() < 3.0 ? "gallbladder" : ""; };
  EXPECT_NE(find(checks_of(made_draft(box)), CheckLevel::kWarning, "gallbladder has 0.1"), nullptr);
}

TEST(Checks, UnknownTissueIsAnError) {
  EXPECT_NE(find(checks_of(*set_label_tissue(made_draft(), 3, "jelly")), CheckLevel::kError,
                 "tissue \"jelly\" is not in the tissue table"),
            nullptr);
}

TEST(Checks, TargetInTheWrongPlaceIsAnError) {
  BoxPatient box;
  box.special = [](const Vec3& p) { return (p - Vec3(-50.0, 30.0, 0.0)).norm() < 8.0 ? "gallbladder" : ""; };
  const CaseDraft draft = made_draft(box);
  auto checks = checks_of(*set_target_point(draft, {-50.0, 30.0, 0.0}));
  EXPECT_NE(find(checks, CheckLevel::kError, "gallbladder (gallbladder), a risk structure"), nullptr);
  checks = checks_of(*set_target_point(draft, {-95.0, 0.0, 0.0}));
  EXPECT_NE(find(checks, CheckLevel::kError, "not in the liver"), nullptr);
  checks = checks_of(*set_target_point(draft, {-110.0, 0.0, 0.0}));
  EXPECT_NE(find(checks, CheckLevel::kError, "outside the body"), nullptr);
  EXPECT_EQ(find(checks_of(*set_target_point(draft, {-50.0, 0.0, 0.0})), CheckLevel::kError, "target"), nullptr);
}

TEST(Checks, TargetThatIsARiskIsAnError) {
  CaseDraft draft = *set_target_label(made_draft(), "lesion");
  draft = *set_risk(draft, {"", "lesion", 2.0, false, {}});
  EXPECT_NE(find(checks_of(draft), CheckLevel::kError, "is also a risk structure"), nullptr);
}

TEST(Checks, LocateFaultsOfThePath) {
  BoxPatient box;
  box.special = [](const Vec3& p) { return std::abs(p.x() + 85.0) < 3.0 && std::abs(p.z()) < 6.0 ? "bone" : ""; };
  CaseDraft draft = *set_expert_path(made_draft(box), good_path(shipped_needle()));
  draft = *set_entry_zone(draft, {-95.0, 40.0, 0.0}, 10.0);
  const auto checks = checks_of(draft);
  const CaseCheck* crossing = find(checks, CheckLevel::kError, "goes through rib (bone)");
  ASSERT_NE(crossing, nullptr);
  ASSERT_TRUE(crossing->where_P);
  EXPECT_NEAR(crossing->where_P->x(), -88.0, 1.5);
  EXPECT_NE(find(checks, CheckLevel::kError, "outside the entry zone"), nullptr);
  draft.task.max_path_mm = 30.0;
  EXPECT_NE(find(checks_of(draft), CheckLevel::kError, "the task allows 30 mm"), nullptr);
  EXPECT_EQ(worst_level(checks, CaseStep::kPath), CheckLevel::kError);
}

TEST(ForcePreview, HasTheLayersOfThePathInOrder) {
  const CaseDraft draft = valid_draft();
  DraftPatient patients;
  const auto preview = preview_forces(draft, patients.of(draft), shipped_needle(), shipped_tissues());
  ASSERT_TRUE(preview) << preview.error().text();
  std::vector<std::string> layers;
  for (const cases::CurveEvent& event : preview->events) layers.push_back(event.layer);
  EXPECT_EQ(layers, (std::vector<std::string>{"skin", "muscle", "liver_capsule"}));
  ASSERT_FALSE(preview->pieces.empty());
  EXPECT_EQ(preview->pieces.front().name, "skin");
  EXPECT_GT(preview->highest_n, 2.0);
  EXPECT_FALSE(preview_forces(made_draft(), patients.of(draft), shipped_needle(), shipped_tissues()));
}

TEST(DraftPatient, IsTheImportUntilLabelsAreEdited) {
  const CaseDraft draft = made_draft();
  DraftPatient patients;
  EXPECT_EQ(patients.of(draft).get(), &draft.imported->patient);
  const CaseDraft edited = *set_label_tissue(draft, 9, "muscle");
  EXPECT_EQ(patients.find(edited), nullptr);
  const auto patient = patients.of(edited);
  EXPECT_EQ(patient->label_table.find(std::uint8_t{9})->tissue, "muscle");
  EXPECT_EQ(patients.find(edited), patient);
  EXPECT_EQ(patients.of(edited), patient);
}

}  // namespace
}  // namespace trocar::case_builder
