// Planes of a SEG and slices of the CT: each plane has its thickness, wherever it lies.
#include <gtest/gtest.h>

#include "dicom/segmentation/test/seg_fixture.h"

namespace trocar::dicom {
namespace {

using seg_test::at_z;
using seg_test::block;
using seg_test::count_at;
using seg_test::ct_with_slices;
using seg_test::Seg;
using seg_test::voxels_of;
using trocar::testing::segment_item;
using trocar::testing::TestFrame;
using trocar::testing::TestSeg;

/// Slices of a CT that have voxels of the first segment, which is 5 pixels wide in each of its planes.
std::vector<double> filled_slices(const Result<Segmentation>& segmentation, const std::vector<double>& slices_mm) {
  std::vector<double> filled;
  if (!segmentation) return filled;
  const auto voxels = voxels_of(*segmentation, 0);
  for (const double z : slices_mm)
    if (const std::size_t count = count_at(voxels, z); count > 0) {
      EXPECT_EQ(count, 5U * 6) << z;
      filled.push_back(z);
    }
  EXPECT_EQ(voxels.size(), filled.size() * 5 * 6);
  return filled;
}

TestSeg drawn_at(const std::vector<double>& places_mm) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  for (const double z : places_mm) seg.frames.push_back({1, at_z(z), block(0, 4)});
  return seg;
}

TEST_F(Seg, UsesTheFilesSliceStepWithoutCtSlices) {
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, at_z(0), block(0, 4)}, {1, at_z(6), block(0, 4)}};
  const CtReference other_format = ct_with_slices({});
  // Two frames 6 mm apart without a step are two thick planes; with a step of 2 mm, two planes between them are empty.
  EXPECT_EQ(read(seg, other_format)->volumes[0].labels.geometry.size[2], 2);
  seg.slice_step_mm = 2.0;
  const auto stepped = read(seg, other_format);
  ASSERT_TRUE(stepped) << stepped.error().text();
  EXPECT_EQ(stepped->volumes[0].labels.geometry.size[2], 4);
  EXPECT_EQ(count_at(voxels_of(*stepped, 0), 2), 0U);
  // A single frame is as thick as a slice of the CT.
  seg.slice_step_mm = 0.0;
  seg.frames.resize(1);
  EXPECT_EQ(read(seg, other_format)->volumes[0].labels.geometry.spacing_mm.z(), 2.0);
}

TEST_F(Seg, KeepsTheExtentOfUnevenSlices) {
  // Slices at 0, 2, 4, 8, 12: the plane at 8 reaches from 6 to 10.
  TestSeg seg;
  seg.segments = {segment_item(1, "Liver")};
  seg.frames = {{1, at_z(2), block(0, 0)}, {1, at_z(8), block(0, 0)}};
  const auto read_seg = read(seg, ct_with_slices({0, 2, 4, 8, 12}));
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  ASSERT_EQ(read_seg->warnings.size(), 2U);  // uneven, and a gap of 6 mm
  EXPECT_NE(read_seg->warnings[0].find("uneven"), std::string::npos) << read_seg->warnings[0];
  const auto voxels = voxels_of(*read_seg, 0);
  EXPECT_EQ(count_at(voxels, 2), 6U);
  EXPECT_EQ(count_at(voxels, 4), 0U);
  EXPECT_EQ(count_at(voxels, 6), 6U);
  EXPECT_EQ(count_at(voxels, 8), 6U);
}

