#include "io/image/image_file.h"

#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <limits>

#include "core/random.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::expect_same_place;
using testing::numbered_grid;
using testing::numbers;
using testing::oblique_geometry;
using testing::read_bytes;
using testing::write_bytes;

// NIfTI keeps the place in single precision; the other formats in decimal text of full precision.
constexpr double kSinglePrecision_mm = 1e-4;

class EveryFormat : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(EveryFormat, KeepsObliqueCt) {
  volume::CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
  ct.voxels[3] = -32768;
  ct.voxels[4] = 32767;
  const auto path = folder_ / (std::string("ct") + GetParam());
  ASSERT_TRUE(write_image(ct, path));
  const auto read = read_ct(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, ct.voxels);
  expect_same_place(read->geometry, ct.geometry, kSinglePrecision_mm);
  EXPECT_TRUE(read->geometry.matches(ct.geometry));
}

TEST_P(EveryFormat, KeepsLabels) {
  const volume::LabelGrid labels = numbered_grid<std::uint8_t>(oblique_geometry());
  const auto path = folder_ / (std::string("labels") + GetParam());
  ASSERT_TRUE(write_image(labels, path));
  const auto read = read_labels(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, labels.voxels);
  EXPECT_TRUE(read->geometry.matches(labels.geometry));
}

TEST_P(EveryFormat, KeepsGrayLevelsAndItsBaseName) {
  const volume::LabelGrid gray = numbered_grid<std::uint8_t>(oblique_geometry());
  const auto path = folder_ / (std::string("sweep.1") + GetParam());
  ASSERT_TRUE(write_image(gray, path));
  std::vector<std::string> warnings;
  const auto read = read_gray_levels(path, warnings);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, gray.voxels);
  EXPECT_EQ(name_without_ending(path), "sweep.1");
}

TEST_P(EveryFormat, KeepsFloats) {
  volume::FloatGrid distance = numbered_grid<float>(oblique_geometry());
  distance.voxels[5] = -12.375F;
  const auto path = folder_ / (std::string("distance") + GetParam());
  ASSERT_TRUE(write_image(distance, path));
  const auto read = read_float(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, distance.voxels);
}

TEST_P(EveryFormat, RefusesEveryTruncation) {
  const volume::CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
  const std::string name = std::string("ct") + GetParam();
  ASSERT_TRUE(write_image(ct, folder_ / name));
  const std::string whole = read_bytes(folder_ / name);
  for (const double part : {0.0, 0.01, 0.1, 0.3, 0.5, 0.8, 0.95}) {
    const auto length = static_cast<std::size_t>(part * static_cast<double>(whole.size()));
    write_bytes(folder_ / ("cut" + name), whole.substr(0, length));
    EXPECT_FALSE(read_ct(folder_ / ("cut" + name))) << part;
  }
  write_bytes(folder_ / ("cut" + name), whole.substr(0, whole.size() - 1));
  EXPECT_FALSE(read_ct(folder_ / ("cut" + name)));
}

TEST_P(EveryFormat, WritesNothingToTheTerminal) {
  const volume::CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
  const std::string name = std::string("ct") + GetParam();
  ASSERT_TRUE(write_image(ct, folder_ / name));
  const std::string whole = read_bytes(folder_ / name);
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    write_bytes(folder_ / ("cut" + name), whole.substr(0, length));
    (void)read_ct(folder_ / ("cut" + name));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST_P(EveryFormat, SurvivesDamagedHeadersWithoutOutput) {
  const volume::CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
  const std::string name = std::string("ct") + GetParam();
  ASSERT_TRUE(write_image(ct, folder_ / name));
  const std::string whole = read_bytes(folder_ / name);
  Random random(7);
  ::testing::internal::CaptureStderr();
  for (int round = 0; round < 200; ++round) {
    std::string damaged = whole;
    for (int change = 0; change < 3; ++change)
      damaged[random.next() % std::min<std::size_t>(whole.size(), 400)] = static_cast<char>(random.next());
    write_bytes(folder_ / ("damaged" + name), damaged);
    const auto read = read_ct(folder_ / ("damaged" + name));
    const bool is_whole = read && read->voxels.size() == read->geometry.voxel_count();
    EXPECT_TRUE(is_whole || (!read && !read.error().advice.empty())) << round;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_P(EveryFormat, LeavesNothingWhenTheDiskIsFull) {
  volume::GridGeometry g = oblique_geometry();
  g.size = {64, 64, 32};
  volume::CtGrid noise(g);
  std::uint32_t state = 1;
  for (auto& voxel : noise.voxels) voxel = static_cast<std::int16_t>((state = state * 1664525U + 1013904223U) >> 16);
  const auto path = folder_ / (std::string("ct") + GetParam());

  // A limit on the file size fails like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{20'000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  ::testing::internal::CaptureStderr();
  const Status status = write_image(noise, path);
  const std::string printed = ::testing::internal::GetCapturedStderr();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_DFL);

  EXPECT_FALSE(status);
  EXPECT_EQ(printed, "");
  EXPECT_TRUE(folder_.is_empty());
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, ::testing::Values(".nii", ".nii.gz", ".nrrd", ".mha"));

TEST(ImageFile, ReadsRasNrrd) {
  TemporaryFolder folder;
  std::string text =
      "NRRD0004\ntype: short\ndimension: 3\nspace: right-anterior-superior\nsizes: 3 2 2\n"
      "space directions: (2,0,0) (0,3,0) (0,0,4)\nkinds: domain domain domain\nendian: little\nencoding: raw\n"
      "space origin: (10,20,30)\n\n";
  const auto values = numbers(12);
  text.append(reinterpret_cast<const char*>(values.data()), 24);
  write_bytes(folder / "ct.nrrd", text);
  const auto ct = read_ct(folder / "ct.nrrd");
  ASSERT_TRUE(ct) << ct.error().text();
  const Vec3 index = ct->geometry.to_index({-14, -20, 34});
  EXPECT_EQ((*ct)[(volume::Index3{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])})], 8);
}

