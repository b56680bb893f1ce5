// What read_label_sources tells of empty structures, lost voxels and structures that no task needs.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "dicom/testing/segmentation_writer.h"
#include "io/image/image_file.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::segment_item;
using testing::TestSeg;
using testing::write_bytes;

/// A CT of 20 x 20 x 20 voxels of 2 mm, from the origin on.
dicom::CtReference cube_ct() {
  dicom::CtReference ct;
  ct.grid.size = {20, 20, 20};
  ct.grid.spacing_mm = {2, 2, 2};
  return ct;
}

/// A .seg.nrrd of 20 x 20 x 20 voxels with `spacing_mm`, from `origin_mm` on. `segments` are names, or names and their
/// terminology separated by '|'; the value n + 1 fills plane n of the k-th axis, but 0 does not occur in `blank`.
std::string slicer_file(const std::vector<std::pair<std::string, std::string>>& segments,
                        const std::vector<std::size_t>& blank = {}, double spacing_mm = 2.0, double origin_mm = 0.0) {
  std::string text = fmt::format(
      "NRRD0004\ntype: unsigned char\nspace: left-posterior-superior\ndimension: 3\nsizes: 20 20 20\n"
      "space directions: ({0},0,0) (0,{0},0) (0,0,{0})\nencoding: raw\nspace origin: ({1},0,0)\n",
      spacing_mm, origin_mm);
  std::string voxels(20 * 20 * 20, '\0');
  for (std::size_t n = 0; n < segments.size(); ++n) {
    text += fmt::format("Segment{0}_LabelValue:={1}\nSegment{0}_Layer:=0\nSegment{0}_Name:={2}\n", n, n + 1,
                        segments[n].first);
    if (!segments[n].second.empty()) text += fmt::format("Segment{}_Tags:={}\n", n, segments[n].second);
    if (std::find(blank.begin(), blank.end(), n) == blank.end())
      std::fill_n(voxels.begin() + static_cast<std::ptrdiff_t>(400 * n), 400, static_cast<char>(n + 1));
  }
  return text + "\n" + voxels;
}

/// Tags of a segment: type with an optional side and region, as 3D Slicer writes them.
std::string terminology(const std::string& type, const std::string& side = "^^", const std::string& region = "^^",
                        const std::string& category = "SCT^123037004^Anatomical Structure") {
  return "TerminologyEntry:Segmentation category and type - 3D Slicer General Anatomy list~" + category + "~" + type +
         "~" + side + "~Anatomic codes - DICOM master list~" + region + "~^^|Segmentation.Status:inprogress";
}

class LabelChecks : public ::testing::Test {
 protected:
  /// Names in the order of the file, or the error.
  std::vector<std::string> read(const std::filesystem::path& path, const std::string& map = "") {
    warnings_.clear();
    const auto sources = read_label_sources({path}, map, ct_, warnings_);
    if (!sources) return {sources.error().text()};
    std::vector<std::string> names;
    for (const patient_builder::LabelSource& source : *sources)
      for (const auto& [value, name] : source.names) names.push_back(name);
    return names;
  }
  std::vector<std::string> read_slicer(const std::string& bytes) {
    write_bytes(folder_ / "a.seg.nrrd", bytes);
    return read(folder_ / "a.seg.nrrd");
  }
  std::string told() const { return fmt::format("{}", fmt::join(warnings_, "\n")); }
  bool is_told(const std::string& text) const { return told().find(text) != std::string::npos; }

  using Names = std::vector<std::string>;
  TemporaryFolder folder_;
  dicom::CtReference ct_ = cube_ct();
  std::vector<std::string> warnings_;
};

TEST_F(LabelChecks, WarnOfEmptyStructures) {
  EXPECT_EQ(read_slicer(slicer_file({{"liver", ""}, {"spleen", ""}, {"my roi", ""}}, {1, 2})), (Names{"liver"}));
  ASSERT_EQ(warnings_.size(), 2U) << told();
  EXPECT_TRUE(is_told("a.seg.nrrd: the structure \"spleen\" is empty")) << told();
  EXPECT_TRUE(is_told("\"my roi\" is empty")) << told();
  // Of DICOM objects, too.
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver"), segment_item(2, "Spleen"), segment_item(3, "Kidney")};
  seg.frames = {{1, Vec3(0, 0, 4), [](int, int) { return 1; }}, {2, Vec3(0, 0, 4), [](int, int) { return 0; }}};
  testing::write_dicom(folder_ / "label.seg", testing::seg_elements(seg));
  EXPECT_EQ(read(folder_ / "label.seg"), (Names{"Liver"}));
  EXPECT_TRUE(is_told("\"Spleen\" is empty") && is_told("\"Kidney\" is empty")) << told();
}

