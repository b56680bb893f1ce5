#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "dicom/segmentation/test/seg_fixture.h"

namespace trocar::dicom {
namespace {

using seg_test::at_z;
using seg_test::block;
using seg_test::count_at;
using seg_test::ct_with_slices;
using seg_test::every_segment;
using seg_test::Seg;
using seg_test::voxels_of;
using trocar::testing::Length;
using trocar::testing::segment_item;
using trocar::testing::TestSeg;

TEST_F(Seg, PlacesFramesInAnyOrder) {
  for (const Length length : {Length::kDefined, Length::kUndefined}) {
    TestSeg seg;
    seg.length = length;
    seg.segments = {segment_item(1, "Liver"), segment_item(2, "Spleen")};
    seg.frames = {
        {2, at_z(4), block(6, 7)}, {1, at_z(6), block(0, 0)}, {1, at_z(2), block(0, 2)}, {2, at_z(2), block(5, 5)}};
    const auto read_seg = read(seg);
    ASSERT_TRUE(read_seg) << read_seg.error().text();
    ASSERT_EQ(read_seg->volumes.size(), 1U);  // they do not overlap
    ASSERT_EQ(read_seg->segments.size(), 2U);
    EXPECT_EQ(read_seg->segments[0].name, "Liver");
    const auto liver = voxels_of(*read_seg, 0);
    EXPECT_EQ(count_at(liver, 2), 3U * 6);
    EXPECT_EQ(count_at(liver, 4), 0U);  // no frame: empty
    EXPECT_EQ(count_at(liver, 6), 1U * 6);
    const auto spleen = voxels_of(*read_seg, 1);
    EXPECT_EQ(count_at(spleen, 2), 1U * 6);
    EXPECT_EQ(count_at(spleen, 4), 2U * 6);
    EXPECT_EQ(spleen.size(), 3U * 6);
  }
}

TEST_F(Seg, SplitsOverlappingSegmentsIntoVolumes) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver"), segment_item(2, "Tumor"), segment_item(3, "Spleen")};
  seg.frames = {{1, at_z(0), block(0, 4)}, {2, at_z(0), block(2, 3)}, {3, at_z(0), block(6, 7)}};
  const auto read_seg = read(seg);
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  EXPECT_EQ(read_seg->volumes.size(), 2U);
  EXPECT_EQ(voxels_of(*read_seg, 0).size(), 5U * 6);
  EXPECT_EQ(voxels_of(*read_seg, 1).size(), 2U * 6);
  EXPECT_EQ(voxels_of(*read_seg, 2).size(), 2U * 6);
}

TEST_F(Seg, ReportsDifferingFramesOfOnePlane) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver"), segment_item(2, "Spleen")};
  seg.frames = {
      {1, at_z(0), block(0, 4)}, {1, at_z(0), block(0, 4)}, {1, at_z(0), block(9, 9)}, {2, at_z(0), block(2, 3)}};
  EXPECT_TRUE(read(seg)->warnings.empty());  // the same, empty, or of another segment
  seg.frames.push_back({1, at_z(0), block(3, 6)});
  const auto told = read(seg);
  EXPECT_EQ(voxels_of(*told, 0).size(), 7U * 6);
  ASSERT_EQ(told->warnings.size(), 1U);
  EXPECT_NE(told->warnings[0].find("\"Liver\": 1 frame of a plane"), std::string::npos) << told->warnings[0];
}

TEST_F(Seg, ThresholdsFractionsAtHalfTheMaximum) {
  for (const int maximum : {255, 100}) {
    TestSeg seg;
    seg.type = "FRACTIONAL";
    seg.bits = 8;
    seg.maximum_fractional = maximum;
    seg.segments = {segment_item(1, "Liver")};
    // Columns 0 to 7: 0, 1/7 … of the maximum.
    seg.frames = {{1, at_z(0), [&](int i, int) { return maximum * i / 7; }}};
    const auto read_seg = read(seg);
    ASSERT_TRUE(read_seg) << read_seg.error().text();
    EXPECT_EQ(voxels_of(*read_seg, 0).size(), 4U * 6) << maximum;  // 4/7 to 7/7
  }
  TestSeg half;
  half.type = "FRACTIONAL";
  half.bits = 8;
  half.maximum_fractional = 100;
  half.segments = {segment_item(1, "Liver")};
  half.frames = {{1, at_z(0), [](int i, int) { return i < 4 ? 49 : 50; }}};
  EXPECT_EQ(voxels_of(*read(half), 0).size(), 4U * 6);
}

