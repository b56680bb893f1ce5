#include "dicom/testing/dicom_writer.h"
#include "io/ct_series/dicom_folder.h"
#include "io/image/image_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::dicom_element;
using testing::little_endian;

std::string short_element(std::uint16_t number, std::uint32_t value) {
  return dicom_element(0x0028, number, "US", little_endian(value, 2));
}

/// A slice of 4 x 3 pixels, all of `value`, at z = 2 n mm.
void write_flat_slice(const fs::path& file, const std::string& uid, const std::string& modality, int n, int value) {
  std::string pixels;
  for (int p = 0; p < 12; ++p) pixels += little_endian(static_cast<std::uint32_t>(value), 2);
  fs::create_directories(file.parent_path());
  testing::write_bytes(
      file,
      std::string(128, '\0').append("DICM") + dicom_element(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1") +
          dicom_element(0x0008, 0x0060, "CS", modality) + dicom_element(0x0008, 0x103e, "LO", "series of " + modality) +
          dicom_element(0x0020, 0x000e, "UI", uid) +
          dicom_element(0x0020, 0x0032, "DS", "0\\0\\" + std::to_string(2 * n)) +
          dicom_element(0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0") + short_element(0x0002, 1) +
          dicom_element(0x0028, 0x0004, "CS", "MONOCHROME2") + short_element(0x0010, 3) + short_element(0x0011, 4) +
          dicom_element(0x0028, 0x0030, "DS", "1\\1") + short_element(0x0100, 16) + short_element(0x0101, 16) +
          short_element(0x0102, 15) + short_element(0x0103, 1) + dicom_element(0x7fe0, 0x0010, "OW", pixels));
}

void write_series(const fs::path& folder, const std::string& uid, const std::string& modality, int slices, int value) {
  for (int n = 0; n < slices; ++n) write_flat_slice(folder / ("image" + std::to_string(n)), uid, modality, n, value);
}

int first_voxel(const Result<volume::CtGrid>& ct) {
  EXPECT_TRUE(ct) << ct.error().text();
  return ct ? ct->voxels.front() : -32768;
}

TEST(FindSeries, OneSeriesBelowSubFoldersIsRead) {
  const TemporaryFolder folder;
  write_series(folder / "patient/study/series", "1.2.3", "CT", 3, 40);
  testing::write_bytes(folder / "patient/README", "text");
  const auto ct = read_ct(folder.path());
  EXPECT_EQ(first_voxel(ct), 40);
  EXPECT_EQ(ct->geometry.size, (std::array<std::int64_t, 3>{4, 3, 3}));
}

TEST(FindSeries, SelectsTheOnlyCtVolume) {
  const TemporaryFolder folder;
  write_series(folder / "a", "1.2.3", "MR", 3, 10);
  write_series(folder / "b", "1.2.4", "CT", 1, 20);  // a localizer
  write_series(folder / "c", "1.2.5", "CT", 4, 30);
  EXPECT_EQ(first_voxel(read_ct(folder.path())), 30);
}

TEST(FindSeries, ListsSeveralAndSelectsByNumberOrUid) {
  const TemporaryFolder folder;
  write_series(folder / "a", "1.2.3", "CT", 3, 10);
  write_series(folder / "b/deep", "1.2.4", "CT", 2, 20);
  const auto refused = read_ct(folder.path());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit_status, 2);
  EXPECT_NE(
      refused.error().what.find("1: 'series of CT' CT, 3 images of 4x3, UID 1.2.3; 2: 'series of CT' CT, 2 images"),
      std::string::npos)
      << refused.error().text();
  EXPECT_EQ(first_voxel(read_ct(folder.path(), "1")), 10);
  EXPECT_EQ(first_voxel(read_ct(folder.path(), "2")), 20);
  EXPECT_EQ(first_voxel(read_ct(folder.path(), "1.2.4")), 20);
  for (const char* wrong : {"0", "3", "-1", "1.2", "first"}) {
    const auto ct = read_ct(folder.path(), wrong);
    ASSERT_FALSE(ct) << wrong;
    EXPECT_EQ(ct.error().exit_status, 2);
    EXPECT_NE(ct.error().what.find("UID 1.2.4"), std::string::npos) << ct.error().text();
  }
}

TEST(FindSeries, MergesOneSeriesInTwoFolders) {
  const TemporaryFolder folder;
  write_flat_slice(folder / "a/1", "1.2.3", "CT", 0, 10);
  write_flat_slice(folder / "b/2", "1.2.3", "CT", 1, 10);
  const auto series = list_dicom_series(folder.path());
  ASSERT_TRUE(series) << series.error().text();
  ASSERT_EQ(series->size(), 1u);
  EXPECT_EQ(series->front().images, 2u);
  EXPECT_EQ(series->front().uid, "1.2.3");
  EXPECT_EQ(series->front().modality, "CT");
  EXPECT_EQ(series->front().description, "series of CT");
  EXPECT_EQ(series->front().folder.filename(), "a");
}

TEST(FindSeries, LinksToFoldersAreNotFollowed) {
  const TemporaryFolder folder;
  write_series(folder / "a", "1.2.3", "CT", 2, 10);
  fs::create_directory_symlink(folder.path(), folder / "a/loop");
  const auto series = list_dicom_series(folder.path());
  ASSERT_TRUE(series) << series.error().text();
  EXPECT_EQ(series->front().images, 2u);
}

TEST(FindSeries, FolderWithoutImagesIsAnError) {
  const TemporaryFolder folder;
  EXPECT_FALSE(list_dicom_series(folder.path()));
  EXPECT_FALSE(list_dicom_series(folder / "nowhere"));
  EXPECT_FALSE(read_ct(folder.path()));
}

TEST(FindSeries, SeriesOfAFileIsAUsageError) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_image(volume::CtGrid(testing::oblique_geometry(), 5), folder / "ct.nrrd"));
  const auto ct = read_ct(folder / "ct.nrrd", "1");
  ASSERT_FALSE(ct);
  EXPECT_EQ(ct.error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::io
