// DICOM SEG and RT structure sets as --labels.

#include <algorithm>
#include <functional>
#include <map>

#include "dicom/testing/segmentation_writer.h"
#include "io/image/image_file.h"
#include "io/patient/build_from_files.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"
#include "volume/resample.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::segment_item;
using testing::test_data;
using testing::TestSeg;

dicom::CtReference reference_of(const CtScan& scan) {
  return {scan.grid.geometry, scan.series_uid, scan.frame_of_reference, scan.slices_P};
}

/// Voxels of each structure on the grid of the CT.
std::map<std::string, std::size_t> voxels_on(const volume::GridGeometry& ct,
                                             const std::vector<patient_builder::LabelSource>& sources) {
  std::map<std::string, std::size_t> voxels;
  for (const patient_builder::LabelSource& source : sources) {
    const volume::LabelGrid labels = volume::resample_nearest(source.labels, ct, 0);
    for (const auto& [value, name] : source.names)
      voxels[name] += static_cast<std::size_t>(std::count(labels.voxels.begin(), labels.voxels.end(), value));
  }
  return voxels;
}

class DicomLabels : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::CtSeries series;
    std::vector<Vec3> origins_P;
    for (int n = 0; n < 5; ++n) origins_P.emplace_back(0, 0, 2 * n);
    testing::write_slices(folder_ / "ct", series, origins_P, [](const Vec3&) { return 40.0; });
    const auto scan = read_ct_scan(folder_ / "ct");
    ASSERT_TRUE(scan) << scan.error().text();
    ct_ = reference_of(*scan);
  }

  /// Two overlapping segments: 1 in columns 0 to 4 of slices 1 and 2, 2 in columns 2 and 3 of slice 1.
  static TestSeg two_segments(const std::string& first, const std::string& second) {
    TestSeg seg;
    seg.segments = {segment_item(1, first), segment_item(2, second)};
    const auto wide = [](int i, int) { return i < 5 ? 1 : 0; };
    seg.frames = {
        {1, Vec3(0, 0, 4), wide}, {1, Vec3(0, 0, 2), wide}, {2, Vec3(0, 0, 2), [](int i, int) { return i / 2 == 1; }}};
    return seg;
  }

  std::map<std::string, std::size_t> read(const fs::path& path, const std::string& map = "totalsegmentator") {
    warnings_.clear();
    const auto sources = read_label_sources({path}, map, ct_, warnings_);
    if (!sources) return {{sources.error().text(), 0}};
    return voxels_on(ct_.grid, *sources);
  }

  std::string map_file(const std::string& text) {
    testing::write_bytes(folder_ / "map.toml", text);
    return (folder_ / "map.toml").string();
  }

  using Voxels = std::map<std::string, std::size_t>;
  TemporaryFolder folder_;
  dicom::CtReference ct_;
  std::vector<std::string> warnings_;
};

TEST_F(DicomLabels, NameSegmentsByFileMapOrType) {
  testing::write_dicom(folder_ / "label.seg", testing::seg_elements(two_segments("Liver", "my tumour")));
  EXPECT_EQ(read(folder_ / "label.seg"), (Voxels{{"Liver", 60}, {"my tumour", 12}}));
  EXPECT_EQ(read(folder_ / "label.seg", map_file("[labels]\n\"my tumour\" = \"liver_tumor\"\n")),
            (Voxels{{"Liver", 60}, {"liver_tumor", 12}}));
  EXPECT_EQ(read(folder_ / "label.seg", map_file("[labels]\n2 = \"liver_tumor\"\n")),
            (Voxels{{"Liver", 60}, {"liver_tumor", 12}}));
  EXPECT_EQ(read(folder_ / "label.seg", map_file("ignore = [\"my tumour\"]\n")), (Voxels{{"Liver", 60}}));
  EXPECT_EQ(read(folder_ / "label.seg", map_file("[labels]\n\"*\" = \"ignore\"\n")), (Voxels{{"Liver", 60}}));

  TestSeg typed = two_segments("Segment_1", "Segment_2");
  typed.segments = {
      segment_item(1, "Segment_1", testing::dicom_code(0x0062, 0x000f, "10200004", "SCT", "Leber")),
      segment_item(2, "Segment_2",
                   testing::dicom_sequence(0x0062, 0x000f,
                                           {testing::dicom_element(0x0008, 0x0100, "SH", "64033007") +
                                            testing::dicom_element(0x0008, 0x0102, "SH", "SCT") +
                                            testing::dicom_element(0x0008, 0x0104, "LO", "Kidney") +
                                            testing::dicom_code(0x0062, 0x0011, "24028007", "SCT", "Right")}))};
  testing::write_dicom(folder_ / "typed.dcm", testing::seg_elements(typed));
  EXPECT_EQ(read(folder_ / "typed.dcm"), (Voxels{{"liver", 60}, {"kidney_right", 12}}));
}

