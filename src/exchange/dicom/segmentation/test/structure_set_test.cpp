#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/files/folders.h"
#include "dicom/segmentation/segmentation.h"
#include "dicom/testing/segmentation_writer.h"

namespace trocar::dicom {
namespace {

using trocar::testing::TestStructure;
using Points = std::vector<Vec3>;

constexpr const char* kClosed = "CLOSED_PLANAR";

/// A CT of 40 x 30 x 10 voxels of 1 x 1 x 3 mm.
CtReference turned_ct(const Mat3& R_PV = Mat3::Identity()) {
  CtReference ct;
  ct.grid.size = {40, 30, 10};
  ct.grid.spacing_mm = {1, 1, 3};
  ct.grid.origin_P = {-20, -15, 50};
  ct.grid.R_PV = R_PV;
  ct.series_uid = "1.2.3";
  ct.frame_of_reference = "1.2.9";
  return ct;
}

/// A rectangle in indices of the CT's grid: columns [u0, u1), rows [v0, v1), plane w.
Points rectangle(const CtReference& ct, double u0, double u1, double v0, double v1, double w) {
  Points points;
  for (const auto& [u, v] : {std::pair{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}})
    points.push_back(ct.grid.to_mm({u - 0.5, v - 0.5, w}));
  return points;
}

bool every_structure(const Segment&) {
  return true;
}

class StructureSet : public ::testing::Test {
 protected:
  Result<Segmentation> read(const std::vector<TestStructure>& structures, const CtReference& ct = turned_ct()) {
    trocar::testing::write_dicom(folder_ / "rs.dcm", trocar::testing::structure_set_elements(structures));
    return read_segmentation(folder_ / "rs.dcm", ct, every_structure);
  }
  std::string error_of(const std::vector<TestStructure>& structures) {
    const auto segmentation = read(structures);
    return segmentation ? "read" : segmentation.error().text();
  }
  TemporaryFolder folder_;
};

/// Voxels of a structure in each plane of the CT.
std::vector<std::size_t> voxels_by_plane(const Segmentation& segmentation, std::size_t structure, int axis = 2) {
  std::vector<std::size_t> counts;
  for (const SegmentVolume& volume : segmentation.volumes) {
    const auto& g = volume.labels.geometry;
    counts.resize(static_cast<std::size_t>(g.size[static_cast<std::size_t>(axis)]));
    for (std::size_t n = 0; n < volume.labels.voxels.size(); ++n) {
      const std::uint8_t value = volume.labels.voxels[n];
      if (value != 0 && volume.segments.at(value - 1U) == structure)
        ++counts[static_cast<std::size_t>(g.index_of(n)[static_cast<std::size_t>(axis)])];
    }
  }
  return counts;
}

TEST_F(StructureSet, ContoursFillTheirPlanes) {
  const CtReference ct = turned_ct();
  const auto read_set =
      read({{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}, {kClosed, rectangle(ct, 5, 10, 5, 10, 3)}}}});
  ASSERT_TRUE(read_set) << read_set.error().text();
  EXPECT_EQ(voxels_by_plane(*read_set, 0), (std::vector<std::size_t>{0, 0, 50, 25, 0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(read_set->warnings.empty());
}

TEST_F(StructureSet, ContourInsideAnotherIsAHole) {
  const CtReference ct = turned_ct();
  for (const char* type : {kClosed, "CLOSEDPLANAR_XOR"}) {
    const auto ring = read({{"Colon",
                             {{type, rectangle(ct, 5, 25, 5, 25, 2)},
                              {type, rectangle(ct, 10, 20, 10, 20, 2)},
                              {type, rectangle(ct, 12, 14, 12, 14, 2)},
                              {type, rectangle(ct, 30, 35, 5, 10, 2)}}}});
    ASSERT_TRUE(ring) << ring.error().text();
    EXPECT_EQ(voxels_by_plane(*ring, 0)[2], 400U - 100 + 4 + 25) << type;
  }
  // The keyhole technique: one outline that goes in and out along one line.
  const Points outer = rectangle(ct, 5, 25, 5, 25, 2);
  const Points inner = rectangle(ct, 10, 20, 10, 20, 2);
  Points keyhole = outer;
  keyhole.push_back(outer[0]);
  for (const std::size_t n : {0U, 3U, 2U, 1U, 0U}) keyhole.push_back(inner[n]);
  const auto read_set = read({{"Colon", {{kClosed, keyhole}}}});
  ASSERT_TRUE(read_set) << read_set.error().text();
  EXPECT_EQ(voxels_by_plane(*read_set, 0)[2], 300U);
}

TEST_F(StructureSet, ARoundContourHasItsVolume) {
  const CtReference ct = turned_ct();
  TestStructure sphere{"Liver", {}};
  constexpr double kRadius_mm = 12.0;
  const Vec3 centre_P = ct.grid.to_mm({20, 15, 5});
  for (int w = 1; w < 10; ++w) {
    const double z_mm = 3.0 * (w - 5);
    if (std::abs(z_mm) >= kRadius_mm) continue;
    const double r_mm = std::sqrt(kRadius_mm * kRadius_mm - z_mm * z_mm);
    Points circle;
    for (int n = 0; n < 72; ++n)
      circle.push_back(centre_P + Vec3(r_mm * std::cos(n * M_PI / 36), r_mm * std::sin(n * M_PI / 36), z_mm));
    sphere.contours.emplace_back(kClosed, circle);
  }
  const auto read_set = read({sphere});
  ASSERT_TRUE(read_set) << read_set.error().text();
  double volume_mm3 = 0.0;
  for (const std::size_t count : voxels_by_plane(*read_set, 0)) volume_mm3 += 3.0 * static_cast<double>(count);
  // Discs of 3 mm: 98.4 % of the sphere, as the caps are missing. Pixels of 1 mm along the outlines are uncertain by 2
  // %.
  const double discs_mm3 = 3.0 * M_PI * (7.0 * kRadius_mm * kRadius_mm - 2.0 * (9.0 + 36.0 + 81.0));
  EXPECT_NEAR(volume_mm3 / discs_mm3, 1.0, 0.02);
}

TEST_F(StructureSet, ContoursBetweenSlicesReachHalfwayToTheNext) {
  const CtReference ct = turned_ct();
  // Contours on every other slice of the CT, and between slices.
  const auto every_other =
      read({{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}, {kClosed, rectangle(ct, 5, 10, 5, 10, 4)}}}});
  EXPECT_EQ(voxels_by_plane(*every_other, 0), (std::vector<std::size_t>{0, 50, 50, 25, 25, 0, 0, 0, 0, 0}));
  const auto between =
      read({{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2.4)}, {kClosed, rectangle(ct, 5, 10, 5, 10, 3.4)}}}});
  EXPECT_EQ(voxels_by_plane(*between, 0), (std::vector<std::size_t>{0, 0, 50, 25, 0, 0, 0, 0, 0, 0}));
  // Finer than the CT: the nearest contour counts.
  TestStructure fine{"Liver", {}};
  for (int n = 0; n <= 10; ++n)
    fine.contours.emplace_back(kClosed, rectangle(ct, 5, n == 5 ? 10 : 15, 5, 10, 2 + 0.2 * n));
  EXPECT_EQ(voxels_by_plane(*read({fine}), 0), (std::vector<std::size_t>{0, 0, 50, 25, 50, 0, 0, 0, 0, 0}));
}

