// Masks as DICOM series: compared with the CT, and read by their stored numbers.

#include <gtest/gtest.h>

#include <algorithm>

#include "dicom/testing/dicom_writer.h"
#include "io/patient/label_sources.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::CtSeries;

/// Masks of a CT as DICOM series, one folder a structure.
class MaskSeries : public ::testing::Test {
 protected:
  std::string outcome(const CtSeries& mask, double background = 0.0, double inside = 255.0) {
    const TemporaryFolder folder;
    const std::vector<Vec3> origins_P{{0, 0, 0}, {0, 0, 2}, {0, 0, 4}, {0, 0, 6}};
    testing::write_slices(folder / "liver", mask, origins_P, [&](const Vec3& p_P) {
      return p_P.x() > 2.5 && p_P.x() < 5.5 && p_P.y() > 1.5 ? inside : background;
    });
    volume::GridGeometry grid;
    grid.size = {8, 6, 4};
    grid.spacing_mm = {1, 1, 2};
    dicom::CtReference ct{grid, "1.2.3", "1.2.9", {}};
    ct.patient_id = "A";
    std::vector<std::string> warnings;
    const auto sources = read_label_sources({folder.path()}, "totalsegmentator", ct, warnings);
    if (!sources) return sources.error().text();
    return fmt::format("{} voxels", std::ranges::count(sources->front().labels.voxels, std::uint8_t{1}));
  }
};

TEST_F(MaskSeries, OfAnotherPatientOrFrameIsRefused) {
  CtSeries mask;
  mask.series_uid = "1.2.77";
  EXPECT_EQ(outcome(mask), "48 voxels");
  mask.patient_id = "A";
  EXPECT_EQ(outcome(mask), "48 voxels");
  mask.patient_id = "B";
  EXPECT_NE(outcome(mask).find("of another patient"), std::string::npos) << outcome(mask);
  mask.patient_id = "A";
  mask.frame_of_reference = "1.2.99";
  EXPECT_NE(outcome(mask).find("another frame of reference (1.2.99) than the CT (1.2.9)"), std::string::npos)
      << outcome(mask);
  mask.frame_of_reference = "";
  EXPECT_EQ(outcome(mask), "48 voxels");
}

TEST_F(MaskSeries, UseStoredValues) {
  CtSeries mask;
  mask.intercept = "-1024";
  EXPECT_EQ(outcome(mask), "48 voxels");
  EXPECT_EQ(outcome(mask, 0.0, 1.0), "48 voxels");
  EXPECT_EQ(outcome(mask, 1024.0, 1025.0), "48 voxels");  // 0 and 1 with the offset of the CT
}

}  // namespace
}  // namespace trocar::io