TEST(ImageFile, ReadsADetachedHeader) {
  TemporaryFolder folder;
  write_bytes(folder / "ct.mhd",
              "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 2 3 4\nDimSize = 3 2 2\n"
              "ElementType = MET_SHORT\nElementDataFile = ct.raw\n");
  const auto missing = read_ct(folder / "ct.mhd");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("no such file"), std::string::npos) << missing.error().text();

  const auto values = numbers(12);
  write_bytes(folder / "ct.raw", {reinterpret_cast<const char*>(values.data()), 24});
  const auto ct = read_ct(folder / "ct.mhd");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels, values);
  EXPECT_LT((ct->geometry.to_mm({1, 1, 1}) - Vec3(3, 5, 7)).norm(), 1e-12);
}

TEST(ImageFile, ErrorNamesANonImageFile) {
  TemporaryFolder folder;
  write_bytes(folder / "notes.txt", "hello");
  write_bytes(folder / "fake.nii.gz", "hello");
  write_bytes(folder / "fake.nrrd", "hello");
  write_bytes(folder / "fake.mha", "hello");
  write_bytes(folder / "empty.nii", "");
  for (const char* name : {"notes.txt", "fake.nii.gz", "fake.nrrd", "fake.mha", "empty.nii", "missing.nii"}) {
    const auto ct = read_ct(folder / name);
    ASSERT_FALSE(ct) << name;
    EXPECT_NE(ct.error().where.find(name), std::string::npos);
    EXPECT_FALSE(ct.error().advice.empty());
  }
  const auto none = read_ct(folder.path());
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().what.find("no DICOM"), std::string::npos);
}

TEST(ImageFile, RefusesToWriteAnUnknownEnding) {
  TemporaryFolder folder;
  EXPECT_FALSE(write_image(numbered_grid<std::int16_t>(oblique_geometry()), folder / "ct.jpg"));
  EXPECT_TRUE(folder.is_empty());
}

TEST(ImageFile, FarMoreDataThanStatedIsRefused) {
  // Numbers of twice the bytes that the header states; a little more behind the voxels is harmless.
  const TemporaryFolder folder;
  volume::GridGeometry g;
  g.size = {32, 32, 32};
  constexpr std::size_t kVoxelBytes = 2 * 32 * 32 * 32;
  ASSERT_TRUE(write_image(volume::CtGrid(g, 7), folder / "plain.nii"));
  const std::string nifti = read_bytes(folder / "plain.nii");
  const std::string voxels = nifti.substr(nifti.size() - kVoxelBytes);
  const std::string nrrd =
      "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 32 32 32\nspace directions: (1,0,0) "
      "(0,1,0) (0,0,1)\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n\n";
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 1 1 1\nDimSize = 32 32 32\n"
      "ElementType = MET_SHORT\nElementDataFile = LOCAL\n";
  const std::vector<std::pair<const char*, std::string>> files{
      {"ct.nii", nifti}, {"ct.nrrd", nrrd + voxels}, {"ct.mha", meta + voxels}};
  for (const auto& [name, bytes] : files) {
    const auto read_with = [&](std::size_t more) {
      write_bytes(folder / name, bytes + std::string(more, '\0'));
      const auto ct = read_ct(folder / name);
      return ct ? std::string("read") : ct.error().text();
    };
    EXPECT_EQ(read_with(0), "read") << name;
    EXPECT_EQ(read_with(kVoxelBytes / 4), "read") << name;
    for (const std::size_t more : {kVoxelBytes / 2, kVoxelBytes, 3 * kVoxelBytes})
      EXPECT_NE(read_with(more).find("far more data"), std::string::npos) << name << more;
  }
}

}  // namespace
}  // namespace trocar::io
