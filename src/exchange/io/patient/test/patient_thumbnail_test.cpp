#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "core/testing/data_folder.h"
#include "io/patient/patient_extras.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

TEST(PatientThumbnail, IsAFileInThePatientFolder) {
  const TemporaryFolder folder;
  const std::string patient = folder.path().string();
  EXPECT_FALSE(find_thumbnail(patient));
  fs::create_directory(folder / kThumbnailFile);
  EXPECT_FALSE(find_thumbnail(patient)) << "a folder is no picture";
  fs::remove(folder / kThumbnailFile);
  std::ofstream(folder / kThumbnailFile) << "picture";
  EXPECT_EQ(find_thumbnail(patient), folder / kThumbnailFile);
}

TEST(PatientThumbnail, IsADataFileForAnEmbeddedPatient) {
  const trocar::testing::OwnDataFolder own;
  EXPECT_FALSE(find_thumbnail("nobody"));
  EXPECT_FALSE(find_thumbnail(""));
  const fs::path folder = data_dir() / "phantoms" / "thumbnails";
  fs::create_directories(folder);
  std::ofstream(folder / "nobody.png") << "picture";
  EXPECT_EQ(find_thumbnail("nobody"), folder / "nobody.png");
}

}  // namespace
}  // namespace trocar::io