TEST_F(StructureSet, FillsOneMissingPlaneButNotAWideGap) {
  const CtReference ct = turned_ct();
  TestStructure structure{"Liver", {}};
  for (const int w : {0, 1, 3, 7, 8}) structure.contours.emplace_back(kClosed, rectangle(ct, 5, 15, 5, 10, w));
  const auto read_set = read({structure});
  ASSERT_TRUE(read_set) << read_set.error().text();
  EXPECT_EQ(voxels_by_plane(*read_set, 0), (std::vector<std::size_t>{50, 50, 50, 50, 0, 0, 0, 50, 50, 0}));
  ASSERT_EQ(read_set->warnings.size(), 2U);
  EXPECT_NE(read_set->warnings[0].find("\"Liver\": 1 gap between contours filled, of up to 6.0 mm"), std::string::npos)
      << read_set->warnings[0];
  EXPECT_NE(read_set->warnings[1].find("\"Liver\": 1 gap between contours left empty, of 12.0 mm or more"),
            std::string::npos)
      << read_set->warnings[1];
}

TEST_F(StructureSet, SkipsRepeatedAndDegenerateContours) {
  const CtReference ct = turned_ct();
  const auto read_set = read({{"Liver",
                               {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)},
                                {kClosed, rectangle(ct, 5, 15, 5, 10, 2)},
                                {kClosed, {ct.grid.to_mm({1, 1, 2}), ct.grid.to_mm({2, 1, 2})}}}}});
  ASSERT_TRUE(read_set) << read_set.error().text();
  EXPECT_EQ(voxels_by_plane(*read_set, 0)[2], 50U);
  EXPECT_EQ(read_set->warnings.size(), 2U);
}

