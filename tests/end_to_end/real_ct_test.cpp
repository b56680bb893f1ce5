// The whole line on real CTs, where the test data lies beside the checkout.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "attempt.h"
#include "core/testing/test_data.h"
#include "io/image/image_file.h"
#include "io/patient/label_sources.h"
#include "patient_builder/build_patient.h"

namespace trocar::testing {
namespace {
namespace fs = std::filesystem;

Result<cases::Case> case_of_files(const fs::path& ct_path, const std::vector<fs::path>& labels,
                                  const std::string& label_map) {
  TROCAR_TRY(const volume::CtGrid ct, io::read_ct(ct_path));
  TROCAR_TRY(auto sources, io::read_label_sources(labels, label_map));
  std::vector<std::string> warnings;
  TROCAR_TRY(anatomy::VirtualPatient patient,
             patient_builder::build_patient(ct, std::move(sources), {"real", {"test data"}}, warnings));
  return cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(patient)), {});
}

void expect_whole_line(const Result<cases::Case>& prepared) {
  ASSERT_TRUE(prepared.has_value()) << prepared.error().text();
  const Attempt expert = perform(*prepared, "expert");
  expect_three_peaks(expert);
  EXPECT_TRUE(expert.result.outcome.is_passed) << expert.result.outcome.fails.front();
  const Attempt novice = perform(*prepared, "novice");
  EXPECT_LT(novice.result.outcome.score, expert.result.outcome.score + 0.1);  // this one makes small errors
}

TEST(RealCt, TorsoWithoutLesionGivesAParenchymalBiopsy) {
  const fs::path data = test_data() / "ct-torso";
  if (!fs::exists(data)) GTEST_SKIP() << "no test data at " << data;
  const auto prepared =
      case_of_files(data / "example_ct.nii.gz", {data / "example_seg_fast_force_split.nii.gz"}, "totalsegmentator");
  expect_whole_line(prepared);
  EXPECT_TRUE(prepared && prepared->is_parenchymal);
}

TEST(RealCt, BuildsALiverWithTumoursFromDicomMasks) {
  const fs::path archive = test_data() / "ct-liver" / "3dircadb1.17_dicom_and_masks.tar.xz";
  if (!fs::exists(archive)) GTEST_SKIP() << "no test data at " << archive;
  const TemporaryFolder folder;
  const std::string unpack = fmt::format("tar -xJf '{}' -C '{}'", archive.string(), folder.path().string());
  if (std::system(unpack.c_str()) != 0) GTEST_SKIP() << "tar cannot unpack .xz here";
  expect_whole_line(case_of_files(folder.path() / "PATIENT_DICOM", {folder.path() / "MASKS_DICOM"}, ""));
}

}  // namespace
}  // namespace trocar::testing
