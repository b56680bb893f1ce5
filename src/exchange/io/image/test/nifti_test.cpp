#include <cmath>
#include <cstring>
#include <limits>

#include "io/image/image_file.h"
#include "io/image/testing/hand_made_nifti.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::HandMadeNifti;
using testing::numbered_grid;
using testing::numbers;
using testing::read_bytes;
using testing::small_nifti;
using testing::write_bytes;

constexpr std::int16_t kNiftiInt16 = 4;
constexpr std::int16_t kNiftiFloat = 16;

TEST(Nifti, TurnsRasNiftiIntoLps) {
  TemporaryFolder folder;
  write_bytes(folder / "ct.nii", small_nifti(kNiftiInt16, numbers(12)).bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  // The marked voxel i=2, j=0, k=1 (value 8) lies at RAS (14, 20, 34).
  const Vec3 index = ct->geometry.to_index({-14, -20, 34});
  const volume::Index3 voxel{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])};
  ASSERT_TRUE(ct->geometry.contains(voxel));
  EXPECT_EQ((*ct)[voxel], 8);
}

TEST(Nifti, ReordersMirroredGridWithoutMovingVoxels) {
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
    const volume::Index3 voxel{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])};
    ASSERT_TRUE(ct->geometry.contains(voxel));
    EXPECT_EQ((*ct)[voxel], n);
    EXPECT_LT((ct->geometry.to_mm(index) - p_P).norm(), 1e-9);
  }
}

TEST(Nifti, AppliesScalingAndRoundsToHu) {
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

TEST(Nifti, ReadsBigEndian) {
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

TEST(Nifti, ClampsPaddingAndRefusesNonFiniteHu) {
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

TEST(Nifti, RefusesIntensitiesAsLabels) {
  TemporaryFolder folder;
  std::vector<float> values(12, 3.0F);
  write_bytes(folder / "labels.nii", small_nifti(kNiftiFloat, values).bytes);
  EXPECT_TRUE(read_labels(folder / "labels.nii"));
  for (const float bad : {-1.0F, 256.0F, 0.5F, std::numeric_limits<float>::quiet_NaN()}) {
    values[7] = bad;
    write_bytes(folder / "bad.nii", small_nifti(kNiftiFloat, values).bytes);
    EXPECT_FALSE(read_labels(folder / "bad.nii")) << bad;
    std::vector<std::string> warnings;
    if (bad == 0.5F) continue;  // gray levels may be rounded, see below
    const auto gray = read_gray_levels(folder / "bad.nii", warnings);
    ASSERT_FALSE(gray) << bad;
    const char* told = std::isfinite(bad) ? "gray level" : "not a number";
    EXPECT_NE(gray.error().text().find(told), std::string::npos) << gray.error().text();
    EXPECT_EQ(gray.error().text().find("label"), std::string::npos) << gray.error().text();
  }
}

TEST(Nifti, RoundsGrayLevelsWithAWarning) {
  TemporaryFolder folder;
  std::vector<float> values(12, 100.4F);
  values[3] = 254.6F;
  write_bytes(folder / "us.nii", small_nifti(kNiftiFloat, values).bytes);
  std::vector<std::string> warnings;
  const auto gray = read_gray_levels(folder / "us.nii", warnings);
  ASSERT_TRUE(gray) << gray.error().text();
  EXPECT_EQ(gray->voxels[0], 100);
  EXPECT_EQ(gray->voxels[3], 255);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0], "us.nii: the gray levels have fractions and are rounded");
  for (float& value : values) value /= 255.0F;
  write_bytes(folder / "us.nii", small_nifti(kNiftiFloat, values).bytes);
  const auto shares = read_gray_levels(folder / "us.nii", warnings);
  ASSERT_FALSE(shares);
  EXPECT_NE(shares.error().text().find("multiply it by 255"), std::string::npos) << shares.error().text();
}

TEST(Nifti, RefusesAnUnknownOrientation) {
  TemporaryFolder folder;
  HandMadeNifti nowhere = small_nifti(kNiftiInt16, numbers(12));
  nowhere.put<std::int16_t>(254, 0);
  write_bytes(folder / "ct.nii", nowhere.bytes);
  EXPECT_FALSE(read_ct(folder / "ct.nii"));
  HandMadeNifti metres = small_nifti(kNiftiInt16, numbers(12));
  metres.put<char>(123, 1);
  write_bytes(folder / "ct.nii", metres.bytes);
  EXPECT_FALSE(read_ct(folder / "ct.nii"));
}

TEST(Nifti, ReadsQform) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put<std::int16_t>(254, 0);
  nifti.put<std::int16_t>(252, 1);
  nifti.put<float>(76, -1.0F);  // qfac: k runs against the right-hand rule
  for (std::size_t n = 0; n < 3; ++n) nifti.put(268 + 4 * n, 10.0F * static_cast<float>(n + 1));
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_NEAR(ct->geometry.R_PV.determinant(), 1.0, 1e-12);
  const Vec3 index = ct->geometry.to_index({-14, -20, 26});  // i=2, j=0, k=1 in the file
  EXPECT_EQ((*ct)[(volume::Index3{std::lround(index[0]), std::lround(index[1]), std::lround(index[2])})], 8);
}

