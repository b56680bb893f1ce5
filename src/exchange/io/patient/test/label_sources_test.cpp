#include "io/patient/label_sources.h"

#include <algorithm>

#include "io/image/image_file.h"
#include "io/patient/detail/mask_folder.h"
#include "io/test/test_support.h"
#include "volume/resample.h"

namespace trocar::io {
namespace {

using testing::oblique_geometry;
using testing::test_data;
using testing::write_bytes;

using LabelNames = std::vector<std::pair<int, std::string>>;

/// A label volume with the values of `values` in its first voxels.
volume::LabelGrid labels_with(const std::vector<std::uint8_t>& values) {
  volume::LabelGrid labels(oblique_geometry());
  std::copy(values.begin(), values.end(), labels.voxels.begin());
  return labels;
}

std::string error_of(const Result<std::vector<patient_builder::LabelSource>>& result) {
  return result ? "read" : result.error().text();
}

/// The voxels of a structure, whichever source and value it has.
std::vector<std::size_t> voxels_of(const std::vector<patient_builder::LabelSource>& sources, const std::string& name) {
  std::vector<std::size_t> voxels;
  for (const patient_builder::LabelSource& source : sources)
    for (const auto& [value, label] : source.names)
      if (label == name)
        for (std::size_t n = 0; n < source.labels.voxels.size(); ++n)
          if (source.labels.voxels[n] == value) voxels.push_back(n);
  return voxels;
}

TEST(LabelSources, SingleMaskIsNamedAfterItsFile) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({0, 255, 255}), folder / "liver.nii.gz"));
  for (const char* map : {"", "totalsegmentator"}) {
    const auto sources = read_label_sources({folder / "liver.nii.gz"}, map);
    ASSERT_TRUE(sources) << error_of(sources);
    ASSERT_EQ(sources->size(), 1U);
    EXPECT_EQ((*sources)[0].names, (LabelNames{{255, "liver"}}));
  }
}

TEST(LabelSources, NameNumbersByTheMap) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({5, 0, 2, 5}), folder / "seg.nii.gz"));
  const auto known = read_label_sources({folder / "seg.nii.gz"}, "totalsegmentator");
  ASSERT_TRUE(known) << error_of(known);
  EXPECT_EQ((*known)[0].names, (LabelNames{{2, "kidney_right"}, {5, "liver"}}));

  write_bytes(folder / "map.toml", "[labels]\n2 = \"spleen\"\n5 = \"aorta\"\n77 = \"unused\"\n");
  const auto own = read_label_sources({folder / "seg.nii.gz"}, (folder / "map.toml").string());
  ASSERT_TRUE(own) << error_of(own);
  EXPECT_EQ((*own)[0].names, (LabelNames{{2, "spleen"}, {5, "aorta"}}));
}

TEST(LabelSources, SingleMappedNumberIsNotAMask) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({5, 5}), folder / "segmentation_of_case_7.nrrd"));
  const auto sources = read_label_sources({folder / "segmentation_of_case_7.nrrd"}, "totalsegmentator");
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ((*sources)[0].names, (LabelNames{{5, "liver"}}));
}

TEST(LabelSources, NameAMaskAfterItsFileWithoutTheExtension) {
  TemporaryFolder folder;
  for (const char* ending : {".nii", ".nii.gz", ".mha", ".nrrd"})
    ASSERT_TRUE(write_image(labels_with({1, 1}), folder / (std::string("liver") + ending))) << ending;
  for (const char* ending : {".NRRD", ".seg.nrrd", ".Seg.nrrd"})
    std::filesystem::copy_file(folder / "liver.nrrd", folder / (std::string("liver") + ending));
  for (const char* ending : {".nii", ".nii.gz", ".mha", ".nrrd", ".NRRD", ".seg.nrrd", ".Seg.nrrd"}) {
    const auto sources = read_label_sources({folder / (std::string("liver") + ending)}, "");
    ASSERT_TRUE(sources) << ending << ": " << error_of(sources);
    EXPECT_EQ((*sources)[0].names, (LabelNames{{1, "liver"}})) << ending;
  }
}

TEST(LabelSources, NumbersWithoutNamesAreAnError) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({5, 2, 200}), folder / "seg.nii.gz"));
  EXPECT_NE(error_of(read_label_sources({folder / "seg.nii.gz"}, "")).find("--label-map"), std::string::npos);
  // What the map lacks comes without a name: build_patient lists it with that of other files.
  const auto sources = read_label_sources({folder / "seg.nii.gz"}, "totalsegmentator");
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ((*sources)[0].names, (LabelNames{{2, "kidney_right"}, {5, "liver"}}));
}

