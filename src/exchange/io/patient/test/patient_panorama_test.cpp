#include "io/patient/patient_panorama.h"

#include "anatomy/phantom/phantom.h"
#include "io/image/image_file.h"
#include "io/patient/patient_folder.h"
#include "io/sequence/transform_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::read_bytes;

/// A folder with the two files of a panorama.
void write_panorama(const fs::path& folder, const Pose& X_PU, const ImageFields& fields = {}) {
  volume::LabelGrid gray(volume::GridGeometry{{20, 20, 20}, Vec3::Ones(), Vec3(1, 2, 3), Mat3::Identity()}, 77);
  fs::create_directories(folder / "us");
  ASSERT_TRUE(write_image(gray, folder / kPanoramaFile, fields));
  ASSERT_TRUE(write_transform(X_PU, folder / kPanoramaTransformFile));
}

TEST(PatientPanorama, HasTheTransformAndTheDynamicRangeOfItsFiles) {
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

TEST(PatientPanorama, MissingFilesAreNamedWithTheCommandsThatMakeThem) {
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

TEST(PatientPanorama, StaysWithAPatientThatIsSavedAgain) {
  const TemporaryFolder folder;
  const fs::path first = folder.path() / "first", again = folder.path() / "again", other = folder.path() / "other";
  auto patient = anatomy::generate_phantom("layers-liver", 1);
  ASSERT_TRUE(patient);
  ASSERT_TRUE(save_patient(*patient, {}, first));
  write_panorama(first, Pose());
  ASSERT_TRUE(save_patient(*patient, {}, again, {}, {}, first));
  for (const char* file : {kPanoramaFile, kPanoramaTransformFile})
    EXPECT_EQ(read_bytes(again / file), read_bytes(first / file)) << file;
  EXPECT_TRUE(load_patient(again));
  ASSERT_TRUE(save_patient(*patient, {}, other, {}, {}, "abdomen"));
  EXPECT_FALSE(has_panorama({other.string()}));
}

}  // namespace
}  // namespace trocar::io
