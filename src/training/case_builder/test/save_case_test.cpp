#include <gtest/gtest.h>

#include <filesystem>

#include "case_builder/case_draft.h"
#include "case_builder/case_edits.h"
#include "case_builder/case_files.h"
#include "case_builder/test/made_draft.h"
#include "cases/prepare_case.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/test_data.h"
#include "io/image/image_file.h"
#include "io/patient/patient_folder.h"

namespace trocar::case_builder {
namespace {
namespace fs = std::filesystem;
using namespace testing;

CaseDraft full_draft() {
  CaseDraft draft = *set_expert_path(made_draft(), good_path(shipped_needle()));
  draft = *set_target_label(draft, "lesion");
  draft = *set_risk(draft, {"vessel", "", 4.0, false, {}});
  draft = *set_entry_zone(draft, good_path(shipped_needle()).a, 15.0);
  draft = *set_landmark(draft, "rib 9", {-80.0, 10.0, 5.0});
  draft = *rename_label(draft, 3, "liver of the box");
  draft.task.organ = "liver";
  return draft;
}

TEST(SaveCase, RoundTripsADraft) {
  const TemporaryFolder folder;
  DraftPatient patients;
  const CaseDraft draft = full_draft();
  const auto saved = save_case(draft, patients, {folder.path() / "case", false});
  ASSERT_TRUE(saved) << saved.error().text();

  const auto opened = import_case({(folder.path() / "case").string(), {}});
  ASSERT_TRUE(opened) << opened.error().text();
  CaseDraft same = *opened;
  same.imported = draft.imported;  // volumes are compared by their hash
  EXPECT_TRUE(is_same_draft(same, draft))
      << tasks::task_to_toml(same.task, tasks::Task{}) << tasks::task_to_toml(draft.task, tasks::Task{});
  EXPECT_EQ(opened->imported->patient.content_hash, anatomy::hash_patient(*patients.of(draft)));
}

TEST(SaveCase, SavedCaseOpensForAnAttemptWithItsTask) {
  const TemporaryFolder folder;
  DraftPatient patients;
  const CaseDraft draft = full_draft();
  ASSERT_TRUE(save_case(draft, patients, {folder.path() / "case", false}));
  auto patient = io::load_patient(folder.path() / "case");
  ASSERT_TRUE(patient) << patient.error().text();
  cases::CaseOptions options;
  options.task.clear();
  options.patient_folder = (folder.path() / "case").string();
  const auto the_case =
      cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(*patient)), options);
  ASSERT_TRUE(the_case) << the_case.error().text();
  EXPECT_EQ(the_case->plan.line_P.a, good_path(shipped_needle()).a);
  EXPECT_GT(the_case->plan.organ_path_mm, 10.0);
  EXPECT_EQ(the_case->task.target_label, "lesion");
  options.patient_folder = "abdomen";
  EXPECT_FALSE(cases::load_tables(options));
}

TEST(SaveCase, KeepsThePatientsOwnTissueTable) {
  const TemporaryFolder folder;
  DraftPatient patients;
  ASSERT_TRUE(save_case(full_draft(), patients, {folder.path() / "case", false}));
  EXPECT_FALSE(cases::has_own_tissues((folder.path() / "case").string()));
  anatomy::TissueTable table = trocar::testing::shipped_tissues("paper-a");
  ASSERT_TRUE(anatomy::apply_override(table, "path_constraint.m0=1.5"));
  const std::string text = table.to_toml();
  ASSERT_TRUE(write_file_atomically(folder.path() / "case" / cases::kOwnTissueFile, text));

  const auto opened = import_case({(folder.path() / "case").string(), {}});
  ASSERT_TRUE(opened) << opened.error().text();
  ASSERT_TRUE(save_case(*opened, patients, {folder.path() / "again", false}));
  const auto kept = read_file(folder.path() / "again" / cases::kOwnTissueFile);
  ASSERT_TRUE(kept) << kept.error().text();
  EXPECT_EQ(*kept, text);

  // Attempts use it, unless another table or a profile is named.
  cases::CaseOptions options;
  options.task.clear();
  options.patient_folder = (folder.path() / "again").string();
  const auto own = cases::load_tables(options);
  ASSERT_TRUE(own) << own.error().text();
  EXPECT_EQ(own->tissues.path_constraint.force_n, 1.5);
  EXPECT_EQ(own->tissues.origin, "the patient's own table");
  options.profile = "tented";
  EXPECT_FALSE(cases::load_tables(options)->tissues.path_constraint.is_given);
  options.profile.clear();
  options.tissue_file = (data_dir() / "tissues.toml").string();
  EXPECT_TRUE(cases::load_tables(options)->tissues.origin.empty());

  // A bad value is one line that names the file and the key.
  std::string bad = text;
  bad.replace(bad.find("1.5", bad.find("[path_constraint]")), 3, "1e3");
  ASSERT_TRUE(write_file_atomically(folder.path() / "again" / cases::kOwnTissueFile, bad));
  options.tissue_file.clear();
  const auto refused = cases::load_tables(options);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("tissues.toml"), std::string::npos) << refused.error().text();
  EXPECT_NE(refused.error().text().find("path_constraint.force_n"), std::string::npos) << refused.error().text();
  EXPECT_FALSE(import_case({(folder.path() / "again").string(), {}}));
}