TEST_F(Seg, RefusesFractionsAllBelowHalf) {
  TestSeg seg;
  seg.type = "FRACTIONAL";
  seg.bits = 8;
  seg.maximum_fractional = 255;
  seg.segments = {segment_item(1, "Liver"), segment_item(2, "Spleen")};
  seg.frames = {{1, at_z(0), block(0, 4, 100)}, {2, at_z(0), block(5, 6, 127)}};
  EXPECT_NE(error_of(seg).find("the fractions of \"Liver\" are at most 100 of 255"), std::string::npos)
      << error_of(seg);
  seg.frames[1].value = block(5, 6, 128);
  const auto told = read(seg);
  ASSERT_TRUE(told) << told.error().text();
  ASSERT_EQ(told->warnings.size(), 1U);
  EXPECT_NE(told->warnings[0].find("\"Liver\" are at most 100 of 255"), std::string::npos) << told->warnings[0];
  seg.frames[0].value = block(0, 4, 0);  // empty is another matter
  EXPECT_TRUE(read(seg)->warnings.empty());
}

TEST_F(Seg, FramesOfAnotherSpacingOrDirectionAreRefused) {
  const auto changed = [&](std::size_t frame, const std::function<void(trocar::testing::TestFrame&)>& change) {
    TestSeg seg;
    seg.segments = {segment_item(1, "Liver")};
    for (const double z : {0, 2, 4}) seg.frames.push_back({1, at_z(z), block(0, 4)});
    change(seg.frames[frame]);
    return error_of(seg);
  };
  using trocar::testing::TestFrame;
  EXPECT_EQ(changed(1, [](TestFrame& f) { f.spacing_mm = {1.0, 1.0001}; }), "read");
  EXPECT_NE(changed(1,
                    [](TestFrame& f) {
                      f.spacing_mm = {0.5, 0.5};
                    })
                .find("frame 2 of the DICOM segmentation has pixels of 0.5 x 0.5 mm"),
            std::string::npos);
  EXPECT_NE(changed(2,
                    [](TestFrame& f) {
                      f.spacing_mm = {1.0, 1.1};
                    })
                .find("pixels of 1.1 x 1 mm, the first one of 1 x 1 mm"),
            std::string::npos);
  EXPECT_NE(changed(0, [](TestFrame& f) { f.spacing_mm = {2.0, 2.0}; }).find("frame 2"), std::string::npos);
  EXPECT_NE(changed(2, [](TestFrame& f) { f.spacing_mm = {0.0, 1.0}; }).find("are none"), std::string::npos);
  EXPECT_NE(changed(1, [](TestFrame& f) { f.directions = {0, 1, 0, 1, 0, 0}; }).find("several directions"),
            std::string::npos);
  EXPECT_NE(changed(2, [](TestFrame& f) { f.directions = {1, 0, 0, 0, -1, 0}; }).find("several directions"),
            std::string::npos);
  EXPECT_EQ(changed(2, [](TestFrame& f) { f.directions = {1, 0, 0, 0, 1, 0}; }), "read");
}