TEST_F(LabelChecks, BlankLabelsAreRefused) {
  const auto refused = [](const Names& names) {
    return names.size() == 1 && names[0].find("the labels are all empty") != std::string::npos ? "" : names.front();
  };
  EXPECT_EQ(refused(read_slicer(slicer_file({{"liver", ""}, {"spleen", ""}}, {0, 1}))), "");
  const volume::LabelGrid blank(ct_.grid);
  for (const char* file : {"seg.nii.gz", "liver.nii.gz"}) {
    ASSERT_TRUE(write_image(blank, folder_ / file));
    EXPECT_EQ(refused(read(folder_ / file, "totalsegmentator")), "") << file;
  }
  std::filesystem::create_directory(folder_ / "masks");
  for (const char* file : {"liver.nii.gz", "spleen.nii.gz", "aorta.nii.gz"})
    ASSERT_TRUE(write_image(blank, folder_ / "masks" / file));
  const Names masks = read(folder_ / "masks");
  EXPECT_EQ(refused(masks), "");
  EXPECT_NE(masks[0].find("none of 3 structures"), std::string::npos) << masks[0];
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, Vec3(0, 0, 4), [](int, int) { return 0; }}};
  testing::write_dicom(folder_ / "label.seg", testing::seg_elements(seg));
  EXPECT_EQ(refused(read(folder_ / "label.seg")), "");
  testing::write_dicom(folder_ / "rs.dcm", testing::structure_set_elements({{"Liver", {}}, {"Spleen", {}}}));
  EXPECT_EQ(refused(read(folder_ / "rs.dcm")), "");
}

TEST_F(LabelChecks, SkipABlankFileBesideAnother) {
  volume::LabelGrid labels(ct_.grid);
  ASSERT_TRUE(write_image(labels, folder_ / "seg.nii.gz"));
  labels.voxels[0] = 1;
  ASSERT_TRUE(write_image(labels, folder_ / "liver.nii.gz"));
  const auto sources = read_label_sources({folder_ / "seg.nii.gz", folder_ / "liver.nii.gz"}, "", ct_, warnings_);
  ASSERT_TRUE(sources) << sources.error().text();
  EXPECT_EQ(sources->size(), 1U);
  EXPECT_TRUE(is_told("1 of 2 structures are empty masks and were left out: seg")) << told();
}

TEST_F(LabelChecks, ListEmptyMasksOfAFolderInOneLine) {
  volume::LabelGrid labels(ct_.grid);
  ASSERT_TRUE(write_image(labels, folder_ / "spleen.nii.gz"));
  ASSERT_TRUE(write_image(labels, folder_ / "aorta.nii.gz"));
  labels.voxels[0] = 1;
  ASSERT_TRUE(write_image(labels, folder_ / "liver.nii.gz"));
  EXPECT_EQ(read(folder_.path()), (Names{"liver"}));
  EXPECT_EQ(told(), "2 of 3 structures are empty masks and were left out: aorta, spleen");
}

TEST_F(LabelChecks, VoxelsBeyondTheCtAreCounted) {
  // Each structure is a plane of 40 x 40 x 2 mm, 3.2 ml; the CT ends 10 mm before them.
  EXPECT_EQ(read_slicer(slicer_file({{"liver", ""}}, {}, 2.0, 10.0)), (Names{"liver"}));
  EXPECT_TRUE(is_told("0.8 of 3.2 ml") || warnings_.empty()) << told();  // 0.8 ml are not worth a warning
  EXPECT_TRUE(warnings_.empty()) << told();
  read_slicer(slicer_file({{"liver", ""}}, {}, 2.0, 20.0));
  EXPECT_TRUE(is_told("a.seg.nrrd: 1.6 of 3.2 ml of \"liver\" lie beyond the CT")) << told();
  // Nothing of it within the CT.
  const Names beyond = read_slicer(slicer_file({{"liver", ""}}, {}, 2.0, 60.0));
  EXPECT_NE(beyond[0].find("all empty on the CT"), std::string::npos) << beyond[0];
}

