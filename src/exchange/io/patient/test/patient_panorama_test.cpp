#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "io/sequence/transform_file.h"
#include "phantom/phantom.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

/// A folder with the two files of a panorama.
void write_panorama(const fs::path& folder, const Pose& X_PU, const ImageFields& fields = {}) {
  volume::LabelGrid gray(volume::GridGeometry{{20, 20, 20}, Vec3::Ones(), Vec3(1, 2, 3), Mat3::Identity()}, 77);
  fs::create_directories(folder / "us");
  ASSERT_TRUE(write_image(gray, folder / kPanoramaFile, fields));
  ASSERT_TRUE(write_transform(X_PU, folder / kPanoramaTransformFile));
}

TEST(PatientPanorama, ReadsTransformAndDynamicRangeFromItsFiles) {
  const TemporaryFolder folder;
  const Pose X_PU = Pose::translation(Vec3(5.0, -6.0, 7.0));
  write_panorama(folder.path(), X_PU, {{"trocar_dynamic_range_db", "48"}});
  const PatientSource source{folder.path().string()};
  EXPECT_TRUE(has_panorama(source));
  const auto panorama = load_panorama(source);
  ASSERT_TRUE(panorama) << panorama.error().text();
  EXPECT_LT(((*panorama)->X_PU.p() - X_PU.p()).norm(), 1e-9);
  EXPECT_DOUBLE_EQ((*panorama)->floor_db, ultrasound::kWhite_db - 48.0);
  EXPECT_EQ((*panorama)->geometry.size, (volume::Index3{20, 20, 20}));
}

TEST(PatientPanorama, NamesMissingFilesAndTheCommandsToMakeThem) {
  const TemporaryFolder folder;
  write_panorama(folder.path(), Pose());
  fs::remove(folder.path() / kPanoramaTransformFile);
  const PatientSource source{folder.path().string()};
  EXPECT_FALSE(has_panorama(source));
  const auto panorama = load_panorama(source);
  ASSERT_FALSE(panorama);
  for (const char* named : {"us_to_ct.tfm", "trocar ultrasound stitch", "trocar register"})
    EXPECT_NE(panorama.error().text().find(named), std::string::npos) << panorama.error().text();
  EXPECT_EQ(panorama.error().text().find("us/panorama.nrrd missing"), std::string::npos) << "it is there";
  EXPECT_FALSE(has_panorama({"abdomen"}));
  EXPECT_FALSE(load_panorama({"abdomen"}));
}

TEST(PatientPanorama, IsWrittenWithAPatient) {
  const TemporaryFolder folder;
  auto patient = phantom::generate_phantom("layers-liver", 1);
  ASSERT_TRUE(patient);
  const volume::LabelGrid gray(volume::GridGeometry{{20, 20, 20}, Vec3::Ones(), Vec3(1, 2, 3), Mat3::Identity()}, 77);
  const ImageFields fields{{"trocar_dynamic_range_db", "48"}};
  const Pose X_PU = Pose::translation(Vec3(5.0, -6.0, 7.0));
  RecordedUltrasound ultrasound{gray, fields, X_PU, {{"rib 9", Vec3(4.0, 5.0, 6.0)}}};
  const fs::path whole = folder.path() / "whole", unplaced = folder.path() / "unplaced";
  ASSERT_TRUE(save_patient(*patient, {}, whole, {}, {}, &ultrasound));
  const auto panorama = load_panorama({whole.string()});
  ASSERT_TRUE(panorama) << panorama.error().text();
  EXPECT_LT(((*panorama)->X_PU.p() - X_PU.p()).norm(), 1e-9);
  EXPECT_DOUBLE_EQ((*panorama)->floor_db, ultrasound::kWhite_db - 48.0);
  const auto landmarks = read_landmarks(whole / kPanoramaLandmarkFile);
  ASSERT_TRUE(landmarks) << landmarks.error().text();
  ASSERT_EQ(landmarks->size(), 1U);
  EXPECT_EQ(landmarks->front().name, "rib 9");
  EXPECT_LT((landmarks->front().p_P - Vec3(4.0, 5.0, 6.0)).norm(), 1e-6);
  EXPECT_TRUE(load_patient(whole));

  ultrasound.X_PU.reset();
  ASSERT_TRUE(save_patient(*patient, {}, unplaced, {}, {}, &ultrasound));
  EXPECT_FALSE(has_panorama({unplaced.string()}));
  EXPECT_TRUE(fs::exists(unplaced / kPanoramaFile)) << "work of the user";
}

}  // namespace
}  // namespace trocar::io