TEST(LabelSources, ErrorNamesAMalformedMap) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({1, 2}), folder / "seg.nii.gz"));
  for (const char* text : {"[labels]\n300 = \"liver\"\n", "[labels]\n1 = 2\n", "[structures]\n1 = \"liver\"\n",
                           "not toml", "ignore = [300]\n", "ignore = 3\n", "base = \"other\"\n"}) {
    write_bytes(folder / "map.toml", text);
    EXPECT_NE(error_of(read_label_sources({folder / "seg.nii.gz"}, (folder / "map.toml").string())).find("map.toml"),
              std::string::npos)
        << text;
  }
  EXPECT_NE(error_of(read_label_sources({folder / "seg.nii.gz"}, "totalsegmentor")).find("totalsegmentor"),
            std::string::npos);
}

TEST(LabelSources, MapIgnoresRenamesAndCatchesTheRest) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({1, 2, 3, 5, 200}), folder / "seg.nii.gz"));
  const auto names = [&](const std::string& map, const std::string& file) -> LabelNames {
    write_bytes(folder / "map.toml", map);
    const auto sources = read_label_sources({folder / file}, (folder / "map.toml").string());
    if (!sources || sources->size() != 1) return {{-1, error_of(sources)}};
    return (*sources)[0].names;
  };
  EXPECT_EQ(names("[labels]\n1 = \"liver\"\n2 = \"ignore\"\n\"*\" = \"fat\"\n", "seg.nii.gz"),
            (LabelNames{{1, "liver"}, {2, "ignore"}, {3, "fat"}, {5, "fat"}, {200, "fat"}}));
  EXPECT_EQ(names("ignore = [1, 2, 3, 200]\nbase = \"totalsegmentator\"\n", "seg.nii.gz"),
            (LabelNames{{1, "ignore"}, {2, "ignore"}, {3, "ignore"}, {5, "liver"}, {200, "ignore"}}));
  // LabelNames that files bring: of a mask, or of a segment.
  ASSERT_TRUE(write_image(labels_with({4, 4}), folder / "my_roi.nii.gz"));
  EXPECT_EQ(names("[labels]\nmy_roi = \"liver_tumor\"\n", "my_roi.nii.gz"), (LabelNames{{4, "liver_tumor"}}));
  EXPECT_EQ(names("[labels]\n\"*\" = \"ignore\"\n", "my_roi.nii.gz"), (LabelNames{{4, "ignore"}}));
  EXPECT_EQ(names("ignore = [\"my_roi\", \"3\"]\n", "my_roi.nii.gz"), (LabelNames{{4, "ignore"}}));
  ASSERT_TRUE(write_image(labels_with({4, 4}), folder / "liver.nii.gz"));
  EXPECT_EQ(names("[labels]\n\"*\" = \"ignore\"\n", "liver.nii.gz"), (LabelNames{{4, "liver"}}));
}

TEST(LabelSources, IgnoreMasksInAFolder) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder / "masks");
  ASSERT_TRUE(write_image(labels_with({1}), folder / "masks" / "my_roi.nii.gz"));
  write_bytes(folder / "map.toml", "ignore = [\"my_roi\"]\n");
  const std::string map = (folder / "map.toml").string();
  EXPECT_NE(error_of(read_label_sources({folder / "masks"}, map)).find("leaves out every label"), std::string::npos);
  ASSERT_TRUE(write_image(labels_with({0, 1}), folder / "masks" / "liver.nii.gz"));
  const auto sources = read_label_sources({folder / "masks"}, map);
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ(voxels_of(*sources, "liver"), (std::vector<std::size_t>{1}));
  EXPECT_TRUE(voxels_of(*sources, "my_roi").empty());
}

