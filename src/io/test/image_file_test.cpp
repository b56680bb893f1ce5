#include "io/image_file.h"

#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <limits>

#include "core/random.h"
#include "io/test/test_support.h"

namespace trocar {
namespace {

using testing::expect_same_place;
using testing::numbered_grid;
using testing::oblique_geometry;
using testing::read_bytes;
using testing::TemporaryFolder;
using testing::write_bytes;

// NIfTI keeps the place in single precision; the other formats in decimal text of full precision.
constexpr double kSinglePrecision_mm = 1e-4;

/// Fields of a hand-made NIfTI-1 header, as the standard numbers its bytes.
struct HandMadeNifti {
  std::string bytes = std::string(352, '\0');

  HandMadeNifti() {
    put<std::int32_t>(0, 348);
    put<std::int16_t>(254, 1);  // sform: scanner coordinates
    put<float>(108, 352.0F);    // voxels follow at once
    std::memcpy(bytes.data() + 344, "n+1", 4);
  }
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
  }
  void put_sizes(std::initializer_list<int> sizes) {
    put(40, static_cast<std::int16_t>(sizes.size()));
    std::size_t offset = 42;
    for (const int size : sizes) put(offset, static_cast<std::int16_t>(size)), offset += 2;
  }
  void put_type(std::int16_t code, std::int16_t bits) { put(70, code), put(72, bits); }
  void put_spacing(float x, float y, float z) { put(80, x), put(84, y), put(88, z); }
  /// Rows of the matrix index -> RAS mm.
  void put_sform(const std::array<float, 12>& rows) {
    for (std::size_t n = 0; n < rows.size(); ++n) put(280 + 4 * n, rows[n]);
  }
  template <class T>
  void add_voxels(const std::vector<T>& voxels) {
    bytes.append(reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T));
  }
};

/// 3 x 2 x 2 voxels at 2 x 3 x 4 mm, first voxel at RAS (10, 20, 30), axes towards right, anterior, superior.
template <class T>
HandMadeNifti small_nifti(std::int16_t code, std::vector<T> voxels) {
  HandMadeNifti nifti;
  nifti.put_sizes({3, 2, 2});
  nifti.put_type(code, static_cast<std::int16_t>(8 * sizeof(T)));
  nifti.put_spacing(2, 3, 4);
  nifti.put_sform({2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  nifti.add_voxels(voxels);
  return nifti;
}

constexpr std::int16_t kNiftiInt16 = 4;
constexpr std::int16_t kNiftiFloat = 16;

std::vector<std::int16_t> numbers(std::size_t count) {
  std::vector<std::int16_t> values(count);
  for (std::size_t n = 0; n < count; ++n) values[n] = static_cast<std::int16_t>(n);
  return values;
}

class EveryFormat : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(EveryFormat, KeepsObliqueCt) {
  CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
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
  const LabelGrid labels = numbered_grid<std::uint8_t>(oblique_geometry());
  const auto path = folder_ / (std::string("labels") + GetParam());
  ASSERT_TRUE(write_image(labels, path));
  const auto read = read_labels(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, labels.voxels);
  EXPECT_TRUE(read->geometry.matches(labels.geometry));
}

TEST_P(EveryFormat, KeepsFloats) {
  FloatGrid distance = numbered_grid<float>(oblique_geometry());
  distance.voxels[5] = -12.375F;
  const auto path = folder_ / (std::string("distance") + GetParam());
  ASSERT_TRUE(write_image(distance, path));
  const auto read = read_float(path);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->voxels, distance.voxels);
}

TEST_P(EveryFormat, RefusesEveryTruncation) {
  const CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
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

TEST_P(EveryFormat, SaysNothingOnTheTerminal) {
  const CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
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

TEST_P(EveryFormat, SurvivesDamagedHeadersInSilence) {
  const CtGrid ct = numbered_grid<std::int16_t>(oblique_geometry());
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
  GridGeometry g = oblique_geometry();
  g.size = {64, 64, 32};
  CtGrid noise(g);
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

TEST(ImageFile, WritesNiftiInRas) {
  TemporaryFolder folder;
  GridGeometry g;
  g.size = {3, 4, 5};
  g.spacing_mm = {2, 3, 4};
  g.origin_P = {10, 20, 30};
  ASSERT_TRUE(write_image(numbered_grid<std::int16_t>(g), folder / "ct.nii"));
  const std::string bytes = read_bytes(folder / "ct.nii");
  std::array<float, 12> sform{};
  std::memcpy(sform.data(), bytes.data() + 280, sizeof sform);
  // Left and posterior change their sign, superior does not.
  const std::array<float, 12> expected{-2, 0, 0, -10, 0, -3, 0, -20, 0, 0, 4, 30};
  for (std::size_t n = 0; n < expected.size(); ++n) EXPECT_FLOAT_EQ(sform[n], expected[n]) << n;
}

TEST(ImageFile, TurnsRasNiftiIntoLps) {
  TemporaryFolder folder;
  write_bytes(folder / "ct.nii", small_nifti(kNiftiInt16, numbers(12)).bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  // The marked voxel i=2, j=0, k=1 (value 8) lies at RAS (14, 20, 34).
  const Vec3 index = ct->geometry.to_index({-14, -20, 34});
  const Index3 voxel{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])};
  ASSERT_TRUE(ct->geometry.contains(voxel));
  EXPECT_EQ((*ct)[voxel], 8);
}

TEST(ImageFile, ReordersMirroredGridWithoutMovingVoxels) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put_sform({-2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});  // i runs to the left: a mirrored grid
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_NEAR(ct->geometry.R_PV.determinant(), 1.0, 1e-12);
  for (int n = 0; n < 12; ++n) {
    const Vec3 p_P(-(10.0 - 2.0 * (n % 3)), -(20.0 + 3.0 * (n / 3 % 2)), 30.0 + 4.0 * (n / 6));
    const Vec3 index = ct->geometry.to_index(p_P);
    const Index3 voxel{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])};
    ASSERT_TRUE(ct->geometry.contains(voxel));
    EXPECT_EQ((*ct)[voxel], n);
    EXPECT_LT((ct->geometry.to_mm(index) - p_P).norm(), 1e-9);
  }
}