TEST_F(Seg, ReadsALabelMapBySegmentNumber) {
  for (const int bits : {8, 16}) {
    TestSeg seg;
    seg.type = "LABELMAP";
    seg.sop_class = "1.2.840.10008.5.1.4.1.1.66.7";
    seg.bits = bits;
    const int high = bits == 8 ? 200 : 4711;
    seg.segments = {segment_item(0, "Background"), segment_item(3, "Liver"), segment_item(high, "Spleen"),
                    segment_item(5, "Kidney")};
    seg.frames = {{0, at_z(4), [=](int i, int) { return i < 2 ? 3 : i > 6 ? high : 0; }}, {0, at_z(0), block(1, 1, 3)}};
    const auto read_seg = read(seg);
    ASSERT_TRUE(read_seg) << read_seg.error().text();
    ASSERT_EQ(read_seg->segments.size(), 3U);  // without the background
    EXPECT_EQ(voxels_of(*read_seg, 0).size(), 3U * 6);
    EXPECT_EQ(voxels_of(*read_seg, 1).size(), 1U * 6);
    EXPECT_TRUE(voxels_of(*read_seg, 2).empty());
    ASSERT_EQ(read_seg->volumes.size(), 1U);
    EXPECT_EQ(read_seg->volumes[0].segments, (std::vector<std::size_t>{0, 1}));
  }
}

TEST_F(Seg, RefusesLabelMapNumbersWithoutASegment) {
  TestSeg seg;
  seg.type = "LABELMAP";
  seg.bits = 8;
  seg.segments = {segment_item(0, "Background"), segment_item(3, "Liver")};
  seg.frames = {{0, at_z(4), [](int i, int) { return i < 2 ? 3 : i > 5 ? 7 : 0; }}, {0, at_z(0), block(1, 1, 7)}};
  EXPECT_NE(error_of(seg).find("18 pixels have the number 7"), std::string::npos) << error_of(seg);
  // Not even those of segments that are not wanted are undefined.
  seg.segments.push_back(segment_item(7, "Spleen"));
  trocar::testing::write_dicom(folder_ / "label.seg", trocar::testing::seg_elements(seg));
  EXPECT_TRUE(
      read_segmentation(folder_ / "label.seg", ct_with_slices(), [](const Segment& s) { return s.number == 3; }));
  // The padding is a background.
  seg.segments.pop_back();
  seg.padding = 7;
  EXPECT_EQ(error_of(seg), "read");
  seg.padding = 8;
  EXPECT_NE(error_of(seg), "read");
}

TEST_F(Seg, FramesOfAnUndefinedSegmentAreRefused) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver"), segment_item(3, "Spleen")};
  seg.frames = {{1, at_z(0), block(0, 4)}, {2, at_z(0), block(2, 3)}, {2, at_z(2), block(2, 3)}};
  EXPECT_NE(error_of(seg).find("2 frames of the segment number 2"), std::string::npos) << error_of(seg);
  seg.frames.push_back({9, at_z(0), block(2, 3)});
  EXPECT_NE(error_of(seg).find("(and 1 more)"), std::string::npos) << error_of(seg);
  // An empty frame may hide a mistake as well.
  seg.frames = {{1, at_z(0), block(0, 4)}, {0, at_z(2), block(9, 9)}};
  EXPECT_NE(error_of(seg).find("1 frame of the DICOM segmentation without the number of a segment"), std::string::npos)
      << error_of(seg);
  // A defined segment without frames is empty.
  seg.frames.pop_back();
  EXPECT_EQ(error_of(seg), "read");
}

TEST_F(Seg, ReadsOnlyTheRequestedSegments) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver"), segment_item(2, "Spleen")};
  seg.frames = {{1, at_z(0), block(0, 4)}, {2, at_z(0), block(2, 3)}};
  trocar::testing::write_dicom(folder_ / "label.seg", trocar::testing::seg_elements(seg));
  const auto read_seg =
      read_segmentation(folder_ / "label.seg", ct_with_slices(), [](const Segment& s) { return s.number == 2; });
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  ASSERT_EQ(read_seg->segments.size(), 1U);
  EXPECT_EQ(read_seg->segments[0].name, "Spleen");
  EXPECT_EQ(voxels_of(*read_seg, 0).size(), 2U * 6);
}