TEST_F(DicomLabels, NameASingleUnnamedSegmentAfterItsFile) {
  TestSeg seg = two_segments("Segment_1", "x");
  seg.segments.pop_back();
  seg.frames.pop_back();
  testing::write_dicom(folder_ / "liver.dcm", testing::seg_elements(seg));
  EXPECT_EQ(read(folder_ / "liver.dcm"), (Voxels{{"liver", 60}}));
}

TEST_F(DicomLabels, AcceptAbbreviatedSidesInStructureSets) {
  const auto square = [](double x) {
    return std::vector<Vec3>{{x, -0.5, 2}, {x + 2, -0.5, 2}, {x + 2, 5.5, 2}, {x, 5.5, 2}};
  };
  testing::write_dicom(folder_ / "rs.dcm",
                       testing::structure_set_elements({{"Kidney_L", {{"CLOSED_PLANAR", square(-0.5)}}},
                                                        {"Rt Lung", {{"CLOSED_PLANAR", square(2.5)}}},
                                                        {"SpinalCord", {{"CLOSED_PLANAR", square(5.5)}}}}));
  EXPECT_EQ(read(folder_ / "rs.dcm"), (Voxels{{"kidney_left", 12}, {"lung_right", 12}, {"SpinalCord", 12}}));
}

TEST_F(DicomLabels, ReadASiblingSeriesOnRequest) {
  TestSeg seg = two_segments("Liver", "Spleen");
  seg.series_uid = "1.2.4";
  testing::write_dicom(folder_ / "label.seg", testing::seg_elements(seg));
  EXPECT_NE(read(folder_ / "label.seg").begin()->first.find("--sibling-series"), std::string::npos);
  ct_.accepts_sibling = true;
  EXPECT_EQ(read(folder_ / "label.seg"), (Voxels{{"Liver", 60}, {"Spleen", 12}}));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("label.seg: was drawn on the series 1.2.4"), std::string::npos) << warnings_[0];
}

TEST_F(DicomLabels, AreFoundInTheFolderOfTheCt) {
  testing::write_dicom(folder_ / "ct/../study/seg/1", testing::seg_elements(two_segments("Liver", "Spleen")));
  fs::rename(folder_ / "ct", folder_ / "study/ct");
  EXPECT_EQ(read(folder_ / "study"), (Voxels{{"Liver", 60}, {"Spleen", 12}}));
}

TEST_F(DicomLabels, SelectTheReferencedSeries) {
  testing::CtSeries other;
  other.series_uid = "1.2.5";
  testing::write_slices(folder_ / "other", other, {{0, 0, 0}, {0, 0, 2}}, [](const Vec3&) { return 40.0; });
  testing::write_dicom(folder_ / "label.seg", testing::seg_elements(two_segments("Liver", "Spleen")));
  ASSERT_FALSE(read_ct_scan(folder_.path()));  // two CT series
  const auto scan = read_ct_scan(folder_.path(), "", series_of_labels({folder_ / "label.seg"}));
  ASSERT_TRUE(scan) << scan.error().text();
  EXPECT_EQ(scan->series_uid, "1.2.3");
}

TEST_F(DicomLabels, ReportAReferencedSeriesThatIsNotAVolume) {
  const auto error_of = [&](const std::string& series, const fs::path& ct) {
    TestSeg seg = two_segments("Liver", "Spleen");
    seg.series_uid = series;
    testing::write_dicom(folder_ / "label.seg", testing::seg_elements(seg));
    PatientFiles files;
    files.ct = ct;
    files.labels = {folder_ / "label.seg"};
    std::vector<std::string> warnings;
    const auto patient = build_from_files(files, warnings);
    return patient ? "built" : patient.error().text();
  };
  std::vector<Vec3> origins_P;
  for (int n = 0; n < 5; ++n) origins_P.emplace_back(0, 0, 2 * n);
  testing::write_slices(folder_ / "ct", testing::CtSeries{}, origins_P,
                        [](const Vec3& p_P) { return p_P.x() < 2.0 ? -1000.0 : 40.0; });
  testing::CtSeries one;
  one.series_uid = "1.2.5";
  testing::write_slices(folder_ / "other", one, {{0, 0, 0}}, [](const Vec3&) { return 40.0; });
  EXPECT_NE(error_of("1.2.5", folder_.path()).find("only one image in the folder"), std::string::npos)
      << error_of("1.2.5", folder_.path());
  EXPECT_NE(error_of("1.2.5", folder_ / "ct").find("not in the folder"), std::string::npos)
      << error_of("1.2.5", folder_ / "ct");
}

