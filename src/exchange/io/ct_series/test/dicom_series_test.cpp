#include "io/ct_series/detail/dicom_series.h"

#include <cmath>
#include <numeric>

#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using detail::DicomSlice;
using detail::order_slices;
using testing::test_data;

/// Headers of a series: `count` slices a step apart along the slices' normal, leaning by `tilt_deg`.
std::vector<DicomSlice> series(int count, double step_mm, double tilt_deg = 0.0, const Mat3& R = Mat3::Identity()) {
  std::vector<DicomSlice> slices;
  for (int n = 0; n < count; ++n) {
    DicomSlice slice;
    slice.file = "slice" + std::to_string(n);
    slice.series_uid = "1.2.3";
    slice.columns = 6;
    slice.rows = 4;
    slice.position_P = Vec3(10, 20, 30) + R * Vec3(0, std::tan(tilt_deg * kRadPerDeg), 1) * (n * step_mm);
    slice.directions_P = {R.col(0), R.col(1)};
    slice.spacing_mm = {0.5, 0.75};
    slices.push_back(slice);
  }
  return slices;
}

std::string ordering_of(std::vector<DicomSlice> slices) {
  const auto ordered = order_slices(std::move(slices), "folder");
  return ordered ? "ordered" : ordered.error().text();
}

TEST(DicomSeries, OrdersByPositionAndDerivesTheSliceStep) {
  const Mat3 R = (Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Eigen::AngleAxisd(0.5, Vec3::UnitZ())).toRotationMatrix();
  auto slices = series(5, 2.0, 0.0, R);
  std::swap(slices[0], slices[3]);
  std::swap(slices[1], slices[4]);
  const auto ordered = order_slices(slices, "folder");
  ASSERT_TRUE(ordered) << ordered.error().text();
  for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(ordered->slices[n].file, "slice" + std::to_string(n));
  const volume::GridGeometry& g = ordered->plan.geometry;
  EXPECT_EQ(g.size, (std::array<std::int64_t, 3>{6, 4, 5}));
  EXPECT_LT((g.spacing_mm - Vec3(0.5, 0.75, 2.0)).norm(), 1e-9);
  EXPECT_LT((g.R_PV - R).norm(), 1e-9);
  EXPECT_LT((g.to_mm({1, 2, 3}) - (Vec3(10, 20, 30) + R * Vec3(0.5, 1.5, 6.0))).norm(), 1e-9);
}

TEST(DicomSeries, ToleratesPositionsRoundedToATenth) {
  auto slices = series(40, 1.25);
  for (DicomSlice& slice : slices) slice.position_P->z() = std::round(slice.position_P->z() * 10.0) / 10.0;
  EXPECT_EQ(ordering_of(slices), "ordered");
}

TEST(DicomSeries, FillsTheGapOfAMissingSlice) {
  for (const std::size_t missing : {1U, 7U, 18U}) {
    auto slices = series(20, 2.0);
    slices.erase(slices.begin() + static_cast<std::ptrdiff_t>(missing));
    const auto ordered = order_slices(slices, "folder");
    ASSERT_TRUE(ordered) << ordered.error().text();
    EXPECT_TRUE(ordered->plan.is_uneven);
    EXPECT_EQ(ordered->plan.geometry.size[2], 20);
    EXPECT_NEAR(ordered->plan.geometry.spacing_mm.z(), 2.0, 1e-12);
    EXPECT_EQ(ordered->plan.layers[missing].below, missing - 1);
    EXPECT_NEAR(ordered->plan.layers[missing].weight_above, 0.5, 1e-9);
  }
}

TEST(DicomSeries, RefusesATooWideGapAndNamesItsSlices) {
  auto slices = series(20, 2.0);
  slices.erase(slices.begin() + 7, slices.begin() + 10);  // 8 mm, four times the usual distance
  EXPECT_NE(ordering_of(slices).find("missing: 8 mm between slice6 and slice10"), std::string::npos)
      << ordering_of(slices);
  slices = series(8, 5.0);
  slices.erase(slices.begin() + 3, slices.begin() + 5);  // 15 mm
  EXPECT_NE(ordering_of(slices).find("missing: 15 mm between slice2 and slice5"), std::string::npos)
      << ordering_of(slices);
  EXPECT_EQ(ordering_of(series(8, 12.0)), "ordered");  // thick, but even
}

TEST(DicomSeries, RefusesTwoSlicesInOnePlace) {
  auto slices = series(10, 2.0);
  slices.push_back(slices[4]);
  slices.back().file = "again";
  EXPECT_NE(ordering_of(slices).find("same position: slice4 and again"), std::string::npos) << ordering_of(slices);
}