TEST_F(Seg, BuildsNamesFromLabelTypeAndRegion) {
  TestSeg seg;
  const std::string left = trocar::testing::dicom_code(0x0062, 0x0011, "7771000", "SCT", "Left");
  seg.segments = {segment_item(1, "Segment_1",
                               trocar::testing::dicom_sequence(
                                   0x0062, 0x000f,
                                   {trocar::testing::dicom_element(0x0008, 0x0100, "SH", "64033007") +
                                    trocar::testing::dicom_element(0x0008, 0x0102, "SH", "SCT") +
                                    trocar::testing::dicom_element(0x0008, 0x0104, "LO", "Kidney") + left})),
                  segment_item(2, "Segment_2",
                               trocar::testing::dicom_code(0x0008, 0x2218, "10200004", "SCT", "Liver") +
                                   trocar::testing::dicom_code(0x0062, 0x0003, "49755003", "SCT",
                                                               "Morphologically Altered Structure") +
                                   trocar::testing::dicom_code(0x0062, 0x000f, "108369006", "SCT", "Neoplasm"))};
  seg.frames = {{1, at_z(0), block(0, 4)}};
  const auto read_seg = read(seg);
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  EXPECT_EQ(read_seg->segments[0].meanings, (std::vector<std::string>{"Kidney left"}));
  EXPECT_EQ(read_seg->segments[0].codes, (std::vector<std::string>{"SCT:64033007 left"}));
  // A lesion is no part of its organ: the region alone is no name for it.
  EXPECT_EQ(read_seg->segments[1].meanings, (std::vector<std::string>{"Neoplasm"}));
  EXPECT_EQ(read_seg->segments[1].type_in_region, "Liver Neoplasm");
}

TEST_F(Seg, RefusesAnotherSeries) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, at_z(0), block(0, 4)}};
  EXPECT_EQ(error_of(seg), "read");
  seg.series_uid = "1.2.4";
  EXPECT_NE(error_of(seg).find("another series (1.2.4)"), std::string::npos) << error_of(seg);
  CtReference other_format = ct_with_slices();
  other_format.series_uid.clear();
  other_format.frame_of_reference.clear();
  EXPECT_EQ(error_of(seg, other_format), "read");
  seg.series_uid.clear();
  EXPECT_EQ(error_of(seg), "read");
  seg.frame_of_reference = "1.2.8";
  EXPECT_NE(error_of(seg).find("another frame of reference"), std::string::npos) << error_of(seg);
}

TEST_F(Seg, ReadsASiblingSeriesOnRequest) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, at_z(0), block(0, 4)}};
  seg.series_uid = "1.2.4";
  EXPECT_NE(error_of(seg).find("--sibling-series"), std::string::npos) << error_of(seg);
  CtReference ct = ct_with_slices();
  ct.accepts_sibling = true;
  const auto sibling = read(seg, ct);
  ASSERT_TRUE(sibling) << sibling.error().text();
  EXPECT_EQ(voxels_of(*sibling, 0).size(), 5U * 6);
  ASSERT_EQ(sibling->warnings.size(), 1U);
  for (const char* uid : {"1.2.4", "1.2.3", "1.2.9"})
    EXPECT_NE(sibling->warnings[0].find(uid), std::string::npos) << sibling->warnings[0];
  // Its own series needs no warning.
  seg.series_uid = "1.2.3";
  EXPECT_TRUE(read(seg, ct)->warnings.empty());
  // Another frame of reference, or none, is no sibling: the option is not offered.
  seg.series_uid = "1.2.4";
  for (const char* frame : {"1.2.8", ""}) {
    seg.frame_of_reference = frame;
    EXPECT_NE(error_of(seg, ct).find("another series"), std::string::npos) << error_of(seg, ct);
    EXPECT_EQ(error_of(seg, ct).find("--sibling-series"), std::string::npos) << error_of(seg, ct);
  }
  seg.frame_of_reference = "1.2.9";
  ct.frame_of_reference.clear();
  EXPECT_NE(error_of(seg, ct).find("another series"), std::string::npos) << error_of(seg, ct);
}