/// One row of bytes, run-length coded (PS3.5, annex G): each byte as a run of one.
std::string run_lengths(const std::string& bytes) {
  std::string coded = testing::little_endian(1, 4) + testing::little_endian(64, 4) + std::string(56, '\0');
  for (const char byte : bytes) coded += std::string{'\0', byte};
  return coded;
}

TEST_F(DicomLabels, CompressedFramesAreUnpacked) {
  TestSeg seg = two_segments("Liver", "Spleen");
  seg.type = "FRACTIONAL";
  seg.bits = 8;
  seg.maximum_fractional = 1;
  const std::string pixels = testing::seg_pixels(seg);
  const auto item = [](const std::string& value) {
    return testing::little_endian(0xfffe, 2) + testing::little_endian(0xe000, 2) +
           testing::little_endian(static_cast<std::uint32_t>(value.size()), 4) + value;
  };
  std::string packed = testing::little_endian(0x7fe0, 2) + testing::little_endian(0x0010, 2) + "OB" +
                       std::string(2, '\0') + testing::little_endian(0xffffffff, 4) + item("");
  for (std::size_t frame = 0; frame < 3; ++frame) packed += item(run_lengths(pixels.substr(frame * 48, 48)));
  packed += testing::little_endian(0xfffe, 2) + testing::little_endian(0xe0dd, 2) + testing::little_endian(0, 4);
  const std::string whole = testing::dicom_file(testing::seg_elements(seg, false) + packed, "1.2.840.10008.1.2.5");
  testing::write_bytes(folder_ / "label.seg", whole);
  EXPECT_EQ(read(folder_ / "label.seg"), (Voxels{{"Liver", 60}, {"Spleen", 12}}));
  // A damaged frame is named.
  std::string damaged = whole;
  damaged[damaged.rfind(run_lengths(pixels.substr(48, 48))) + 4] = '\x7f';
  testing::write_bytes(folder_ / "label.seg", damaged);
  EXPECT_NE(read(folder_ / "label.seg").begin()->first.find("frame 2: the DICOM image cannot be unpacked"),
            std::string::npos)
      << read(folder_ / "label.seg").begin()->first;
}

class RealSegmentation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data_)) GTEST_SKIP() << "no real data at " << data_;
  }
  /// A mask that another program made from the same segments; its voxels of `value` by place.
  static volume::MaskGrid mask_of(const fs::path& file, int value, const volume::GridGeometry& grid) {
    auto labels = read_labels(file);
    EXPECT_TRUE(labels) << labels.error().text();
    if (!labels) return {};
    volume::MaskGrid mask = volume::resample_nearest(*labels, grid, 0);
    for (std::uint8_t& voxel : mask.voxels) voxel = voxel == value ? 1 : 0;
    return mask;
  }
  /// The same of a structure of the sources, whose name the map does not change.
  static volume::MaskGrid mask_of(const std::vector<patient_builder::LabelSource>& sources, const std::string& wanted,
                                  const volume::GridGeometry& grid) {
    volume::MaskGrid mask(grid);
    for (const patient_builder::LabelSource& source : sources) {
      const volume::LabelGrid labels = volume::resample_nearest(source.labels, grid, 0);
      for (const auto& [value, name] : source.names)
        for (std::size_t n = 0; name == wanted && n < labels.voxels.size(); ++n)
          if (labels.voxels[n] == value) mask.voxels[n] = 1;
    }
    return mask;
  }
  std::vector<patient_builder::LabelSource> read(const fs::path& ct_folder, const fs::path& seg,
                                                 dicom::CtReference& ct) {
    const auto scan = read_ct_scan(ct_folder);
    EXPECT_TRUE(scan) << scan.error().text();
    if (!scan) return {};
    ct = reference_of(*scan);
    std::vector<std::string> warnings;
    const TemporaryFolder folder;
    // Names that no task needs, as capillaries, are kept by a map.
    testing::write_bytes(folder / "map.toml", "[labels]\nLIGHT_BLUE = \"LIGHT_BLUE\"\nPURPLE = \"PURPLE\"\n");
    auto sources = read_label_sources({seg}, (folder / "map.toml").string(), ct, warnings);
    EXPECT_TRUE(sources) << sources.error().text();
    return sources ? *std::move(sources) : std::vector<patient_builder::LabelSource>();
  }
  void expect_same(const fs::path& ct_folder, const fs::path& seg,
                   const std::vector<std::tuple<std::string, std::string, int>>& structures) {
    dicom::CtReference ct;
    const auto sources = read(ct_folder, seg, ct);
    for (const auto& [name, file, value] : structures) {
      const volume::MaskGrid expected = mask_of(data_ / file, value, ct.grid);
      const volume::MaskGrid found = mask_of(sources, name, ct.grid);
      EXPECT_GT(std::count(expected.voxels.begin(), expected.voxels.end(), 1), 0) << name;
      EXPECT_EQ(found.voxels, expected.voxels) << name << " of " << seg;
    }
  }
  fs::path data_ = test_data() / "dicom-seg/data/segmentations";
};