TEST(LabelSources, MasksThatDoNotOverlapShareAVolume) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({1, 1, 0, 0, 0}), folder / "liver.nii.gz"));
  ASSERT_TRUE(write_image(labels_with({0, 0, 1, 1, 0}), folder / "spleen.nrrd"));
  ASSERT_TRUE(write_image(labels_with({0, 255, 0, 0, 0}), folder / "tumor.mha"));
  ASSERT_TRUE(write_image(labels_with({0, 0, 0, 0, 0}), folder / "brain.nii.gz"));
  write_bytes(folder / "LICENSE", "not an image");
  const auto sources = read_label_sources({folder.path()}, "");
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ(sources->size(), 2U);  // liver with spleen, tumor
  EXPECT_EQ(voxels_of(*sources, "liver"), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(voxels_of(*sources, "spleen"), (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(voxels_of(*sources, "tumor"), (std::vector<std::size_t>{1}));
}

TEST(LabelSources, EmptyMaskCoversTheGridCoarsely) {
  const volume::GridGeometry whole = oblique_geometry(), coarse = detail::empty_over(whole).geometry;
  EXPECT_LT(coarse.voxel_count(), whole.voxel_count());
  const Vec3 half = Vec3::Constant(-0.5);
  EXPECT_LT((coarse.to_mm(half) - whole.to_mm(half)).norm(), 1e-4);
  EXPECT_LT((coarse.to_mm({1.5, 1.5, 1.5}) - whole.to_mm({6.5, 4.5, 3.5})).norm(), 1e-4);
}

TEST(LabelSources, TreatFilesInAFolderAsSingleMasks) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_image(labels_with({1, 1}), folder / "my_lesion.nii.gz"));
  const auto sources = read_label_sources({folder.path()}, "totalsegmentator");
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ((*sources)[0].names, (LabelNames{{1, "my_lesion"}}));
}

std::string seg_nrrd(const std::string& sizes_and_kinds, const std::string& segments, const std::string& voxels) {
  return "NRRD0004\ntype: unsigned char\nspace: left-posterior-superior\n" + sizes_and_kinds +
         "encoding: raw\nspace origin: (0,0,0)\n" + segments + "\n" + voxels;
}

