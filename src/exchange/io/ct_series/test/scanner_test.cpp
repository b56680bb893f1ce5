// Series as scanners and archives write them: generated folders, read by read_ct_scan.

#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "dicom/testing/dicom_writer.h"
#include "io/image/image_file.h"
#include "volume/sampling.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::CtSeries;
using testing::write_slice;
using testing::write_slices;

/// A field that is linear in space: linear interpolation gives it back without error but that of rounding to HU.
double linear_hu(const Vec3& p_P) {
  return 3.0 * p_P.x() - 2.0 * p_P.y() + 5.0 * p_P.z() + 40.0;
}

std::vector<Vec3> origins_at(const std::vector<double>& z_mm, const Vec3& lean_P = Vec3::Zero()) {
  std::vector<Vec3> origins_P;
  for (const double z : z_mm) origins_P.push_back(Vec3(-10.0, 20.0, 100.0) + Vec3::UnitZ() * z + lean_P * z);
  return origins_P;
}

/// Largest difference to the field over the voxels that hold no padding; infinite if too many do.
double worst_difference_hu(const volume::CtGrid& ct, double most_padding) {
  std::size_t padded = 0;
  double worst = 0.0;
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    // Voxels at the border of a tilted stack may blend with the padding.
    const auto ijk = ct.geometry.index_of(n);
    if (ct.voxels[n] < -900) {
      ++padded;
      continue;
    }
    worst = std::max(worst, std::abs(ct.voxels[n] - linear_hu(ct.geometry.centre_mm(ijk))));
  }
  const double share = static_cast<double>(padded) / static_cast<double>(ct.voxels.size());
  return share <= most_padding ? worst : HUGE_VAL;
}

TEST(Scanner, GantryTiltIsStraightenedWithAWarning) {
  const TemporaryFolder folder;
  CtSeries series;
  series.rows = 30;
  // As scanners write it: the slices are tilted by 20 degrees about x, the table moves along z.
  series.R_PV = Eigen::AngleAxisd(radians(20.0), Vec3::UnitX()).toRotationMatrix();
  write_slices(folder.path(), series, origins_at({0, 3, 6, 9, 12, 15}), linear_hu);
  const auto scan = read_ct_scan(folder.path());
  ASSERT_TRUE(scan) << scan.error().text();
  ASSERT_EQ(scan->warnings.size(), 1U);
  EXPECT_NE(scan->warnings[0].find("gantry tilt: the slices lean by 20.0 degrees"), std::string::npos);
  EXPECT_GT(scan->grid.geometry.size[1], 30);
  EXPECT_LT((scan->grid.geometry.R_PV - series.R_PV).norm(), 1e-6);
  // Half a HU of rounding in the files, half in the result, and edge values that continue for half a pixel (1 HU a mm).
  EXPECT_LT(worst_difference_hu(scan->grid, 0.25), 2.5);
  EXPECT_EQ(scan->slices_P.size(), 6U);
}

TEST(Scanner, ResamplesUnevenStepsWithAWarning) {
  const TemporaryFolder folder;
  write_slices(folder.path(), {}, origins_at({0, 2.5, 5, 7.5, 12.5, 17.5, 22.5}), linear_hu);
  const auto scan = read_ct_scan(folder.path());
  ASSERT_TRUE(scan) << scan.error().text();
  EXPECT_EQ(scan->grid.geometry.size, (std::array<std::int64_t, 3>{8, 6, 10}));
  EXPECT_NEAR(scan->grid.geometry.spacing_mm.z(), 2.5, 1e-9);
  EXPECT_LT(worst_difference_hu(scan->grid, 0.0), 1.01);
  ASSERT_EQ(scan->warnings.size(), 1U);
  EXPECT_NE(scan->warnings[0].find("uneven slice distances: 5 mm between slice3 and slice4"), std::string::npos)
      << scan->warnings[0];
}