TEST_F(StructureSet, ReportsOverlappingContours) {
  const CtReference ct = turned_ct();
  const auto warnings_of = [&](const char* type) {
    const auto parts =
        read({{"Liver", {{type, rectangle(ct, 0, 20, 0, 20, 2)}, {type, rectangle(ct, 10, 30, 0, 20, 2)}}}});
    return parts ? parts->warnings : std::vector<std::string>{parts.error().text()};
  };
  // 10 x 20 x 3 mm.
  EXPECT_EQ(
      warnings_of(kClosed),
      (std::vector<std::string>{"\"Liver\": 1 pair of contours cross in their plane: the 0.6 ml in both are inside"}));
  EXPECT_NE(warnings_of("CLOSEDPLANAR_XOR").at(0).find("0.6 ml in both are outside"), std::string::npos);
  const auto ring =
      read({{"Liver", {{kClosed, rectangle(ct, 0, 30, 0, 30, 2)}, {kClosed, rectangle(ct, 1, 29, 1, 29, 2)}}}});
  ASSERT_EQ(ring->warnings.size(), 1U);
  EXPECT_NE(ring->warnings[0].find("1 hole of 2."), std::string::npos) << ring->warnings[0];
}

TEST_F(StructureSet, ReadsContoursInAnyPlane) {
  // On an oblique CT: contours in its slices, in its sagittal planes, and in no plane of it.
  const Mat3 R = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(0.5, Vec3::UnitZ())).toRotationMatrix();
  const CtReference ct = turned_ct(R);
  const auto in_slices = read({{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}}}}, ct);
  ASSERT_TRUE(in_slices) << in_slices.error().text();
  EXPECT_EQ(voxels_by_plane(*in_slices, 0)[2], 50U);

  Points sagittal;  // rows 5 to 9, planes 2 to 4 of column 7
  for (const auto& [v, w] : {std::pair{4.5, 1.5}, {9.5, 1.5}, {9.5, 4.5}, {4.5, 4.5}})
    sagittal.push_back(ct.grid.to_mm({7.0, v, w}));
  const auto across = read({{"Liver", {{kClosed, sagittal}}}}, ct);
  ASSERT_TRUE(across) << across.error().text();
  EXPECT_EQ(voxels_by_plane(*across, 0, 0)[7], 15U);

  TestStructure tilted{"Liver", {}};
  const Mat3 R_PC = (Eigen::AngleAxisd(0.6, Vec3::UnitY()) * Eigen::AngleAxisd(0.5, Vec3::UnitX())).toRotationMatrix();
  for (int n = 0; n < 6; ++n) {
    Points square;
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {10.0, 0.0}, {10.0, 8.0}, {0.0, 8.0}})
      square.push_back(ct.grid.to_mm({20, 15, 5}) + R_PC * Vec3(u, v, 2.0 * n));
    tilted.contours.emplace_back(kClosed, square);
  }
  const auto oblique = read({tilted}, ct);
  ASSERT_TRUE(oblique) << oblique.error().text();
  ASSERT_EQ(oblique->volumes.size(), 1U);
  const volume::LabelGrid& labels = oblique->volumes[0].labels;
  const auto inside = static_cast<double>(std::count(labels.voxels.begin(), labels.voxels.end(), 1));
  // A block of 10 x 8 x 12 mm; the border of pixels of 1 mm is uncertain by half a pixel.
  EXPECT_NEAR(inside * labels.geometry.voxel_volume_mm3(), 10.0 * 8.0 * 12.0, 0.12 * 960.0);
}

