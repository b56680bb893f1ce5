// The derived structures of a real CT: thickness, place and order, against published values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "anatomy/label_statistics.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/test_data.h"
#include "io/patient/build_from_files.h"
#include "patient_builder/build_patient.h"
#include "patient_builder/plausibility/judge_anatomy.h"

namespace trocar::io {
namespace {

class TorsoWithDerivedStructures : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path data = trocar::testing::test_data() / "ct-torso";
    if (!std::filesystem::exists(data)) return;
    PatientFiles files;
    files.ct = data / "example_ct.nii.gz";
    files.labels = {data / "example_seg_fast_force_split.nii.gz"};
    files.name = "torso";
    auto built = build_from_files(files, warnings_);
    ASSERT_TRUE(built) << built.error().text();
    patient_ = *std::move(built);
    for (const anatomy::LabelStatistics& s : anatomy::label_statistics(patient_))
      if (const anatomy::Label* label = patient_.label_table.find(s.id)) volume_ml_[label->name] = s.volume_ml;
  }
  void SetUp() override {
    if (patient_.labels.empty()) GTEST_SKIP() << "no real data at " << trocar::testing::test_data();
  }

  static std::string name_at(const Vec3& p_P) {
    const anatomy::Label* label = anatomy::find_label(patient_, p_P);
    return label != nullptr ? label->name : "";
  }

  inline static anatomy::VirtualPatient patient_;
  inline static std::vector<std::string> warnings_;
  inline static std::map<std::string, double> volume_ml_;
};

TEST_F(TorsoWithDerivedStructures, HasEachOneOnce) {
  for (const char* name :
       {"dural_sac", "ligamentum_flavum", "epidural_fat", "interspinous_ligament", "supraspinous_ligament",
        "peritoneum", "pleural_recess_left", "pleural_recess_right", "neurovascular_bundle",
        "inferior_epigastric_zone_left", "inferior_epigastric_zone_right", "fat", "muscle"}) {
    const anatomy::Label* label = patient_.label_table.find(name);
    ASSERT_NE(label, nullptr) << name;
    EXPECT_TRUE(label->is_derived) << name;
  }
  EXPECT_FALSE(patient_.label_table.find("vertebrae_L3")->is_derived);
}

// Sac of 13 to 15 mm over some 30 cm: 40 to 55 ml with the cord. A flavum covers about 1 to 1.5 ml between two laminae.
TEST_F(TorsoWithDerivedStructures, HasPlausibleVolumes) {
  EXPECT_NEAR(volume_ml_["dural_sac"] + volume_ml_["spinal_cord"], 42.0, 3.0);
  EXPECT_LT(volume_ml_["spinal_cord"], 5.0);  // only above L2 in this scan
  EXPECT_GT(volume_ml_["ligamentum_flavum"], 3.0);
  EXPECT_LT(volume_ml_["ligamentum_flavum"], 12.0);
  const double left_ml = volume_ml_["inferior_epigastric_zone_left"],
               right_ml = volume_ml_["inferior_epigastric_zone_right"];
  EXPECT_GT(std::min(left_ml, right_ml), 0.6 * std::max(left_ml, right_ml));
}

/// From the back in the midline between L3 and L4, slightly upwards or downwards, some line passes all layers in order.
TEST_F(TorsoWithDerivedStructures, GivesTheLayersOfALumbarPuncture) {
  const anatomy::Label* l3 = patient_.label_table.find("vertebrae_L3");
  const anatomy::Label* l4 = patient_.label_table.find("vertebrae_L4");
  const volume::GridGeometry& g = patient_.labels.geometry;
  const auto statistics = anatomy::label_statistics(patient_);
  Vec3 middle = Vec3::Zero();
  for (const anatomy::LabelStatistics& s : statistics)
    if (s.id == l3->id || s.id == l4->id) middle += 0.5 * s.centroid_P;
  bool is_found = false;
  std::size_t in_muscle = 0;
  for (double z = -20.0; z <= 10.0; z += 3.0)
    for (double x = -6.0; x <= 6.0; x += 1.5) {
      std::vector<std::string> crossed;
      for (double y = middle.y() + 90.0; y > middle.y(); y -= 0.5) {
        const std::string name = name_at({middle.x() + x, y, middle.z() + z});
        const bool is_layer = name.ends_with("ligament") || name == "ligamentum_flavum" || name == "epidural_fat" ||
                              name == "dural_sac" || name.starts_with("vertebrae");
        in_muscle += !crossed.empty() && crossed.back() == "ligamentum_flavum" && name == "muscle" ? 1 : 0;
        if (is_layer && (crossed.empty() || crossed.back() != name)) crossed.push_back(name);
        if (name == "dural_sac") break;
      }
      is_found = is_found || crossed == std::vector<std::string>{"supraspinous_ligament", "interspinous_ligament",
                                                                 "ligamentum_flavum", "epidural_fat", "dural_sac"};
    }
  EXPECT_TRUE(is_found);
  EXPECT_EQ(in_muscle, 0U) << "there is none in the canal";
  EXPECT_EQ(g.spacing_mm, Vec3(3.0, 3.0, 3.0));
}

