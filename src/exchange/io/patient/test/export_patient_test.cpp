// What is exported is read back: the same HU at the same places, the same structures.
#include <algorithm>

#include "io/image/image_file.h"
#include "io/patient/build_from_files.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::numbered_grid;
using testing::oblique_geometry;

anatomy::VirtualPatient numbered_patient() {
  anatomy::VirtualPatient patient;
  const volume::GridGeometry g = oblique_geometry();
  patient.ct = numbered_grid<std::int16_t>(g);
  for (std::int16_t& hu : patient.ct.voxels) hu = static_cast<std::int16_t>(hu - 70);
  patient.labels = volume::LabelGrid(g);
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n)
    patient.labels.voxels[n] = static_cast<std::uint8_t>(n % 6);
  patient.skin_distance_mm = volume::FloatGrid(g, 5.0F);
  for (std::size_t n = 20; n < 90; ++n) patient.skin_distance_mm.voxels[n] = -5.0F;
  patient.label_table.labels = {{1, "liver", "liver", {1, 2, 3}},
                                {2, "kidney_left", "kidney", {1, 2, 3}},
                                {3, "rib_right_7", "bone", {1, 2, 3}},
                                {4, "muscle", "muscle", {1, 2, 3}, true},
                                {5, "peritoneum", "peritoneum", {1, 2, 3}, true},
                                {9, "spleen", "spleen", {1, 2, 3}}};  // has no voxel
  return patient;
}

/// Voxels of a structure in sources on the patient's grid.
std::vector<bool> voxels_named(const std::vector<patient_builder::LabelSource>& sources, const std::string& name,
                               const volume::GridGeometry& g) {
  std::vector<bool> inside(g.voxel_count(), false);
  for (const patient_builder::LabelSource& source : sources)
    for (const auto& [value, structure] : source.names) {
      if (structure != name) continue;
      for (std::size_t n = 0; n < source.labels.voxels.size(); ++n) {
        if (source.labels.voxels[n] != value) continue;
        const Vec3 index = g.to_index(source.labels.geometry.centre_mm(source.labels.geometry.index_of(n)));
        const volume::Index3 ijk{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())};
        EXPECT_LT((index - volume::to_vec3(ijk)).norm(), 1e-3);
        inside[g.offset(ijk)] = true;
      }
    }
  return inside;
}

void expect_same(const anatomy::VirtualPatient& patient, const fs::path& ct_path,
                 const std::vector<fs::path>& label_paths) {
  const auto scan = read_ct_scan(ct_path);
  ASSERT_TRUE(scan) << scan.error().text();
  testing::expect_same_place(scan->grid.geometry, patient.ct.geometry, 1e-3);
  EXPECT_EQ(scan->grid.voxels, patient.ct.voxels);
  std::vector<std::string> warnings;
  const dicom::CtReference reference{scan->grid.geometry, scan->series_uid, scan->frame_of_reference, scan->slices_P};
  const auto sources = read_label_sources(label_paths, "", reference, warnings);
  ASSERT_TRUE(sources) << sources.error().text();
  const volume::GridGeometry& g = patient.labels.geometry;
  for (const anatomy::Label& label : patient.label_table.labels) {
    const bool is_marked = label.is_derived && label.name != "muscle";
    const std::vector<bool> read = voxels_named(*sources, (is_marked ? "derived_" : "") + label.name, g);
    for (std::size_t n = 0; n < read.size(); ++n)
      EXPECT_EQ(read[n], label.name != "muscle" && patient.labels.voxels[n] == label.id) << label.name << n;
  }
  const std::vector<bool> skin = voxels_named(*sources, "skin", g);
  for (std::size_t n = 0; n < skin.size(); ++n) EXPECT_EQ(skin[n], n >= 20 && n < 90) << n;
}

TEST(ExportPatient, RoundTripsThroughNifti) {
  const TemporaryFolder folder;
  const anatomy::VirtualPatient patient = numbered_patient();
  const Status exported = export_patient(patient, ExportKind::kNifti, folder / "out");
  ASSERT_TRUE(exported) << exported.error().text();
  EXPECT_FALSE(fs::exists(folder / "out/segmentations/muscle.nii.gz")) << "a build finds it";
  EXPECT_FALSE(fs::exists(folder / "out/segmentations/spleen.nii.gz")) << "it has no voxel";
  expect_same(patient, folder / "out/ct.nii.gz", {folder / "out/segmentations"});
}

TEST(ExportPatient, RoundTripsThroughDicom) {
  const TemporaryFolder folder;
  const anatomy::VirtualPatient patient = numbered_patient();
  const Status exported = export_patient(patient, ExportKind::kDicom, folder / "out");
  ASSERT_TRUE(exported) << exported.error().text();
  expect_same(patient, folder / "out/ct", {folder / "out/segmentation.dcm", folder / "out/body.dcm"});
}

TEST(ExportPatient, AnExistingFolderIsKept) {
  const TemporaryFolder folder;
  testing::write_bytes(folder / "out", "mine");
  EXPECT_FALSE(export_patient(numbered_patient(), ExportKind::kNifti, folder / "out"));
  EXPECT_EQ(testing::read_bytes(folder / "out"), "mine");
}

}  // namespace
}  // namespace trocar::io
