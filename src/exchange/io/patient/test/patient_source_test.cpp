#include "io/patient/patient_cache.h"
#include "io/patient/patient_folder.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

/// A patient of two voxels' difference, by name.
std::string save_small_patient(const fs::path& folder, std::int16_t hu) {
  anatomy::VirtualPatient patient;
  patient.name = "small";
  const volume::GridGeometry g = testing::oblique_geometry();
  patient.ct = volume::CtGrid(g);
  patient.labels = volume::LabelGrid(g);
  patient.skin_distance_mm = volume::FloatGrid(g);
  patient.ct.voxels[0] = hu;
  const Status status = save_patient(patient, {}, folder);
  EXPECT_TRUE(status) << status.error().text();
  return anatomy::hash_patient(patient);
}

TEST(RecordedPatient, IsFoundAtItsPathAndBesideTheRecord) {
  const TemporaryFolder folder;
  const fs::path here = folder / "here";
  const fs::path sessions = folder / "sessions";
  const std::string hash = save_small_patient(here / "case", 40);
  save_small_patient(sessions / "other", 41);
  EXPECT_EQ(find_recorded_patient((here / "case").string(), hash, sessions).value(), (here / "case").string());

  // Moved away: named from the session's folder, by its name there, or found by its content.
  fs::rename(here / "case", sessions / "case");
  EXPECT_EQ(find_recorded_patient("case", hash, sessions).value(), (sessions / "case").string());
  EXPECT_EQ(find_recorded_patient("../sessions/case", hash, sessions).value(), (sessions / "case").string());
  EXPECT_EQ(find_recorded_patient((here / "case").string(), hash, sessions).value(), (sessions / "case").string());
  fs::rename(sessions / "case", sessions / "renamed");
  EXPECT_EQ(find_recorded_patient((here / "case").string(), hash, sessions).value(), (sessions / "renamed").string());

  fs::remove_all(sessions / "renamed");
  const auto gone = find_recorded_patient((here / "case").string(), hash, sessions);
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().text().find("--patient"), std::string::npos);
}

TEST(RecordedPatient, PrefersTheRecordedPatientOverAnotherAtItsPath) {
  const TemporaryFolder folder;
  save_small_patient(folder / "case", 41);
  EXPECT_EQ(find_recorded_patient((folder / "case").string(), "another hash", folder.path()).value(),
            (folder / "case").string());
  EXPECT_EQ(find_recorded_patient("abdomen", "another hash", folder.path()).value(), "abdomen");
}

TEST(RecordedPatient, AFolderIsRecordedByItsAbsolutePath) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::create_directories(folder / "case");
  fs::current_path(folder.path());
  EXPECT_EQ(absolute_source("case"), (fs::current_path() / "case").string());
  EXPECT_EQ(absolute_source("./case"), (fs::current_path() / "case").string());
  EXPECT_EQ(absolute_source("abdomen"), "abdomen");
  fs::current_path(before);
}

}  // namespace
}  // namespace trocar::io