TEST_F(LabelChecks, KeepTheVolumeAcrossVoxelSizes) {
  // 20 planes of 0.5 mm are 10 x 10 x 10 mm; a single plane lies between voxels of the CT.
  std::vector<std::pair<std::string, std::string>> whole{{"liver", ""}};
  EXPECT_EQ(read_slicer(slicer_file(whole, {}, 2.0)), (Names{"liver"}));
  EXPECT_TRUE(warnings_.empty()) << told();
  // The second plane of 0.5 mm holds no centre of a voxel of the CT.
  EXPECT_EQ(read_slicer(slicer_file({{"liver", ""}, {"spleen", ""}}, {}, 0.5)), (Names{"liver", "spleen"}));
  EXPECT_TRUE(is_told("\"spleen\" (0.05 ml) has no voxel on the CT")) << told();
  EXPECT_FALSE(is_told("liver")) << told();
  // A plane of 3 mm of 5.4 ml becomes one of 2 mm.
  read_slicer(slicer_file({{"liver", ""}}, {}, 2.9));
  EXPECT_TRUE(is_told("ml of \"liver\"")) << told();
}

TEST_F(LabelChecks, ReadTheTerminologyOf3dSlicer) {
  const auto one = [&](const std::string& name, const std::string& tags) {
    Names names = read_slicer(slicer_file({{"liver", ""}, {name, tags}}));
    return names.size() == 2 ? names[1] : names[0];
  };
  EXPECT_EQ(one("Segment_1", terminology("SCT^122496007^Lumbar spine")), "lumbar_spine");
  EXPECT_EQ(one("lumbar vertebral column", ""), "lumbar vertebral column");
  EXPECT_EQ(one("Segment_1", terminology("SRT^T-11503^Lumbar spine")), "lumbar_spine");
  EXPECT_EQ(one("Segment_1", terminology("SCT^113197003^Rib")), "ribs");
  EXPECT_EQ(one("Segment_1", terminology("SRT^T-71000^Kidney", "SRT^G-A101^links")), "kidney_left");
  EXPECT_EQ(one("Segment_1", terminology("SCT^39607008^Lunge", "SCT^24028007^rechts")), "lung_right");
  EXPECT_EQ(one("Segment_1", terminology("SCT^87878005^Left Ventricle")), "heart_ventricle_left");
  EXPECT_EQ(one("Segment_1", terminology("SRT^T-32600^Left Ventricle")), "heart_ventricle_left");
  EXPECT_EQ(one("Segment_1", terminology("SCT^39937001^Skin")), "skin");
  // The region decides where the type says nothing, and only there.
  EXPECT_EQ(one("Segment_1", terminology("SCT^85756007^Tissue", "^^", "SCT^10200004^Liver")), "liver");
  EXPECT_EQ(one("Segment_1", terminology("99X^1^Stent", "^^", "SCT^10200004^Liver")), "Segment_1");
  EXPECT_EQ(one("Segment_1", terminology("SCT^4147007^Mass", "^^", "SCT^10200004^Liver",
                                         "SCT^49755003^Morphologically Altered Structure")),
            "liver_mass");
  EXPECT_EQ(one("Segment_1", terminology("SCT^108369006^Neoplasm", "^^", "SCT^64033007^Kidney",
                                         "SCT^49755003^Morphologically Altered Structure")),
            "neoplasm");
  // A name that is the meaning of its code is the code's; other contradictions are told.
  EXPECT_EQ(one("Ventricle", terminology("SCT^87878005^Left Ventricle")), "heart_ventricle_left");
  EXPECT_EQ(one("left ventricle of heart", ""), "left ventricle of heart");
  EXPECT_EQ(one("Ventricle_L", ""), "ventricle_left");  // the heart's
  EXPECT_EQ(one("Segment_1", terminology("SCT^66720007^Lateral ventricle", "SCT^7771000^Left")),
            "lateral_ventricle_left");
  EXPECT_FALSE(is_told("code")) << told();
  EXPECT_EQ(one("Spleen", terminology("SCT^64033007^Kidney", "SCT^7771000^Left")), "Spleen");
  EXPECT_TRUE(
      is_told("\"Spleen\" is read by its name (spleen), but its code SCT:64033007 left is kidney_left (kidney)"))
      << told();
  // The type that every new segment has is no structure: the build refuses the name.
  EXPECT_EQ(one("Segment_1", terminology("SCT^85756007^Tissue")), "Segment_1");
  EXPECT_EQ(one("Segment_1", terminology("SCT^32457005^Body fluid")), "Segment_1");  // perhaps the ascites
}