TEST(ImageFile, AppliesScalingAndRoundsToHu) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put<float>(112, 0.4F);      // scl_slope
  nifti.put<float>(116, -1024.0F);  // scl_inter
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  for (std::size_t n = 0; n < 12; ++n)
    EXPECT_EQ(ct->voxels[n], std::lround(0.4 * static_cast<double>(n) - 1024.0)) << n;
}

TEST(ImageFile, ReadsBigEndian) {
  TemporaryFolder folder;
  std::string bytes = small_nifti(kNiftiInt16, numbers(12)).bytes;
  const auto swap = [&](std::size_t offset, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(offset),
                 bytes.begin() + static_cast<std::ptrdiff_t>(offset + size));
  };
  swap(0, 4);
  for (std::size_t offset = 40; offset < 56; offset += 2) swap(offset, 2);
  for (std::size_t offset : {70, 72, 252, 254}) swap(offset, 2);
  for (std::size_t offset = 76; offset < 120; offset += 4) swap(offset, 4);
  for (std::size_t offset = 280; offset < 328; offset += 4) swap(offset, 4);
  for (std::size_t offset = 352; offset < bytes.size(); offset += 2) swap(offset, 2);
  write_bytes(folder / "ct.nii", bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels, numbers(12));
}

TEST(ImageFile, ClampsPaddingAndRefusesWhatIsNoHu) {
  TemporaryFolder folder;
  std::vector<float> values(12, 40.0F);
  values[1] = -100'000.0F;
  values[2] = -2000.0F;
  write_bytes(folder / "ct.nii", small_nifti(kNiftiFloat, values).bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels[1], -32768);
  EXPECT_EQ(ct->voxels[2], -2000);
  for (const float bad : {40'000.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    values[7] = bad;
    write_bytes(folder / "bad.nii", small_nifti(kNiftiFloat, values).bytes);
    EXPECT_FALSE(read_ct(folder / "bad.nii")) << bad;
    EXPECT_EQ(read_float(folder / "bad.nii").has_value(), std::isfinite(bad)) << bad;
  }
}

TEST(ImageFile, RefusesIntensitiesAsLabels) {
  TemporaryFolder folder;
  std::vector<float> values(12, 3.0F);
  write_bytes(folder / "labels.nii", small_nifti(kNiftiFloat, values).bytes);
  EXPECT_TRUE(read_labels(folder / "labels.nii"));
  for (const float bad : {-1.0F, 256.0F, 0.5F, std::numeric_limits<float>::quiet_NaN()}) {
    values[7] = bad;
    write_bytes(folder / "bad.nii", small_nifti(kNiftiFloat, values).bytes);
    EXPECT_FALSE(read_labels(folder / "bad.nii")) << bad;
  }
}

TEST(ImageFile, RefusesShearedGrid) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put_sform({2, 0.1F, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_FALSE(ct);
  EXPECT_NE(ct.error().what.find("sheared"), std::string::npos) << ct.error().text();
}

TEST(ImageFile, RefusesSizesThatCannotBe) {
  TemporaryFolder folder;
  struct Case {
    std::initializer_list<int> sizes;
    const char* what;
  };
  for (const Case& c :
       {Case{{30'000, 30'000, 30'000}, "impossible"}, Case{{1000, 1000, 1000}, "ends before"}, Case{{3, 2, 2, 5}, "4D"},
        Case{{3, 0, 2}, "empty"}, Case{{3, -4, 2}, "empty"}, Case{{3, 2}, "no 3D"}, Case{{3, 4, 1}, "single slice"}}) {
    HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(60));
    nifti.put_sizes(c.sizes);
    write_bytes(folder / "ct.nii", nifti.bytes);
    const auto ct = read_ct(folder / "ct.nii");
    ASSERT_FALSE(ct) << c.what;
    EXPECT_NE(ct.error().what.find(c.what), std::string::npos) << ct.error().text();
  }
}

TEST(ImageFile, AcceptsOneTimePoint) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put_sizes({3, 2, 2, 1});
  write_bytes(folder / "ct.nii", nifti.bytes);
  EXPECT_TRUE(read_ct(folder / "ct.nii"));
}

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
  EXPECT_EQ((*ct)[(Index3{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])})], 8);
}

TEST(ImageFile, ReadsHeaderWithVoxelsBeside) {
  TemporaryFolder folder;
  write_bytes(folder / "ct.mhd",
              "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
              "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 2 3 4\nDimSize = 3 2 2\n"
              "ElementType = MET_SHORT\nElementDataFile = ct.raw\n");
  const auto missing = read_ct(folder / "ct.mhd");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().what.find("missing"), std::string::npos) << missing.error().text();

  const auto values = numbers(12);
  write_bytes(folder / "ct.raw", {reinterpret_cast<const char*>(values.data()), 24});
  const auto ct = read_ct(folder / "ct.mhd");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels, values);
  EXPECT_LT((ct->geometry.to_mm({1, 1, 1}) - Vec3(3, 5, 7)).norm(), 1e-12);
}

TEST(ImageFile, NamesWhatIsNoImage) {
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

}  // namespace
}  // namespace trocar