TEST_F(Seg, ErrorNamesWhyTheReferencedSeriesIsUnusable) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, at_z(0), block(0, 4)}};
  seg.series_uid = "1.2.4";
  CtReference ct = ct_with_slices();
  const auto error_with = [&](std::size_t images) {
    ct.images_of_series = [images](const std::string& uid) { return uid == "1.2.4" ? images : 99; };
    return error_of(seg, ct);
  };
  for (const char* frame : {"1.2.9", "1.2.8"}) {
    seg.frame_of_reference = frame;
    EXPECT_NE(error_with(0).find("not in the folder"), std::string::npos) << error_with(0);
    EXPECT_NE(error_with(1).find("only one image in the folder"), std::string::npos) << error_with(1);
    EXPECT_EQ(error_with(1).find("--series UID"), std::string::npos) << error_with(1);
    EXPECT_NE(error_with(2).find("--series UID"), std::string::npos) << error_with(2);
    EXPECT_EQ(error_with(2).find("in the folder"), std::string::npos) << error_with(2);
    // The option is named only where it would help.
    for (const std::size_t images : {0, 1, 2})
      EXPECT_EQ(error_with(images).find("--sibling-series") != std::string::npos, seg.frame_of_reference == "1.2.9");
  }
}

TEST_F(Seg, NamesTheDefectOfARefusedFile) {
  const auto changed = [&](const std::function<void(TestSeg&)>& change) {
    TestSeg seg;
    seg.segments = {segment_item(1, "Liver")};
    seg.frames = {{1, at_z(0), block(0, 4)}, {1, at_z(2), block(0, 4)}};
    change(seg);
    return error_of(seg);
  };
  EXPECT_EQ(changed([](TestSeg&) {}), "read");
  EXPECT_NE(changed([](TestSeg& s) { s.segments.clear(); }).find("names no segment"), std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.segments.push_back(s.segments[0]); }).find("two segments have the number 1"),
            std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.type = "SURFACE"; }).find("unknown type \"SURFACE\""), std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.bits = 16; }).find("16 bits"), std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.sop_class = "1.2.840.10008.5.1.4.1.1.66.5"; }).find("surface"),
            std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.frames[1].origin_P = at_z(0) + 3 * Vec3::UnitX(); }).find("shifted sideways"),
            std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) {
              s.frames.push_back({1, at_z(4), block(0, 4)});
              s.frames.push_back({1, at_z(5e4), block(0, 4)});
            }).find("too far apart"),
            std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.frames[1].origin_P = at_z(1e40); }).find("not those of a scan"),
            std::string::npos);
  EXPECT_NE(changed([](TestSeg& s) { s.R_PV.col(0) = s.R_PV.col(1); }).find("directions"), std::string::npos);
}

TEST_F(Seg, ReadsOrRefusesDamagedFilesInOneLine) {
  // Every length of the file, and every byte with another value: no crash, no exception, no line without a file.
  TestSeg seg;
  seg.columns = 4;
  seg.rows = 2;
  seg.segments = {segment_item(1, "Liver", trocar::testing::dicom_code(0x0062, 0x000f, "10200004", "SCT", "Liver"))};
  seg.frames = {{1, at_z(0), block(0, 4)}, {1, at_z(4), block(0, 4)}};
  std::size_t refused = 0;
  std::size_t accepted = 0;
  for (const Length length : {Length::kDefined, Length::kUndefined}) {
    seg.length = length;
    const std::string whole = trocar::testing::dicom_file(trocar::testing::seg_elements(seg));
    const auto expect_verdict = [&](const std::string& bytes) {
      std::ofstream(folder_ / "label.seg", std::ios::binary)
          .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      const auto result = read_segmentation(folder_ / "label.seg", ct_with_slices(), every_segment);
      ++(result ? accepted : refused);
      if (result) return;
      ASSERT_NE(result.error().where.find("label.seg"), std::string::npos) << result.error().text();
      ASSERT_FALSE(result.error().advice.empty()) << result.error().text();
      ASSERT_EQ(result.error().text().find('\n'), std::string::npos);
    };
    for (std::size_t size = 1; size < whole.size(); ++size) expect_verdict(whole.substr(0, size));
    for (std::size_t at = 132; at < whole.size(); ++at) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(std::array{0x00, 0xff, whole[at] ^ 0x20, whole[at] + 1}[at % 4]);
      expect_verdict(bytes);
    }
  }
  EXPECT_GT(refused, 1000U);
  EXPECT_GT(accepted, 400U);
}

}  // namespace
}  // namespace trocar::dicom