TEST(DicomSeries, StraightensGantryTilt) {
  const auto tilted = [](double tilt_deg) { return order_slices(series(10, 2.0, tilt_deg), "folder"); };
  ASSERT_TRUE(tilted(0.2) && tilted(0.5) && tilted(-15.0));
  EXPECT_TRUE(tilted(0.2)->plan.is_plain);
  EXPECT_FALSE(tilted(0.5)->plan.is_plain);
  EXPECT_NEAR(tilted(-15.0)->plan.tilt_deg, 15.0, 1e-9);
  // 18 mm of stack lean by 4.82 mm, which is 6.4 rows of 0.75 mm.
  EXPECT_EQ(tilted(-15.0)->plan.geometry.size, (std::array<std::int64_t, 3>{6, 4 + 7, 10}));
  EXPECT_NE(ordering_of(series(10, 2.0, 50.0)).find("50 degrees, more than a gantry tilts"), std::string::npos);
}

TEST(DicomSeries, RefusesNonGreyOrMixedSlices) {
  const auto refused = [](const std::function<void(DicomSlice&)>& change) {
    auto slices = series(5, 2.0);
    change(slices[2]);
    return ordering_of(slices) != "ordered";
  };
  EXPECT_TRUE(refused([](DicomSlice& s) { s.frames = 2; }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.samples_per_pixel = 3; }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.rows = 5; }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.position_P.reset(); }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.directions_P.reset(); }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.spacing_mm.reset(); }));
  EXPECT_TRUE(refused([](DicomSlice& s) { (*s.spacing_mm)[0] = 0.6; }));
  EXPECT_TRUE(refused([](DicomSlice& s) { s.directions_P = {Vec3::UnitY(), Vec3::UnitX()}; }));
  EXPECT_FALSE(refused([](DicomSlice&) {}));
  EXPECT_NE(ordering_of(series(1, 2.0)), "ordered");
  EXPECT_NE(ordering_of({}), "ordered");
}

TEST(DicomSeries, RefusesSlicesThatDoNotBelongTogether) {
  const auto error_with = [](const std::function<void(DicomSlice&)>& change) {
    auto slices = series(5, 2.0);
    for (DicomSlice& slice : slices) {
      slice.modality = "CT";
      slice.patient_id = "PAT-0001";
      slice.frame_of_reference = "1.2.3.4";
    }
    change(slices[3]);
    return ordering_of(slices);
  };
  EXPECT_EQ(error_with([](DicomSlice&) {}), "ordered");
  EXPECT_NE(error_with([](DicomSlice& s) { s.patient_id = "two"; }).find("PatientID"), std::string::npos);
  EXPECT_EQ(error_with([](DicomSlice& s) { s.patient_id = "two"; }).find("PAT-0001"), std::string::npos);
  EXPECT_NE(error_with([](DicomSlice& s) { s.frame_of_reference = "1.2.3.5"; }).find("FrameOfReferenceUID"),
            std::string::npos);
  EXPECT_NE(error_with([](DicomSlice& s) { s.modality = "MR"; }).find("CT and MR"), std::string::npos);
  EXPECT_NE(error_with([](DicomSlice& s) { s.slope = 0.0; }).find("RescaleSlope is 0"), std::string::npos);
  EXPECT_NE(error_with([](DicomSlice& s) { s.is_cut = true; }).find("ends before its last pixel"), std::string::npos);
}

TEST(DicomSeries, RefusesInvalidDirections) {
  auto slices = series(5, 2.0);
  for (DicomSlice& slice : slices) slice.directions_P = {Vec3(1, 0, 0), Vec3(0.2, 1, 0)};
  EXPECT_NE(ordering_of(slices), "ordered");
  slices = series(5, 2.0);
  for (DicomSlice& slice : slices) slice.directions_P = {Vec3::Zero(), Vec3::Zero()};
  EXPECT_NE(ordering_of(slices), "ordered");
  slices = series(5, 2.0);
  for (DicomSlice& slice : slices) slice.spacing_mm = {0.0, 0.75};
  EXPECT_NE(ordering_of(slices), "ordered");
}

class RealSlice : public ::testing::TestWithParam<const char*> {};

/// Mean of the pixels, NaN where they cannot be unpacked.
double mean_of(const std::filesystem::path& file) {
  const auto slices = detail::find_dicom_slices(file);
  double mean = std::nan("");
  if (!slices || slices->empty()) return mean;
  (void)detail::decode_slice(slices->front(), [&](const detail::RawVoxels& voxels) -> Status {
    std::vector<float> pixels(voxels.bytes.size() / detail::bytes_per_voxel(voxels.type));
    TROCAR_TRY_STATUS(detail::convert_voxels(voxels, std::span(pixels)));
    mean = std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
    return {};
  });
  return mean;
}

TEST_P(RealSlice, IsUnpackedWithoutOutput) {
  const auto file = test_data() / "bad-input/dicom" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real data at " << file;
  ::testing::internal::CaptureStderr();
  const double mean = mean_of(file);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(std::isfinite(mean));
}

