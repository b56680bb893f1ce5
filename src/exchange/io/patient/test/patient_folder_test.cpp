#include "io/patient/patient_folder.h"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <optional>

#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::oblique_geometry;
using testing::read_bytes;
using testing::write_bytes;

constexpr float kHalfUnit_mm = 0.005F;  // skin_distance.nrrd has hundredths of a mm

anatomy::VirtualPatient small_patient() {
  anatomy::VirtualPatient patient;
  patient.name = "A \"quoted\" name\nin two lines, é\x7f\t\\";
  patient.description = "small";
  patient.provenance = {"CT: made for a test", "labels = \"none\""};
  volume::GridGeometry g = oblique_geometry();
  patient.ct = volume::CtGrid(g);
  patient.labels = volume::LabelGrid(g);
  patient.skin_distance_mm = volume::FloatGrid(g);
  for (std::size_t n = 0; n < g.voxel_count(); ++n) {
    patient.ct.voxels[n] = static_cast<std::int16_t>(10 * static_cast<int>(n) - 1000);
    patient.labels.voxels[n] = n % 3 == 0 ? 7 : n % 3 == 1 ? 200 : 0;
    patient.skin_distance_mm.voxels[n] = 0.37F * static_cast<float>(n) - 20.0F;
  }
  patient.label_table.labels = {{7, "liver", "liver", {1, 2, 3}}, {200, "odd/name", "bone", {255, 254, 0}, true}};
  patient.repairs = {{"filled 1 hole (0.1 ml) in liver", "liver", Vec3(1.5, -2.25, 30.0)}, {"left \"out\"", "", {}}};
  patient.landmarks = {{"xiphoid", {1.5, -2.25, 1e3}}};
  patient.paths = {{"path 1", {{0, 0, 0}, {10, 20, 30}}}};
  patient.content_hash = anatomy::hash_patient(patient);
  return patient;
}

anatomy::NamedMesh tetrahedron(const std::string& name) {
  return {name, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5F}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}}};
}

class PatientFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status status = save_patient(patient_, {tetrahedron("odd/name"), tetrahedron("odd name")}, path_);
    ASSERT_TRUE(status) << status.error().text();
  }
  std::string load_error() {
    const auto loaded = load_patient(path_);
    return loaded ? "loaded" : loaded.error().text();
  }
  void replace_in_description(const std::string& from, const std::string& to) {
    std::string text = read_bytes(path_ / "patient.toml");
    ASSERT_NE(text.find(from), std::string::npos);
    write_bytes(path_ / "patient.toml", text.replace(text.find(from), from.size(), to));
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "patient";
  anatomy::VirtualPatient patient_ = small_patient();
};

TEST_F(PatientFolder, RoundTrips) {
  const auto loaded = load_patient(path_);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->name, patient_.name);
  EXPECT_EQ(loaded->description, patient_.description);
  EXPECT_EQ(loaded->provenance, patient_.provenance);
  EXPECT_EQ(loaded->ct.voxels, patient_.ct.voxels);
  EXPECT_EQ(loaded->labels.voxels, patient_.labels.voxels);
  EXPECT_EQ(loaded->content_hash, patient_.content_hash);
  EXPECT_TRUE(loaded->ct.geometry.matches(patient_.ct.geometry));
  for (std::size_t n = 0; n < patient_.ct.voxels.size(); ++n)
    EXPECT_NEAR(loaded->skin_distance_mm.voxels[n], patient_.skin_distance_mm.voxels[n], 1.01F * kHalfUnit_mm);
  ASSERT_EQ(loaded->label_table.labels.size(), 2U);
  EXPECT_EQ(loaded->label_table.labels[1].name, "odd/name");
  EXPECT_EQ(loaded->label_table.labels[1].tissue, "bone");
  EXPECT_EQ(loaded->label_table.labels[1].color, (image::Rgb{255, 254, 0}));
  EXPECT_FALSE(loaded->label_table.labels[0].is_derived);
  EXPECT_TRUE(loaded->label_table.labels[1].is_derived);
  ASSERT_EQ(loaded->repairs.size(), 2U);
  EXPECT_EQ(loaded->repairs[0].text, patient_.repairs[0].text);
  EXPECT_EQ(loaded->repairs[0].label, "liver");
  EXPECT_EQ(loaded->repairs[0].place_P, patient_.repairs[0].place_P);
  EXPECT_EQ(loaded->repairs[1].text, "left \"out\"");
  EXPECT_FALSE(loaded->repairs[1].place_P);
  ASSERT_EQ(loaded->landmarks.size(), 1U);
  EXPECT_EQ(loaded->landmarks[0].p_P, patient_.landmarks[0].p_P);
  ASSERT_EQ(loaded->paths.size(), 1U);
  EXPECT_EQ(loaded->paths[0].line_P.b, patient_.paths[0].line_P.b);
}

TEST_F(PatientFolder, KeepsMeshesWithNamesInvalidAsFileNames) {
  const auto meshes = load_patient_meshes(path_);
  ASSERT_TRUE(meshes) << meshes.error().text();
  ASSERT_EQ(meshes->size(), 2U);
  EXPECT_EQ((*meshes)[0].name, "odd/name");
  EXPECT_EQ((*meshes)[1].name, "odd name");
  EXPECT_EQ((*meshes)[1].mesh_P.triangles.size(), 4U);
}