TEST(SaveCase, OverwritesOnlyOnRequest) {
  const TemporaryFolder folder;
  DraftPatient patients;
  CaseDraft draft = full_draft();
  const fs::path target = folder.path() / "case";
  ASSERT_TRUE(save_case(draft, patients, {target, false}));
  const std::string before = *read_file(target / "task.toml");
  draft = *set_risk(draft, {"vessel", "", 6.0, false, {}});
  EXPECT_FALSE(save_case(draft, patients, {target, false}));
  EXPECT_EQ(*read_file(target / "task.toml"), before);
  const auto replaced = save_case(draft, patients, {target, true});
  ASSERT_TRUE(replaced) << replaced.error().text();
  EXPECT_NE(*read_file(target / "task.toml"), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);

  fs::create_directory(folder.path() / "mine");
  ASSERT_TRUE(write_file_atomically(folder.path() / "mine" / "letter.txt", "dear"));
  EXPECT_FALSE(save_case(draft, patients, {folder.path() / "mine", true}));
  EXPECT_TRUE(fs::exists(folder.path() / "mine" / "letter.txt"));
}

TEST(SaveCase, RefusesAnEmptyDraft) {
  DraftPatient patients;
  const TemporaryFolder folder;
  EXPECT_FALSE(save_case(CaseDraft{}, patients, {folder.path() / "case", false}));
  CaseDraft nameless = full_draft();
  nameless.name.clear();
  EXPECT_FALSE(save_case(nameless, patients, {folder.path() / "case", false}));
  EXPECT_TRUE(folder.is_empty());
}

TEST(ImportCase, BuildsACaseFromFiles) {
  const TemporaryFolder folder;
  anatomy::VirtualPatient patient = BoxPatient{}.make();
  for (std::size_t n = 0; n < patient.ct.voxels.size(); ++n)
    patient.ct.voxels[n] = patient.skin_distance_mm.voxels[n] >= 0.0F ? std::int16_t{-1000}
                           : patient.labels.voxels[n] == 3            ? std::int16_t{110}
                           : patient.labels.voxels[n] == 4            ? std::int16_t{60}
                                                                      : std::int16_t{-80};
  volume::LabelGrid labels = patient.labels;
  for (std::uint8_t& id : labels.voxels) id = id == 3 ? 1 : id == 4 ? 2 : 0;
  ASSERT_TRUE(io::write_image(patient.ct, folder.path() / "ct.nrrd"));
  ASSERT_TRUE(io::write_image(labels, folder.path() / "labels.nii.gz"));
  ASSERT_TRUE(write_file_atomically(folder.path() / "names.toml", "[labels]\n1 = \"liver\"\n2 = \"livertumor1\"\n"));
  std::vector<std::string> steps;
  const auto draft = import_case({(folder.path() / "ct.nrrd").string(),
                                  {(folder.path() / "labels.nii.gz").string()},
                                  (folder.path() / "names.toml").string()},
                                 [&](std::string_view step, double fraction) {
                                   steps.emplace_back(step);
                                   EXPECT_GE(fraction, 0.0);
                                   EXPECT_LE(fraction, 1.0);
                                 });
  ASSERT_TRUE(draft) << draft.error().text();
  EXPECT_EQ(draft->name, "ct");
  EXPECT_NE(draft->label_table.find(std::string_view("livertumor1")), nullptr);
  EXPECT_FALSE(draft->imported->meshes.empty());
  EXPECT_FALSE(steps.empty());
  const auto target_P = find_target_point(*draft);
  ASSERT_TRUE(target_P);
  EXPECT_LT((*target_P - BoxPatient{}.lesion_centre_P).norm(), 0.5);
}

TEST(ImportCase, StopsOnRequest) {
  std::stop_source stop;
  stop.request_stop();
  const auto draft = import_case({"layers-liver", {}}, {}, stop.get_token());
  ASSERT_FALSE(draft);
  EXPECT_EQ(draft.error().what, "stopped");
}

TEST(ImportCase, ReportsMissingInputInOneLine) {
  for (const ImportRequest& request :
       {ImportRequest{}, ImportRequest{"/nowhere/ct.nii.gz", {"/nowhere/labels.nii.gz"}},
        ImportRequest{"/nowhere/ct.nii.gz", {}}, ImportRequest{"abdomen", {"/nowhere/labels.nii.gz"}}}) {
    const auto draft = import_case(request);
    ASSERT_FALSE(draft);
    EXPECT_FALSE(draft.error().what.empty());
    EXPECT_FALSE(draft.error().advice.empty()) << draft.error().text();
    EXPECT_EQ(draft.error().text().find('\n'), std::string::npos);
  }
}

TEST(ImportCase, FailsInOneLineAndKeepsTheDraft) {
  const fs::path data = test_data() / "bad-input";
  if (!fs::exists(data)) GTEST_SKIP() << "no real data at " << data;
  const CaseDraft before = made_draft();
  CaseHistory history;
  history.begin(before);
  int refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    if (!entry.is_regular_file()) continue;
    const auto draft = import_case({entry.path().string(), {entry.path().string()}});
    if (draft) continue;
    ++refused;
    EXPECT_FALSE(draft.error().what.empty());
    EXPECT_EQ(draft.error().text().find('\n'), std::string::npos) << draft.error().text();
  }
  EXPECT_GT(refused, 5);
  EXPECT_TRUE(is_same_draft(history.draft(), before));
}

}  // namespace
}  // namespace trocar::case_builder