TEST(Nifti, RefusesShearedGrid) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put_sform({2, 0.1F, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_FALSE(ct);
  EXPECT_NE(ct.error().what.find("sheared"), std::string::npos) << ct.error().text();
}

TEST(Nifti, RefusesImpossibleSizes) {
  TemporaryFolder folder;
  struct Case {
    std::initializer_list<int> sizes;
    const char* what;
  };
  for (const Case& c : {Case{{30'000, 30'000, 30'000}, "impossible"}, Case{{1000, 1000, 1000}, "ends before"},
                        Case{{3, 2, 2, 5}, "4D"}, Case{{3, 0, 2}, "empty"}, Case{{3, -4, 2}, "empty"},
                        Case{{3, 2}, "not a 3D"}, Case{{3, 4, 1}, "single slice"}}) {
    HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(60));
    nifti.put_sizes(c.sizes);
    write_bytes(folder / "ct.nii", nifti.bytes);
    const auto ct = read_ct(folder / "ct.nii");
    ASSERT_FALSE(ct) << c.what;
    EXPECT_NE(ct.error().what.find(c.what), std::string::npos) << ct.error().text();
  }
}

TEST(Nifti, AcceptsOneTimePoint) {
  TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  nifti.put_sizes({3, 2, 2, 1});
  write_bytes(folder / "ct.nii", nifti.bytes);
  EXPECT_TRUE(read_ct(folder / "ct.nii"));
}

TEST(Nifti, WritesNiftiInRas) {
  TemporaryFolder folder;
  volume::GridGeometry g;
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

TEST(Nifti, ErrorNamesTheHeaderOfAPair) {
  const TemporaryFolder folder;
  HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
  std::memcpy(nifti.bytes.data() + 344, "ni1", 4);
  write_bytes(folder / "ct.nii", nifti.bytes);
  const auto ct = read_ct(folder / "ct.nii");
  ASSERT_FALSE(ct);
  EXPECT_NE(ct.error().text().find("header of a pair"), std::string::npos) << ct.error().text();
}

TEST(Nifti, VoxelsOfImpossibleSizeAreRefused) {
  const TemporaryFolder folder;
  for (const float mm : {1e10F, 1000.0F, 1e-5F}) {
    HandMadeNifti nifti = small_nifti(kNiftiInt16, numbers(12));
    nifti.put_spacing(mm, 3, 4);
    nifti.put_sform({mm, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
    write_bytes(folder / "ct.nii", nifti.bytes);
    const auto ct = read_ct(folder / "ct.nii");
    ASSERT_FALSE(ct) << mm;
    EXPECT_NE(ct.error().text().find("no scan has"), std::string::npos) << ct.error().text();
  }
}

TEST(Nifti, ErrorNamesInfinity) {
  const TemporaryFolder folder;
  const auto error_with = [&](float value) {
    std::vector<float> voxels(12, 5.0F);
    voxels[7] = value;
    write_bytes(folder / "ct.nii", small_nifti(kNiftiFloat, voxels).bytes);
    const auto ct = read_ct(folder / "ct.nii");
    return ct ? std::string("read") : ct.error().text();
  };
  EXPECT_NE(error_with(-std::numeric_limits<float>::infinity()).find("-infinity"), std::string::npos);
  EXPECT_NE(error_with(std::numeric_limits<float>::infinity()).find("+infinity"), std::string::npos);
  EXPECT_NE(error_with(std::numeric_limits<float>::quiet_NaN()).find("NaN"), std::string::npos);
}

}  // namespace
}  // namespace trocar::io