// One voxel of 3 mm, two where the lamina is oblique: the published 3.2 to 3.7 mm.
TEST_F(TorsoWithDerivedStructures, HasAFlavumOfThePublishedThickness) {
  const std::uint8_t flavum = patient_.label_table.find("ligamentum_flavum")->id;
  const volume::GridGeometry& g = patient_.labels.geometry;
  std::map<std::int64_t, int> lengths;
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t i = 0; i < g.size[0]; ++i) {
      std::int64_t length = 0;
      for (std::int64_t j = 0; j < g.size[1]; ++j) length += patient_.labels[{i, j, k}] == flavum ? 1 : 0;
      if (length > 0) ++lengths[length];
    }
  double sum = 0.0, count = 0.0;
  for (const auto& [length, columns] : lengths) {
    sum += static_cast<double>(length * columns);
    count += columns;
    EXPECT_LE(length, 3) << columns;
  }
  EXPECT_GE(3.0 * sum / count, 3.0);
  EXPECT_LE(3.0 * sum / count, 5.0);
}

TEST_F(TorsoWithDerivedStructures, FindsTheSacFromTheVertebraeAlone) {
  const std::filesystem::path data = trocar::testing::test_data() / "ct-torso";
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder.path() / "vertebrae.toml",
                                    "[labels]\n26 = \"vertebrae_S1\"\n27 = \"vertebrae_L5\"\n28 = \"vertebrae_L4\"\n"
                                    "29 = \"vertebrae_L3\"\n30 = \"vertebrae_L2\"\n31 = \"vertebrae_L1\"\n"
                                    "\"*\" = \"ignore\"\n"));
  PatientFiles files;
  files.ct = data / "example_ct.nii.gz";
  files.labels = {data / "example_seg_fast_force_split.nii.gz"};
  files.label_map = (folder.path() / "vertebrae.toml").string();
  files.name = "spine";
  std::vector<std::string> warnings;
  const auto built = build_from_files(files, warnings);
  ASSERT_TRUE(built) << built.error().text();
  const anatomy::Label* sac = built->label_table.find("dural_sac");
  const anatomy::Label* labelled = patient_.label_table.find("dural_sac");
  ASSERT_NE(sac, nullptr);
  // Most of it lies in the labelled one.
  double inside = 0.0, all = 0.0;
  for (std::size_t n = 0; n < built->labels.voxels.size(); ++n) {
    if (built->labels.voxels[n] != sac->id) continue;
    all += 1.0;
    inside += patient_.labels.voxels[n] == labelled->id ? 1.0 : 0.0;
  }
  EXPECT_GT(all, 500.0);
  EXPECT_GT(inside, 0.8 * all);
}

TEST_F(TorsoWithDerivedStructures, IsUnchangedByExport) {
  const TemporaryFolder folder;
  const Status exported = export_patient(patient_, ExportKind::kNifti, folder / "files");
  ASSERT_TRUE(exported) << exported.error().text();
  PatientFiles files;
  files.ct = folder / "files/ct.nii.gz";
  files.labels = {folder / "files/segmentations"};
  files.name = "again";
  std::vector<std::string> warnings;
  const auto again = build_from_files(files, warnings);
  ASSERT_TRUE(again) << again.error().text();
  for (const anatomy::LabelStatistics& s : anatomy::label_statistics(*again)) {
    const anatomy::Label* label = again->label_table.find(s.id);
    const anatomy::Label* before = patient_.label_table.find(label->name);
    ASSERT_NE(before, nullptr) << label->name;
    EXPECT_EQ(label->is_derived, before->is_derived) << label->name;
    if (label->name == "lung" || label->name == "soft_tissue") continue;  // found from HU, next to what is derived
    EXPECT_NEAR(s.volume_ml, volume_ml_[label->name], 0.02 * volume_ml_[label->name] + 0.05) << label->name;
  }
}

TEST_F(TorsoWithDerivedStructures, DetectsAnOrganMovedBy15Mm) {
  const volume::GridGeometry& g = patient_.labels.geometry;
  for (const char* name : {"liver", "spleen", "kidney_left", "vertebrae_L3"})
    for (const std::int64_t voxels : {-5, 5}) {
      const std::uint8_t id = patient_.label_table.find(name)->id;
      anatomy::VirtualPatient moved = patient_;
      for (std::uint8_t& voxel : moved.labels.voxels) voxel = voxel == id ? 0 : voxel;
      for (std::size_t n = 0; n < moved.labels.voxels.size(); ++n) {
        volume::Index3 from = g.index_of(n);
        from[0] -= voxels;
        if (g.contains(from) && patient_.labels[from] == id) moved.labels.voxels[n] = id;
      }
      const auto findings = patient_builder::judge_anatomy(moved);
      EXPECT_TRUE(std::ranges::any_of(findings,
                                      [&](const patient_builder::AnatomyFinding& finding) {
                                        return finding.name == patient_builder::kShifted &&
                                               finding.text.find(name) != std::string::npos;
                                      }))
          << name << voxels;
    }
  for (const patient_builder::AnatomyFinding& finding : patient_builder::judge_anatomy(patient_))
    ADD_FAILURE() << finding.text;
}

TEST_F(TorsoWithDerivedStructures, ListsItsRepairs) {
  ASSERT_FALSE(patient_.repairs.empty());
  const auto starts_with = [](const char* text) {
    return std::any_of(patient_.repairs.begin(), patient_.repairs.end(),
                       [&](const anatomy::Finding& repair) { return repair.text.starts_with(text); });
  };
  EXPECT_TRUE(starts_with("joined rib_right_12 and vertebrae_T12"));
  EXPECT_TRUE(starts_with("removed 2 islands (0.2 ml) of pancreas"));
  for (const anatomy::Finding& repair : patient_.repairs) {
    EXPECT_TRUE(repair.place_P) << repair.text;
    EXPECT_NE(std::find(warnings_.begin(), warnings_.end(), repair.text), warnings_.end()) << repair.text;
  }
}

}  // namespace
}  // namespace trocar::io