TEST_F(RealSegmentation, MatchesItsSourceMask) {
  expect_same(data_ / "ct-3slice", data_ / "liver.dcm", {{"Liver", "liver_seg.nrrd", 1}});
  expect_same(data_ / "23x38x3/image", data_ / "23x38x3/seg/label.seg", {{"Liver", "23x38x3/nrrd/label.nrrd", 1}});
  expect_same(data_ / "24x38x3/image", data_ / "24x38x3/seg/label.seg", {{"Liver", "24x38x3/nrrd/label.nrrd", 1}});
}

TEST_F(RealSegmentation, KeepsOverlappingSegmentsComplete) {
  // DARK_BLUE and ORANGE are no names, but their types are: vein, artery.
  expect_same(data_ / "ct-3slice", data_ / "partial_overlaps.dcm",
              {{"GREEN", "partial_overlaps-1.nrrd", 1},
               {"LIGHT_BLUE", "partial_overlaps-1.nrrd", 4},
               {"vein", "partial_overlaps-1.nrrd", 5},
               {"artery", "partial_overlaps-2.nrrd", 2},
               {"PURPLE", "partial_overlaps-3.nrrd", 3}});
}

TEST_F(RealSegmentation, ReadsALabelMap) {
  expect_same(data_ / "24x38x3/image", data_ / "sparse-labelmap-noppv.dcm",
              {{"Liver", "sparse_labelmap_noppv_seg.nrrd", 1}});
  expect_same(data_ / "24x38x3/image", data_ / "sparse-labelmap-ppv5.dcm",
              {{"Liver", "sparse_labelmap_ppv5_seg.nrrd", 1}});
}

TEST_F(RealSegmentation, RefusesAnotherSeries) {
  const auto scan = read_ct_scan(data_ / "24x38x3/image");
  ASSERT_TRUE(scan) << scan.error().text();
  std::vector<std::string> warnings;
  const auto sources = read_label_sources({data_ / "liver.dcm"}, "", reference_of(*scan), warnings);
  ASSERT_FALSE(sources);
  EXPECT_NE(sources.error().what.find("another series"), std::string::npos) << sources.error().text();
}

TEST(RealCompressedSegmentation, MatchesTheUncompressedOne) {
  const fs::path data = test_data() / "bad-input/dicom";
  if (!fs::exists(data)) GTEST_SKIP() << "no real data at " << data;
  const auto read = [&](const char* file) {
    auto sources = read_label_sources({data / file}, "");
    EXPECT_TRUE(sources) << sources.error().text();
    return sources ? *std::move(sources) : std::vector<patient_builder::LabelSource>();
  };
  const auto plain = read("pydata_liver.dcm");
  const auto run_length = read("pydata_liver_rle.dcm");
  ASSERT_EQ(plain.size(), 1U);
  ASSERT_EQ(run_length.size(), 1U);
  EXPECT_EQ(run_length[0].labels.voxels, plain[0].labels.voxels);
  for (const char* file : {"pydata_liver_deflate.dcm", "pydata_liver_j2k.dcm"}) {
    const auto refused = read_label_sources({data / file}, "");
    ASSERT_FALSE(refused) << file;
    EXPECT_NE(refused.error().what.find("compressed (transfer syntax"), std::string::npos) << refused.error().text();
  }
}

}  // namespace
}  // namespace trocar::io