TEST_F(StructureSet, RefusesOpenContoursByName) {
  const CtReference ct = turned_ct();
  const Points square = rectangle(ct, 5, 15, 5, 10, 2);
  const std::string error = error_of({{"Liver", {{kClosed, square}}},
                                      {"Catheter", {{"OPEN_PLANAR", square}}},
                                      {"Isocentre", {{"POINT", {square[0]}}}},
                                      {"Wire", {{"OPEN_NONPLANAR", square}}}});
  EXPECT_NE(error.find("\"Catheter\" (OPEN_PLANAR), \"Isocentre\" (POINT), \"Wire\" (OPEN_NONPLANAR)"),
            std::string::npos)
      << error;
  EXPECT_EQ(error.find("Liver"), std::string::npos) << error;
  // An arc of a half circle that says it is closed.
  Points arc;
  for (int n = 0; n <= 30; ++n)
    arc.push_back(ct.grid.to_mm({20 + 10 * std::cos(n * M_PI / 30), 15 + 10 * std::sin(n * M_PI / 30), 2}));
  EXPECT_NE(error_of({{"Spleen", {{kClosed, arc}}}}).find("\"Spleen\" (CLOSED_PLANAR, but its ends are 20 mm apart)"),
            std::string::npos)
      << error_of({{"Spleen", {{kClosed, arc}}}});
  // A structure that is not wanted does not matter.
  trocar::testing::write_dicom(
      folder_ / "rs.dcm",
      trocar::testing::structure_set_elements({{"Liver", {{kClosed, square}}}, {"Wire", {{"POINT", square}}}}));
  EXPECT_TRUE(read_segmentation(folder_ / "rs.dcm", ct, [](const Segment& s) { return s.name == "Liver"; }));
}

TEST_F(StructureSet, RefusesNonPlanarContours) {
  const CtReference ct = turned_ct();
  Points bent = rectangle(ct, 5, 15, 5, 10, 2);
  bent[2].z() += 4.0;
  EXPECT_NE(error_of({{"Liver", {{kClosed, bent}}}}).find("contour 1 of \"Liver\" is not planar"), std::string::npos);
}

TEST_F(StructureSet, RefusesAnotherSeries) {
  const CtReference ct = turned_ct();
  const std::vector<TestStructure> liver{{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}}}};
  const auto error_with = [&](const std::string& series, const std::string& frame) {
    trocar::testing::write_dicom(folder_ / "rs.dcm", trocar::testing::structure_set_elements(liver, series, frame));
    const auto result = read_segmentation(folder_ / "rs.dcm", ct, every_structure);
    return result ? "read" : result.error().text();
  };
  EXPECT_EQ(error_with("1.2.3", "1.2.9"), "read");
  EXPECT_EQ(error_with("", "1.2.9"), "read");
  EXPECT_NE(error_with("1.2.4", "1.2.9").find("another series"), std::string::npos);
  EXPECT_NE(error_with("", "1.2.8").find("another frame of reference"), std::string::npos);
}

TEST_F(StructureSet, RefusesAmbiguousStructureNumbers) {
  const CtReference ct = turned_ct();
  const std::vector<std::pair<std::string, Points>> square{{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}};
  EXPECT_EQ(error_of({{"Liver", square, "7"}, {"Spleen", square, "9"}}), "read");
  EXPECT_NE(error_of({{"Liver", square, "3"}, {"Kidney", square, "4"}, {"Spleen", square, "3"}})
                .find("\"Liver\" and \"Spleen\" have the same number 3"),
            std::string::npos);
  for (const char* number : {"", "one", "99999999999"})
    EXPECT_NE(error_of({{"Liver", square}, {"Spleen", square, number}}).find("\"Spleen\" has no number"),
              std::string::npos)
        << number;
  EXPECT_NE(
      error_of({{"Liver", square}, {"Spleen", square, "2", "5"}}).find("1 contour of the structure number 5, which"),
      std::string::npos);
  EXPECT_NE(error_of({{"Liver", square}, {"Spleen", square, "2", ""}}).find("1 contour without the number"),
            std::string::npos);
  EXPECT_EQ(error_of({{"Liver", square}, {"Spleen", {}, "2", "5"}}), "read");  // a list without contours
  // Two lists of one structure are one.
  const auto both = read({{"Liver", square}, {"Spleen", {{kClosed, rectangle(ct, 5, 15, 5, 10, 4)}}, "2", "1"}});
  ASSERT_TRUE(both) << both.error().text();
  EXPECT_EQ(voxels_by_plane(*both, 0)[2] + voxels_by_plane(*both, 0)[4], 100U);
}