TEST(Scanner, ThickObliqueAndLargeSlicesAreRead) {
  const TemporaryFolder folder;
  CtSeries series;
  series.R_PV = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(-0.4, Vec3::UnitZ())).toRotationMatrix();
  const Vec3 normal_P = series.R_PV.col(2);
  std::vector<Vec3> origins_P;
  for (int n = 0; n < 5; ++n) origins_P.push_back(Vec3(-10, 20, 100) + 5.0 * n * normal_P);
  write_slices(folder / "oblique", series, origins_P, linear_hu);
  const auto oblique = read_ct_scan(folder / "oblique");
  ASSERT_TRUE(oblique) << oblique.error().text();
  EXPECT_TRUE(oblique->warnings.empty());
  EXPECT_NEAR(oblique->grid.geometry.spacing_mm.z(), 5.0, 1e-6);
  EXPECT_LT(worst_difference_hu(oblique->grid, 0.0), 0.51);

  series = {};
  series.columns = series.rows = 1024;
  series.spacing_mm = 0.25;
  const auto small_hu = [](const Vec3& p_P) { return p_P.x() + p_P.y(); };
  write_slices(folder / "large", series, origins_at({0, 5, 10}), small_hu);
  const auto large = read_ct_scan(folder / "large");
  ASSERT_TRUE(large) << large.error().text();
  EXPECT_EQ(large->grid.geometry.size, (std::array<std::int64_t, 3>{1024, 1024, 3}));
}

TEST(Scanner, SkipsLocalizersInTheFolder) {
  const TemporaryFolder folder;
  write_slices(folder.path(), {}, origins_at({0, 2, 4, 6, 8, 10, 12, 14}), linear_hu);
  CtSeries scout;
  scout.series_uid = "1.2.4";
  scout.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
  // Two overviews (front and side) in a series of their own: no volume beside that of the slices.
  write_slices(folder / "scout", scout, origins_at({0, 40}), linear_hu);
  const auto own_series = read_ct_scan(folder.path());
  ASSERT_TRUE(own_series) << own_series.error().text();
  EXPECT_EQ(own_series->series_uid, "1.2.3");
  EXPECT_TRUE(own_series->warnings.empty());

  scout.series_uid = "1.2.3";
  write_slice(folder / "scout/2", scout, Vec3(-10, 20, 300), "1.2.3.99", linear_hu);
  const auto same_series = read_ct_scan(folder.path(), "1.2.3");
  ASSERT_TRUE(same_series) << same_series.error().text();
  EXPECT_EQ(same_series->grid.geometry.size[2], 8);
  ASSERT_EQ(same_series->warnings.size(), 1U);
  EXPECT_NE(same_series->warnings[0].find("overview"), std::string::npos);

  scout.image_type = "ORIGINAL\\PRIMARY";  // not marked: told by its direction
  scout.R_PV = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  write_slice(folder / "scout/2", scout, Vec3(-10, 20, 300), "1.2.3.99", linear_hu);
  const auto unmarked = read_ct_scan(folder.path(), "1.2.3");
  ASSERT_TRUE(unmarked) << unmarked.error().text();
  EXPECT_EQ(unmarked->grid.geometry.size[2], 8);
  ASSERT_EQ(unmarked->warnings.size(), 1U);
  EXPECT_NE(unmarked->warnings[0].find("another direction: 2"), std::string::npos) << unmarked->warnings[0];
}

TEST(Scanner, SkipsOnlyIdenticalCopiesOfASlice) {
  const TemporaryFolder folder;
  const auto origins_P = origins_at({0, 2, 4, 6});
  write_slices(folder.path(), {}, origins_P, linear_hu);
  fs::copy_file(folder / "slice1", folder / "slice1_copy");
  write_slice(folder / "sent_again", {}, origins_P[2], "1.2.3.77", linear_hu);  // a new instance of the same pixels
  const auto scan = read_ct_scan(folder.path());
  ASSERT_TRUE(scan) << scan.error().text();
  EXPECT_EQ(scan->grid.geometry.size[2], 4);
  ASSERT_EQ(scan->warnings.size(), 1U);
  EXPECT_NE(scan->warnings[0].find("copies of slices"), std::string::npos) << scan->warnings[0];

  write_slice(folder / "later", {}, origins_P[3], "1.2.3.78", [](const Vec3&) { return 7.0; });
  const auto two_times = read_ct_scan(folder.path());
  ASSERT_FALSE(two_times);
  EXPECT_NE(two_times.error().what.find("same position"), std::string::npos) << two_times.error().text();
}

/// An enhanced multi-frame CT: frames at these heights, in this order, each with an intercept of its own.
struct EnhancedCt {
  std::vector<double> z_mm{0, 2, 4, 6};
  std::vector<int> intercepts{-1024, -1000, -1024, -900};
  bool has_shared_place = false;  ///< A place of the top level, which is not that of a frame.
  std::size_t places = 4;         ///< Frames that the functional groups describe.