INSTANTIATE_TEST_SUITE_P(Compressions, RealSlice,
                         ::testing::Values("CT_small.dcm", "MR_small_RLE.dcm", "MR_small_jpeg_ls_lossless.dcm",
                                           "JPEG-lossy.dcm", "pydata_JPEG-LL.dcm", "JPEG2000.dcm", "693_J2KI.dcm"));

TEST(RealSlices, RunLengthAndJpegLsKeepTheSamePixels) {
  // Both were made without loss from the same image.
  const auto data = test_data() / "bad-input/dicom";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "no real data at " << data;
  EXPECT_EQ(mean_of(data / "MR_small_RLE.dcm"), mean_of(data / "MR_small_jpeg_ls_lossless.dcm"));
  EXPECT_NEAR(mean_of(data / "693_J2KI.dcm") / mean_of(data / "pydata_693_UNCR.dcm"), 1.0, 0.01);
}

TEST(RealSlices, RefuseThreeComponentsDeclaredAsOne) {
  const auto file = test_data() / "bad-input/dicom/pydata_US1_J2KR.dcm";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real data at " << file;
  std::string bytes = testing::read_bytes(file);
  const std::string_view samples_per_pixel("\x28\x00\x02\x00US\x02\x00\x03", 9);
  const std::size_t at = bytes.find(samples_per_pixel);
  ASSERT_NE(at, std::string::npos);
  bytes[at + samples_per_pixel.size() - 1] = 1;
  const TemporaryFolder folder;
  testing::write_bytes(folder / "slice.dcm", bytes);
  const auto slices = detail::find_dicom_slices(folder / "slice.dcm");
  ASSERT_TRUE(slices) << slices.error().text();
  ASSERT_EQ(slices->size(), 1U);
  const Status decoded = detail::decode_slice(slices->front(), [](const detail::RawVoxels&) { return Status(); });
  ASSERT_FALSE(decoded);  // GDCM ends the program
  EXPECT_NE(decoded.error().what.find("cannot be unpacked"), std::string::npos) << decoded.error().text();
}

class RealSeries : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_)) GTEST_SKIP() << "no real data at " << data_;
  }
  void copy(int from, int to) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(data_)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (int n = from; n < to; ++n) {
      const auto& file = files[static_cast<std::size_t>(n)];
      std::filesystem::copy_file(file, folder_ / file.filename().string());
    }
  }
  std::filesystem::path data_ = test_data() / "ct-torso/example_ct_dicom";
  TemporaryFolder folder_;
};

TEST_F(RealSeries, ReadsJpeg2000SlicesWithTheirStep) {
  const auto ct = read_ct(data_);
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->geometry.size, (std::array<std::int64_t, 3>{512, 512, 20}));
  EXPECT_LT((ct->geometry.spacing_mm - Vec3(0.9765625, 0.9765625, 2.0)).norm(), 1e-9);  // thickness is 3 mm
  const auto [low, high] = std::minmax_element(ct->voxels.begin(), ct->voxels.end());
  EXPECT_EQ(*low, -1024);
  EXPECT_GT(*high, 1000);
}

TEST_F(RealSeries, IsReadAmongOtherFiles) {
  copy(0, 4);
  testing::write_bytes(folder_ / "LICENSE", "Apache License");
  testing::write_bytes(folder_ / "README.txt", std::string(20'000, 'x'));
  testing::write_bytes(folder_ / "empty", "");
  const auto ct = read_ct(folder_.path());
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->geometry.size[2], 4);
}

TEST_F(RealSeries, IsReadFromAParentFolder) {
  const auto above = read_ct(data_.parent_path());
  ASSERT_TRUE(above) << above.error().text();
  EXPECT_EQ(above->geometry.size[2], 20);
}

TEST_F(RealSeries, IsRefusedWithAdviceWhenGivenAsOneFile) {
  const auto one = read_ct(std::filesystem::directory_iterator(data_)->path());
  ASSERT_FALSE(one);
  EXPECT_NE(one.error().advice.find("folder"), std::string::npos) << one.error().text();
}

TEST_F(RealSeries, IsRefusedWithATruncatedSliceWithoutOutput) {
  copy(0, 3);
  const auto victim = std::filesystem::directory_iterator(folder_.path())->path();
  const std::string whole = testing::read_bytes(victim);
  ::testing::internal::CaptureStderr();
  for (const double part : {0.5, 0.9, 0.995}) {
    testing::write_bytes(victim, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    const auto ct = read_ct(folder_.path());
    ASSERT_FALSE(ct) << part;
    EXPECT_NE(ct.error().where.find(victim.filename().string()), std::string::npos) << ct.error().text();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace trocar::io