TEST_F(PatientFolder, IsNeverOverwritten) {
  const Status again = save_patient(patient_, {}, path_);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().exit_status, 2);
  EXPECT_TRUE(load_patient(path_));
}

TEST_F(PatientFolder, RefusesANewerVersion) {
  replace_in_description("format_version = 2", "format_version = 3");
  EXPECT_NE(load_error().find("newer version"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, LoadsFormat1WithoutDerivedLabels) {
  replace_in_description("format_version = 2", "format_version = 1");
  replace_in_description("derived = true\n", "");
  const auto loaded = load_patient(path_);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_FALSE(loaded->label_table.labels[1].is_derived);
  EXPECT_EQ(loaded->content_hash, patient_.content_hash);
}

TEST_F(PatientFolder, RefusesAMalformedRepair) {
  replace_in_description("position = [1.5, ", "position = [");
  EXPECT_NE(load_error().find("three numbers"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, RefusesAMissingFile) {
  for (const char* name : {"ct.nrrd", "labels.nrrd", "skin_distance.nrrd", "landmarks.mrk.json", "paths.mrk.json"}) {
    const std::string bytes = read_bytes(path_ / name);
    std::filesystem::remove(path_ / name);
    EXPECT_NE(load_error().find(name), std::string::npos) << load_error();
    write_bytes(path_ / name, bytes);
  }
  std::filesystem::remove(path_ / "patient.toml");
  EXPECT_NE(load_error().find("not a patient folder"), std::string::npos);
  EXPECT_FALSE(load_patient(folder_ / "nowhere"));
}

TEST_F(PatientFolder, RefusesATruncatedVolume) {
  for (const char* name : {"ct.nrrd", "labels.nrrd", "skin_distance.nrrd"}) {
    const std::string bytes = read_bytes(path_ / name);
    write_bytes(path_ / name, bytes.substr(0, bytes.size() - bytes.size() / 5));
    EXPECT_NE(load_error().find(name), std::string::npos) << load_error();
    write_bytes(path_ / name, bytes);
  }
}

TEST_F(PatientFolder, RefusesMismatchedGrids) {
  volume::LabelGrid moved = patient_.labels;
  moved.geometry.origin_P.x() += 1.0;
  ASSERT_TRUE(write_image(moved, path_ / "labels.nrrd"));
  EXPECT_NE(load_error().find("the same grid"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, RefusesChangedVoxels) {
  volume::CtGrid changed = patient_.ct;
  ++changed.voxels[17];
  ASSERT_TRUE(write_image(changed, path_ / "ct.nrrd"));
  EXPECT_NE(load_error().find("changed after"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, RefusesALabelOutsideTheTable) {
  volume::LabelGrid changed = patient_.labels;
  changed.voxels[17] = 9;
  ASSERT_TRUE(write_image(changed, path_ / "labels.nrrd"));
  EXPECT_NE(load_error().find("value 9"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, RefusesTwoLabelsWithOneId) {
  replace_in_description("id = 200", "id = 7");
  EXPECT_NE(load_error().find("twice"), std::string::npos) << load_error();
}

TEST_F(PatientFolder, DoesNotReadMeshesFromElsewhere) {
  replace_in_description("meshes/odd_name.vtp", "../secret.vtp");
  EXPECT_FALSE(load_patient_meshes(path_));
}

TEST(PatientFolderFailure, LeavesNothingBehind) {
  TemporaryFolder folder;
  anatomy::VirtualPatient patient = small_patient();
  patient.landmarks.push_back({"lost", Vec3::Constant(std::nan(""))});  // found after the volumes are written
  EXPECT_FALSE(save_patient(patient, {}, folder / "patient"));
  EXPECT_TRUE(folder.is_empty());
}

TEST(PatientFolderFailure, LeavesNoPatientWhenKilled) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the child starts afresh: no threads are lost in a fork
  // The child runs this from the top: it has to find its parent's folder, not make one of its own.
  constexpr const char* kFolderName = "TROCAR_TEST_KILLED_IN";
  std::optional<TemporaryFolder> own;
  if (std::getenv(kFolderName) == nullptr) ::setenv(kFolderName, own.emplace().path().c_str(), 1);
  const std::filesystem::path folder = std::getenv(kFolderName);
  const anatomy::VirtualPatient patient = small_patient();
  const auto die_at_surfaces = [](std::string_view step, double) {
    if (step == "surfaces") std::raise(SIGKILL);
  };
  EXPECT_EXIT((void)save_patient(patient, {tetrahedron("liver")}, folder / "patient", die_at_surfaces),
              ::testing::KilledBySignal(SIGKILL), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "patient"));
  EXPECT_FALSE(std::filesystem::is_empty(folder));  // it had begun
  EXPECT_TRUE(save_patient(patient, {tetrahedron("liver")}, folder / "patient"));
  EXPECT_TRUE(load_patient(folder / "patient"));
  ::unsetenv(kFolderName);
}

TEST(PatientFolderFailure, RefusesAnInconsistentPatient) {
  TemporaryFolder folder;
  anatomy::VirtualPatient patient = small_patient();
  patient.labels.voxels[0] = 99;
  EXPECT_FALSE(save_patient(patient, {}, folder / "patient"));
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace trocar::io