  std::string elements() const {
    using namespace testing;  // NOLINT: the writers of elements
    constexpr int kColumns = 8, kRows = 6;
    std::string pixels;
    std::vector<std::string> groups;
    for (std::size_t n = 0; n < z_mm.size(); ++n) {
      for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i)
          pixels += little_endian(
              static_cast<std::uint32_t>(static_cast<int>(linear_hu(Vec3(i, j, z_mm[n]))) - intercepts[n]), 2);
      if (n < places)
        groups.push_back(dicom_sequence(0x0020, 0x9113, {dicom_point(0x0020, 0x0032, Vec3(0, 0, z_mm[n]))}) +
                         dicom_sequence(0x0028, 0x9145,
                                        {dicom_decimals(0x0028, 0x1052, {static_cast<double>(intercepts[n])}) +
                                         dicom_decimals(0x0028, 0x1053, {1.0})}));
    }
    const std::string shared = dicom_sequence(0x0020, 0x9116, {dicom_decimals(0x0020, 0x0037, {1, 0, 0, 0, 1, 0})}) +
                               dicom_sequence(0x0028, 0x9110, {dicom_decimals(0x0028, 0x0030, {1.0, 1.0})});
    return dicom_element(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2.1") +
           dicom_element(0x0008, 0x0018, "UI", "1.2.5") + dicom_element(0x0008, 0x0060, "CS", "CT") +
           dicom_element(0x0020, 0x000e, "UI", "1.2.3") +
           (has_shared_place ? dicom_point(0x0020, 0x0032, Vec3(500, 500, 500)) : std::string()) +
           dicom_element(0x0020, 0x0052, "UI", "1.2.9") + dicom_short(0x0028, 0x0002, 1) +
           dicom_element(0x0028, 0x0004, "CS", "MONOCHROME2") +
           dicom_element(0x0028, 0x0008, "IS", std::to_string(z_mm.size())) + dicom_short(0x0028, 0x0010, kRows) +
           dicom_short(0x0028, 0x0011, kColumns) + dicom_short(0x0028, 0x0100, 16) + dicom_short(0x0028, 0x0101, 16) +
           dicom_short(0x0028, 0x0102, 15) + dicom_short(0x0028, 0x0103, 1) + dicom_sequence(0x5200, 0x9229, {shared}) +
           dicom_sequence(0x5200, 0x9230, groups) + dicom_element(0x7fe0, 0x0010, "OW", pixels);
  }
};

TEST(Scanner, FramesOfAnEnhancedFileAreSlices) {
  for (const bool has_shared_place : {false, true})
    for (const std::vector<double>& z_mm : {std::vector<double>{0, 2, 4, 6}, std::vector<double>{6, 0, 4, 2}}) {
      const TemporaryFolder folder;
      EnhancedCt enhanced;
      enhanced.z_mm = z_mm;
      enhanced.has_shared_place = has_shared_place;
      testing::write_dicom(folder / "all.dcm", enhanced.elements());
      const auto scan = read_ct_scan(folder.path());
      ASSERT_TRUE(scan) << scan.error().text();
      EXPECT_EQ(scan->grid.geometry.size, (std::array<std::int64_t, 3>{8, 6, 4}));
      EXPECT_NEAR(scan->grid.geometry.spacing_mm.z(), 2.0, 1e-9);
      EXPECT_LT(worst_difference_hu(scan->grid, 0.0), 0.5);
      EXPECT_EQ(scan->slices_P.size(), 4U);
      EXPECT_TRUE(scan->warnings.empty());
    }
}

TEST(Scanner, EnhancedFilesThatContradictThemselvesAreRefused) {
  const auto error_of = [](const EnhancedCt& enhanced) {
    const TemporaryFolder folder;
    testing::write_dicom(folder / "all.dcm", enhanced.elements());
    const auto scan = read_ct_scan(folder.path());
    return scan ? std::string("was read") : scan.error().text();
  };
  EnhancedCt phases;
  phases.z_mm = {0, 2, 0, 2};
  EXPECT_NE(error_of(phases).find("frame 2 of all.dcm and frame 4 of all.dcm"), std::string::npos) << error_of(phases);
  EnhancedCt incomplete;
  incomplete.places = 3;
  EXPECT_NE(error_of(incomplete).find("4 frames, but places for 3"), std::string::npos) << error_of(incomplete);
  EnhancedCt gap;
  gap.z_mm = {0, 2, 4, 60};
  EXPECT_NE(error_of(gap).find("slices are missing"), std::string::npos) << error_of(gap);
}

}  // namespace
}  // namespace trocar::io