TEST_F(LabelChecks, CodesAddSideAndLevelToGenericNames) {
  const auto one = [&](const std::string& name, const std::string& tags) {
    Names names = read_slicer(slicer_file({{"liver", ""}, {name, tags}}));
    return names.size() == 2 ? names[1] : names[0];
  };
  const std::string left = "SCT^7771000^Left", right = "SCT^24028007^Right";
  EXPECT_EQ(one("Kidney", terminology("SCT^64033007^Kidney", left)), "kidney_left");
  EXPECT_EQ(one("kidneys", terminology("SCT^64033007^Kidney", right)), "kidney_right");
  EXPECT_EQ(one("Lung", terminology("SRT^T-28000^Lung", left)), "lung_left");
  EXPECT_EQ(one("Vertebra", terminology("SCT^66794005^First lumbar vertebra")), "vertebrae_L1");
  EXPECT_EQ(one("vertebrae", terminology("SCT^23215003^Twelfth thoracic vertebra")), "vertebrae_T12");
  EXPECT_EQ(one("Rib", terminology("SCT^25888004^Third rib", left)), "rib_3_left");
  EXPECT_EQ(one("Rib left", terminology("SCT^25888004^Third rib", left)), "rib_3_left");
  EXPECT_EQ(one("Bone", terminology("SCT^54735007^Sacrum")), "sacrum");
  EXPECT_EQ(one("Vein", terminology("SCT^64131007^Inferior vena cava")), "inferior_vena_cava");
  EXPECT_FALSE(is_told("code")) << told();
  // A name that says more than its code, or something else, counts; what contradicts it is told.
  EXPECT_EQ(one("Kidney left", terminology("SCT^64033007^Kidney")), "Kidney left");
  EXPECT_EQ(one("vertebrae_L1", terminology("SCT^51282000^Vertebra")), "vertebrae_L1");
  EXPECT_EQ(one("liver", terminology("SCT^10200004^Liver")), "liver");
  EXPECT_FALSE(is_told("code")) << told();
  EXPECT_EQ(one("Kidney left", terminology("SCT^64033007^Kidney", right)), "Kidney left");
  EXPECT_TRUE(is_told("\"Kidney left\" is read by its name, but its code SCT:64033007 right is kidney_right"))
      << told();
  EXPECT_EQ(one("Kidney_L", terminology("SCT^64033007^Kidney", right)), "kidney_left");
  EXPECT_TRUE(is_told("but its code SCT:64033007 right is kidney_right")) << told();
  EXPECT_EQ(one("vertebrae_L1", terminology("SCT^36470004^Third lumbar vertebra")), "vertebrae_L1");
  EXPECT_TRUE(is_told("but its code SCT:36470004 is vertebrae_L3")) << told();
  EXPECT_EQ(one("Rib 3", terminology("SCT^15339008^Fifth rib")), "Rib 3");
  EXPECT_TRUE(is_told("but its code SCT:15339008 is rib_5")) << told();
}

TEST_F(LabelChecks, ListUnusedStructuresInOneLine) {
  EXPECT_EQ(read_slicer(slicer_file({{"liver", ""},
                                     {"tissue", terminology("SCT^85756007^Tissue")},
                                     {"my nodes", terminology("SCT^59441001^Lymph node")},
                                     {"Left Ovary_2", ""}})),
            (Names{"liver", "ignore", "ignore", "ignore"}));
  ASSERT_EQ(warnings_.size(), 1U) << told();
  EXPECT_EQ(warnings_[0], "structures that no task needs were left out: Left Ovary_2, lymph_node, tissue");
  // In structure sets and as masks.
  const std::vector<Vec3> square{{1, 1, 4}, {9, 1, 4}, {9, 9, 4}, {1, 9, 4}};
  testing::write_dicom(folder_ / "rs.dcm", testing::structure_set_elements({{"Liver", {{"CLOSED_PLANAR", square}}},
                                                                            {"Thymus", {{"CLOSED_PLANAR", square}}}}));
  EXPECT_EQ(read(folder_ / "rs.dcm"), (Names{"Liver", "ignore"}));
  EXPECT_TRUE(is_told("left out: Thymus")) << told();
  // An entry of a label map has its way.
  write_bytes(folder_ / "map.toml", "[labels]\nThymus = \"soft_tissue\"\n");
  EXPECT_EQ(read(folder_ / "rs.dcm", (folder_ / "map.toml").string()), (Names{"Liver", "soft_tissue"}));
}

}  // namespace
}  // namespace trocar::io