TEST_F(Seg, ThickPlanesFillTheSlicesOfAThinnerCt) {
  std::vector<double> slices_mm;
  for (int n = 0; n < 24; ++n) slices_mm.push_back(n);
  const auto filled = [&](const TestSeg& seg) {
    return filled_slices(read(seg, ct_with_slices(slices_mm)), slices_mm);
  };
  // 3 mm on 1 mm: in a row, with planes left out, at distances that are no multiples of 3 mm, at the end of the CT.
  TestSeg seg = drawn_at({3, 6, 12, 16, 23});
  seg.slice_step_mm = 3.0;
  const std::vector<double> expected{2, 3, 4, 5, 6, 7, 11, 12, 13, 15, 16, 17, 22, 23};
  EXPECT_EQ(filled(seg), expected);
  const auto told = read(seg, ct_with_slices(slices_mm));
  ASSERT_FALSE(told->warnings.empty());
  EXPECT_NE(told->warnings[0].find("3.00 mm thick, the CT's slices 1.00 mm apart"), std::string::npos)
      << told->warnings[0];
  // SpacingBetweenSlices counts before SliceThickness, which counts alone, too.
  seg.thickness_mm = 7.0;
  EXPECT_EQ(filled(seg), expected);
  seg.slice_step_mm = 0.0;
  seg.thickness_mm = 3.0;
  EXPECT_EQ(filled(seg), expected);
  // An even number of slices: one of the two half-way; no slice counts twice or stays empty.
  TestSeg even = drawn_at({2, 4, 6});
  even.slice_step_mm = 2.0;
  EXPECT_EQ(filled(even), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  // Thick planes that overlap reach half-way; a single one has its thickness.
  TestSeg overlapping = drawn_at({6, 9, 12});
  overlapping.thickness_mm = 5.0;
  EXPECT_EQ(filled(overlapping), (std::vector<double>{4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}));
  TestSeg single = drawn_at({6});
  single.slice_step_mm = 5.0;
  EXPECT_EQ(filled(single), (std::vector<double>{4, 5, 6, 7, 8}));
}

TEST_F(Seg, ThickPlanesOfALabelMapFillThinnerSlices) {
  TestSeg seg;
  seg.type = "LABELMAP";
  seg.bits = 8;
  seg.slice_step_mm = 4.0;
  seg.segments = {segment_item(3, "Liver"), segment_item(7, "Spleen")};
  seg.frames = {{0, at_z(4), [](int i, int) { return i < 2 ? 3 : 7; }}, {0, at_z(8), block(0, 4, 7)}};
  const auto read_seg = read(seg, ct_with_slices({0, 2, 4, 6, 8, 10, 12}));
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  EXPECT_EQ(voxels_of(*read_seg, 0).size(), 2U * 2 * 6);  // 2, 4
  EXPECT_EQ(voxels_of(*read_seg, 1).size(), 2U * 6 * 6 + 2U * 5 * 6);
}

TEST_F(Seg, PlanesOnAdjacentSlicesAreOneSliceThick) {
  // Overlapping reconstructions are thicker than their distance.
  const std::vector<double> slices_mm{0, 2, 4, 6, 8, 10, 12};
  TestSeg seg = drawn_at({4, 6, 10});
  for (const double thickness_mm : {5.0, 2.0, 1.0}) {
    seg.thickness_mm = thickness_mm;
    EXPECT_EQ(filled_slices(read(seg, ct_with_slices(slices_mm)), slices_mm), (std::vector<double>{4, 6, 10}));
    seg.slice_step_mm = thickness_mm;
    EXPECT_EQ(filled_slices(read(seg, ct_with_slices(slices_mm)), slices_mm), (std::vector<double>{4, 6, 10}));
    seg.slice_step_mm = 0.0;
  }
  // Frames that state different distances state none.
  TestSeg mixed = drawn_at({4, 6, 10});
  for (TestFrame& frame : mixed.frames) frame.spacing_mm = {1.0, 1.0};
  mixed.frames[0].slice_step_mm = 6.0;
  mixed.frames[1].slice_step_mm = 2.0;
  EXPECT_EQ(filled_slices(read(mixed, ct_with_slices(slices_mm)), slices_mm), (std::vector<double>{4, 6, 10}));
  mixed = drawn_at({2, 10});
  for (TestFrame& frame : mixed.frames) frame.spacing_mm = {1.0, 1.0};
  mixed.frames[0].slice_step_mm = 6.0;
  EXPECT_EQ(filled_slices(read(mixed, ct_with_slices(slices_mm)), slices_mm), (std::vector<double>{2, 10}));
  // A slice of the CT is missing beside a plane: 5 mm are not thicker than its other distance.
  TestSeg uneven = drawn_at({5, 10, 20, 30});
  uneven.slice_step_mm = 5.0;
  const auto read_seg = read(uneven, ct_with_slices({0, 5, 10, 20, 30, 40}));
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  for (const double z : {5, 10, 15, 20, 25, 30}) EXPECT_EQ(count_at(voxels_of(*read_seg, 0), z), 5U * 6) << z;
}

TEST_F(Seg, StructuresOfStripesAreRefused) {
  // Drawn on every second slice, of the thickness of a slice: nothing tells that the slices between belong to it.
  const std::vector<double> slices_mm{0, 2, 4, 6, 8, 10, 12};
  TestSeg seg = drawn_at({0, 4, 8, 12});
  seg.slice_step_mm = 2.0;
  for (const CtReference& ct : {ct_with_slices(slices_mm), ct_with_slices({})}) {
    const std::string error = error_of(seg, ct);
    EXPECT_NE(error.find("\"Liver\" (3 gaps between 4 planes, up to 4.0 mm from plane to plane)"), std::string::npos)
        << error;
  }
  // The same with empty frames between, and beside another structure.
  for (const double z : {2, 6}) seg.frames.push_back({1, at_z(z), block(9, 9)});
  seg.segments.push_back(segment_item(2, "Spleen"));
  for (const double z : slices_mm) seg.frames.push_back({2, at_z(z), block(6, 7)});
  EXPECT_NE(error_of(seg, ct_with_slices(slices_mm)).find("\"Liver\" (3 gaps"), std::string::npos);
  seg.frames.push_back({1, at_z(2), block(0, 4)});
  seg.frames.push_back({1, at_z(6), block(0, 4)});
  EXPECT_EQ(error_of(seg, ct_with_slices(slices_mm)), "read");
}

TEST_F(Seg, ReportsEmptyPlanesWithinAStructure) {
  const std::vector<double> slices_mm{0, 2, 4, 6, 8, 10, 12};
  const auto told = read(drawn_at({0, 2, 6, 8, 12}), ct_with_slices(slices_mm));
  EXPECT_EQ(filled_slices(told, slices_mm), (std::vector<double>{0, 2, 6, 8, 12}));
  ASSERT_EQ(told->warnings.size(), 1U);
  EXPECT_NE(told->warnings[0].find("\"Liver\": left empty: 2 gaps between 5 planes, up to 4.0 mm"), std::string::npos)
      << told->warnings[0];
  // Whole structures, separate parts far apart or beside each other have none.
  TestSeg seg = drawn_at({});
  for (const auto& frames : std::vector<std::vector<TestFrame>>{
           {{1, at_z(0), block(0, 4)}, {1, at_z(2), block(0, 4)}, {1, at_z(12), block(0, 4)}},
           {{1, at_z(0), block(0, 2)}, {1, at_z(4), block(3, 4)}}}) {
    seg.frames = frames;
    EXPECT_TRUE(read(seg, ct_with_slices(slices_mm))->warnings.empty());
  }
}

TEST_F(Seg, ObliqueFramesKeepTheirDirections) {
  TestSeg seg;
  seg.R_PV = (Eigen::AngleAxisd(0.4, Vec3::UnitX()) * Eigen::AngleAxisd(0.2, Vec3::UnitZ())).toRotationMatrix();
  seg.segments = {segment_item(1, "Liver")};
  for (const double along_mm : {3.0, 0.0, 1.5})
    seg.frames.push_back({1, Vec3(1, 2, 3) + along_mm * seg.R_PV.col(2), block(0, 4)});
  const auto read_seg = read(seg);
  ASSERT_TRUE(read_seg) << read_seg.error().text();
  const volume::GridGeometry& g = read_seg->volumes.at(0).labels.geometry;
  EXPECT_LT((g.R_PV - seg.R_PV).norm(), 1e-6);
  EXPECT_LT((g.origin_P - Vec3(1, 2, 3)).norm(), 1e-6);
  EXPECT_NEAR(g.spacing_mm.z(), 1.5, 1e-6);
  EXPECT_EQ(g.size[2], 3);
}

TEST_F(Seg, KeepsPositionsOfAThinSlicedSiblingSeries) {
  // Slices of 0.5 mm beside those of the CT, 2 mm apart: the volume is 5 x 6 x 4 mm.
  TestSeg seg;
  seg.series_uid = "1.2.4";
  seg.segments = {segment_item(1, "Liver")};
  for (int n = 0; n < 8; ++n) seg.frames.push_back({1, at_z(2.25 + 0.5 * n), block(0, 4)});
  CtReference ct = ct_with_slices();
  ct.accepts_sibling = true;
  const auto sibling = read(seg, ct);
  ASSERT_TRUE(sibling) << sibling.error().text();
  const auto voxels = voxels_of(*sibling, 0);
  EXPECT_DOUBLE_EQ(static_cast<double>(voxels.size()) * sibling->volumes[0].labels.geometry.voxel_volume_mm3(), 120.0);
  for (const auto& voxel : voxels) EXPECT_TRUE(voxel[2] > 2.2 && voxel[2] < 5.8) << voxel[2];
}

}  // namespace
}  // namespace trocar::dicom