TEST(LabelSources, ReadNamesFromSegNrrd) {
  TemporaryFolder folder;
  write_bytes(folder / "a.seg.nrrd", seg_nrrd("dimension: 3\nsizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                                              "kinds: domain domain domain\n",
                                              "Segment0_LabelValue:=3\nSegment0_Layer:=0\nSegment0_Name:=liver\n"
                                              "Segment1_LabelValue:=1\nSegment1_Layer:=0\nSegment1_Name:=portal vein\n",
                                              std::string("\3\3\1\0\0\0\0\0", 8)));
  const auto sources = read_label_sources({folder / "a.seg.nrrd"}, "");
  ASSERT_TRUE(sources) << error_of(sources);
  ASSERT_EQ(sources->size(), 1U);
  EXPECT_EQ(voxels_of(*sources, "liver"), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(voxels_of(*sources, "portal vein"), (std::vector<std::size_t>{2}));
}

TEST(LabelSources, SegNrrdLayersMayOverlap) {
  TemporaryFolder folder;
  write_bytes(folder / "a.seg.nrrd",
              seg_nrrd("dimension: 4\nsizes: 2 2 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n"
                       "kinds: list domain domain domain\n",
                       "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=liver\n"
                       "Segment1_LabelValue:=1\nSegment1_Layer:=1\nSegment1_Name:=tumor\n",
                       std::string("\1\0\1\1\0\0\0\0\0\0\0\0\0\0\0\1", 16)));
  const auto sources = read_label_sources({folder / "a.seg.nrrd"}, "");
  ASSERT_TRUE(sources) << error_of(sources);
  ASSERT_EQ(sources->size(), 2U);
  EXPECT_EQ(voxels_of(*sources, "liver"), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(voxels_of(*sources, "tumor"), (std::vector<std::size_t>{1, 7}));
}

TEST(LabelSources, NameSegNrrdSegmentsByTerminologyOrMap) {
  const TemporaryFolder folder;
  const std::string kidney =
      "TerminologyEntry:Segmentation category and type - DICOM master list~SCT^123037004^Anatomical Structure~"
      "SCT^64033007^Kidney~SCT^7771000^Left~Anatomic codes - DICOM master list~^^~^^|Segmentation.Status:completed";
  write_bytes(folder / "a.seg.nrrd",
              seg_nrrd("dimension: 3\nsizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n",
                       "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=Segment_1\nSegment0_Tags:=" + kidney +
                           "\nSegment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Name:=my roi\n",
                       std::string("\1\1\2\0\0\0\0\0", 8)));
  write_bytes(folder / "map.toml", "[labels]\n\"my roi\" = \"liver_tumor\"\n");
  const auto sources = read_label_sources({folder / "a.seg.nrrd"}, (folder / "map.toml").string());
  ASSERT_TRUE(sources) << error_of(sources);
  EXPECT_EQ(voxels_of(*sources, "kidney_left"), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(voxels_of(*sources, "liver_tumor"), (std::vector<std::size_t>{2}));
}

TEST(LabelSources, PlaceASegNrrdOfSmallerExtent) {
  // 3D Slicer saves only the box of the segments: 2 x 2 x 2 voxels within the CT, from voxel (4, 3, 2) on, in two
  // layers.
  const TemporaryFolder folder;
  std::string text = seg_nrrd(
      "dimension: 4\nsizes: 2 2 2 2\nspace directions: none (2,0,0) (0,2,0) (0,0,3)\n"
      "kinds: list domain domain domain\n",
      "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=liver\n"
      "Segment1_LabelValue:=1\nSegment1_Layer:=1\nSegment1_Name:=tumor\n"
      "Segmentation_ReferenceImageExtentOffset:=4 3 2\n",
      std::string("\1\0\1\1\0\0\0\0\0\0\0\0\0\0\0\1", 16));
  const std::size_t origin = text.find("space origin: (0,0,0)");
  ASSERT_NE(origin, std::string::npos);
  text.replace(origin, 21, "space origin: (8,6,6)");
  write_bytes(folder / "a.seg.nrrd", text);
  const auto sources = read_label_sources({folder / "a.seg.nrrd"}, "");
  ASSERT_TRUE(sources) << error_of(sources);
  volume::GridGeometry ct;
  ct.size = {10, 10, 10};
  ct.spacing_mm = {2, 2, 3};
  ASSERT_EQ(sources->size(), 2U);
  for (const patient_builder::LabelSource& source : *sources) EXPECT_TRUE(source.is_described);
  const volume::LabelGrid liver = volume::resample_nearest((*sources)[0].labels, ct, 0);
  const volume::LabelGrid tumor = volume::resample_nearest((*sources)[1].labels, ct, 0);
  EXPECT_EQ(std::count(liver.voxels.begin(), liver.voxels.end(), 1), 2);
  EXPECT_EQ((liver[{4, 3, 2}]), 1);
  EXPECT_EQ((liver[{5, 3, 2}]), 1);
  EXPECT_EQ(std::count(tumor.voxels.begin(), tumor.voxels.end(), 1), 2);
  EXPECT_EQ((tumor[{5, 3, 2}]), 1);
  EXPECT_EQ((tumor[{5, 4, 3}]), 1);
}

TEST(LabelSources, FoldersWithoutMasksAreRefused) {
  TemporaryFolder folder;
  EXPECT_NE(error_of(read_label_sources({folder.path()}, "")).find("no mask"), std::string::npos);
  EXPECT_FALSE(read_label_sources({folder / "missing"}, ""));
}

TEST(LabelSources, KeepEveryTotalSegmentatorMask) {
  const auto folder = test_data() / "ct-torso/example_seg_fast";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real data at " << folder;
  const auto sources = read_label_sources({folder}, "");
  ASSERT_TRUE(sources) << error_of(sources);
  std::size_t structures = 0;
  for (const patient_builder::LabelSource& source : *sources) structures += source.names.size();
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const std::string name = file.substr(0, file.find('.'));
    if (!file.ends_with(".nii.gz")) continue;
    const auto mask = read_labels(entry.path());
    ASSERT_TRUE(mask) << mask.error().text();
    const auto count = std::count_if(mask->voxels.begin(), mask->voxels.end(), [](auto v) { return v != 0; });
    EXPECT_EQ(voxels_of(*sources, name).size(), static_cast<std::size_t>(count)) << name;
    if (count > 0) ++files;
  }
  EXPECT_EQ(structures, files);  // the empty ones are left out
}

TEST(LabelSources, RecogniseTotalSegmentatorNumbers) {
  const auto data = test_data() / "ct-torso";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real data at " << data;
  const auto known = read_label_sources({data / "example_seg_fast_force_split.nii.gz"}, "totalsegmentator");
  ASSERT_TRUE(known) << error_of(known);
  EXPECT_EQ((*known)[0].names.size(), 61U);
  const auto listed = read_label_sources({data / "example_seg_fast_force_split.nii.gz"},
                                         (data / "totalsegmentator_v2_labels.toml").string());
  ASSERT_TRUE(listed) << error_of(listed);
  EXPECT_EQ((*known)[0].names, (*listed)[0].names);
}

}  // namespace
}  // namespace trocar::io