TEST_F(StructureSet, RefusesAStructureInAnotherFrameOfReference) {
  const CtReference ct = turned_ct();
  const std::vector<std::pair<std::string, Points>> square{{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}};
  const auto with_frame = [&](const std::string& name, const std::string& frame) {
    TestStructure structure{name, square};
    structure.frame_of_reference = frame;
    return structure;
  };
  EXPECT_EQ(error_of({with_frame("Liver", "1.2.9"), with_frame("Spleen", "")}), "read");
  const std::string error = error_of({with_frame("Liver", "1.2.9"), with_frame("Spleen", "1.2.66")});
  for (const char* part : {"\"Spleen\" (number 2)", "(1.2.66) than the CT (1.2.9)"})
    EXPECT_NE(error.find(part), std::string::npos) << error;
  // Without contours, or not wanted, it does not matter.
  TestStructure empty = with_frame("Spleen", "1.2.66");
  empty.contours.clear();
  EXPECT_EQ(error_of({with_frame("Liver", "1.2.9"), empty}), "read");
  trocar::testing::write_dicom(folder_ / "rs.dcm", trocar::testing::structure_set_elements(
                                                       {with_frame("Liver", "1.2.9"), with_frame("Spleen", "1.2.66")}));
  EXPECT_TRUE(read_segmentation(folder_ / "rs.dcm", ct, [](const Segment& s) { return s.name == "Liver"; }));
  // On a CT without one, all have the same.
  CtReference other_format = ct;
  other_format.frame_of_reference.clear();
  const auto on_other = read({with_frame("Liver", "1.2.9"), with_frame("Spleen", "1.2.66")}, other_format);
  ASSERT_FALSE(on_other);
  EXPECT_NE(on_other.error().text().find("than \"Liver\" (1.2.9)"), std::string::npos) << on_other.error().text();
  EXPECT_TRUE(read({with_frame("Liver", "1.2.66"), with_frame("Spleen", "1.2.66")}, other_format));
}

TEST_F(StructureSet, NamesAreUtf8) {
  const CtReference ct = turned_ct();
  const auto read_set = read({{"L\xe9sion", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}}}});  // ISO 8859-1
  ASSERT_TRUE(read_set) << read_set.error().text();
  EXPECT_EQ(read_set->segments[0].name, "L\xc3\xa9sion");
}

TEST_F(StructureSet, ReadsOrRefusesDamagedFilesInOneLine) {
  const CtReference ct = turned_ct();
  std::size_t refused = 0;
  std::size_t accepted = 0;
  for (const trocar::testing::Length length :
       {trocar::testing::Length::kDefined, trocar::testing::Length::kUndefined}) {
    const std::string whole = trocar::testing::dicom_file(trocar::testing::structure_set_elements(
        {{"Liver", {{kClosed, rectangle(ct, 5, 15, 5, 10, 2)}, {kClosed, rectangle(ct, 6, 9, 6, 9, 3)}}}}, "1.2.3",
        "1.2.9", length));
    const auto expect_verdict = [&](const std::string& bytes) {
      std::ofstream(folder_ / "rs.dcm", std::ios::binary)
          .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      const auto result = read_segmentation(folder_ / "rs.dcm", ct, every_structure);
      ++(result ? accepted : refused);
      if (result) return;
      ASSERT_NE(result.error().where.find("rs.dcm"), std::string::npos) << result.error().text();
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
  EXPECT_GT(accepted, 300U);
}

}  // namespace
}  // namespace trocar::dicom
