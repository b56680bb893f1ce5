// Where a voxel lies, by the header of each format: hand-made headers, also such that contradict themselves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/image/detail/itk_image.h"
#include "io/image/detail/volume_file.h"
#include "io/image/image_file.h"
#include "io/image/testing/hand_made_nifti.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

using testing::HandMadeNifti;
using testing::numbers;
using testing::small_nifti;
using testing::write_bytes;

constexpr std::int16_t kInt16 = 4;

class StatedPlaceTest : public ::testing::Test {
 protected:
  /// Where the voxel with this value lies (LPS, mm), or the error.
  Result<Vec3> place_of(const fs::path& file, std::int16_t value) {
    TROCAR_TRY(const CtScan scan, read_ct_scan(file));
    warnings_ = scan.warnings;
    const auto found = std::find(scan.grid.voxels.begin(), scan.grid.voxels.end(), value);
    if (found == scan.grid.voxels.end()) return fail("the value is gone", file.string(), "");
    const auto offset = static_cast<std::size_t>(found - scan.grid.voxels.begin());
    return scan.grid.geometry.centre_mm(scan.grid.geometry.index_of(offset));
  }
  void expect_at(const std::string& name, const std::string& bytes, std::int16_t value, const Vec3& place_P) {
    write_bytes(folder_ / name, bytes);
    const auto place = place_of(folder_ / name, value);
    ASSERT_TRUE(place) << place.error().text();
    EXPECT_LT((*place - place_P).norm(), 1e-4) << place->transpose();
  }
  void expect_refused(const std::string& name, const std::string& bytes, const std::string& words) {
    write_bytes(folder_ / name, bytes);
    const auto read = read_ct_scan(folder_ / name);
    ASSERT_FALSE(read) << words;
    EXPECT_NE(read.error().text().find(words), std::string::npos) << read.error().text();
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

// NIfTI: voxel value 8 is i=2, j=0, k=1 of small_nifti(), at RAS (14, 20, 34).

HandMadeNifti plain_nifti() {
  return small_nifti(kInt16, numbers(12));
}

/// A qform beside the sform, moved by `x_mm` to the right.
HandMadeNifti with_qform(float x_mm) {
  HandMadeNifti nifti = plain_nifti();
  nifti.put<std::int16_t>(252, 1);
  nifti.put<float>(76, 1.0F);
  nifti.put<float>(268, 10.0F + x_mm), nifti.put<float>(272, 20.0F), nifti.put<float>(276, 30.0F);
  return nifti;
}

TEST_F(StatedPlaceTest, UsesTheSformAndComparesTheQform) {
  expect_at("a.nii", with_qform(0.0F).bytes, 8, {-14, -20, 34});
  EXPECT_TRUE(warnings_.empty());
  expect_at("a.nii", with_qform(40.0F).bytes, 8, {-14, -20, 34});
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0], "a.nii: sform and qform differ by 40 mm; the sform is used, as by TotalSegmentator");
}

TEST_F(StatedPlaceTest, AppliesTheQuaternion) {
  HandMadeNifti nifti = with_qform(0.0F);
  nifti.put<std::int16_t>(254, 0);
  // 90 degrees about z: i runs to anterior, j to left.
  nifti.put<float>(264, std::sqrt(0.5F));
  expect_at("a.nii", nifti.bytes, 8, {-10, -24, 34});
  nifti.put<float>(264, 1.2F);
  expect_refused("a.nii", nifti.bytes, "qform is not a rotation");
}

TEST_F(StatedPlaceTest, TwoSizesOfAVoxelAreRefused) {
  for (const float factor : {0.1F, 0.98F, 1.02F, 6.0F}) {
    HandMadeNifti nifti = plain_nifti();
    nifti.put_spacing(2 * factor, 3, 4);
    expect_refused("a.nii", nifti.bytes, "by pixdim, 2 x 3 x 4 mm by the sform");
  }
  HandMadeNifti unstated = plain_nifti();
  unstated.put_spacing(0, 0, 0);
  expect_at("a.nii", unstated.bytes, 8, {-14, -20, 34});
}

TEST_F(StatedPlaceTest, RefusesNonFiniteNiftiHeaderNumbers) {
  for (const float bad : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    for (std::size_t n = 0; n < 12; ++n) {
      HandMadeNifti nifti = plain_nifti();
      nifti.put<float>(280 + 4 * n, bad);
      expect_refused("a.nii", nifti.bytes, "sform contains a number that is not finite");
    }
    HandMadeNifti pixdim = plain_nifti();
    pixdim.put<float>(84, bad);
    expect_refused("a.nii", pixdim.bytes, "pixdim contains a number that is not finite");
    HandMadeNifti slope = plain_nifti();
    slope.put<float>(112, bad);
    expect_refused("a.nii", slope.bytes, "scl_slope");
    HandMadeNifti offset = plain_nifti();
    offset.put<float>(108, bad);
    expect_refused("a.nii", offset.bytes, "vox_offset");
  }
}

TEST_F(StatedPlaceTest, ASlopeOfZeroMeansNoScaling) {
  HandMadeNifti nifti = plain_nifti();
  nifti.put<float>(112, 0.0F), nifti.put<float>(116, -1024.0F);
  write_bytes(folder_ / "a.nii", nifti.bytes);
  const auto ct = read_ct(folder_ / "a.nii");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels, numbers(12));
}

TEST_F(StatedPlaceTest, ToleratesASmallShearAndRefusesALargeOne) {
  HandMadeNifti nifti = plain_nifti();
  nifti.put_sform({2, 3 * 3e-4F, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  expect_at("a.nii", nifti.bytes, 0, {-10, -20, 30});
  nifti.put_sform({2, 3 * 3e-3F, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30});
  expect_refused("a.nii", nifti.bytes, "sheared");
}

TEST_F(StatedPlaceTest, ReadsNifti2) {
  HandMadeNifti nifti;
  nifti.bytes.assign(544, '\0');
  nifti.put<std::int32_t>(0, 540);
  std::memcpy(nifti.bytes.data() + 4, "n+2", 4);
  nifti.put<std::int16_t>(12, kInt16), nifti.put<std::int16_t>(14, 16);
  for (std::size_t n = 0; const std::int64_t size : {3, 3, 2, 2}) nifti.put(16 + 8 * n++, size);
  for (std::size_t n = 0; const double spacing : {2.0, 3.0, 4.0}) nifti.put(112 + 8 * n++, spacing);
  nifti.put<std::int64_t>(168, 544);
  nifti.put<double>(176, 1.0);
  nifti.put<std::int32_t>(348, 2);
  for (std::size_t n = 0; const double entry : {2.0, 0.0, 0.0, 10.0, 0.0, 3.0, 0.0, 20.0, 0.0, 0.0, 4.0, 30.0})
    nifti.put(400 + 8 * n++, entry);
  nifti.add_voxels(numbers(12));
  expect_at("a.nii", nifti.bytes, 8, {-14, -20, 34});
}

TEST_F(StatedPlaceTest, MatchesItkForAnObliqueNifti) {
  const volume::CtGrid ct = testing::numbered_grid<std::int16_t>(testing::oblique_geometry());
  ASSERT_TRUE(write_image(ct, folder_ / "a.nii.gz"));
  const auto ours = detail::read_volume_file(folder_ / "a.nii.gz");
  ASSERT_TRUE(ours) << ours.error().text();
  auto file = InputFile::open(folder_ / "a.nii.gz", FileKind::kVolume);
  ASSERT_TRUE(file);
  const auto by_itk = detail::read_with_itk({*std::move(file), folder_ / "a.nii.gz"}, detail::ImageFormat::kNifti);
  ASSERT_TRUE(by_itk) << by_itk.error().text();
  ASSERT_EQ(by_itk->type, ours->type);
  EXPECT_EQ(std::memcmp(by_itk->bytes.get(), ours->bytes.get(), ours->byte_count()), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    EXPECT_NEAR(by_itk->spacing_mm[n], ours->geometry.spacing_mm[axis], 1e-5);
    EXPECT_NEAR(by_itk->origin_P[n], ours->geometry.origin_P[axis], 1e-4);
    for (int row = 0; row < 3; ++row)
      EXPECT_NEAR(by_itk->axes_P[n][static_cast<std::size_t>(row)], ours->geometry.R_PV(row, axis), 1e-6);
  }
}

// NRRD: voxel value 8 is i=2, j=0, k=1.

std::string voxel_bytes() {
  const auto voxels = numbers(12);
  return {reinterpret_cast<const char*>(voxels.data()), 2 * voxels.size()};
}

std::string nrrd(const std::string& place, const std::string& more = {}) {
  return "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\nencoding: raw\n" + place + more + "\n" +
         voxel_bytes();
}

std::string nrrd_in(const std::string& space) {
  return nrrd("space: " + space + "\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n");
}

TEST_F(StatedPlaceTest, ReadsAnatomicalSpaces) {
  expect_at("a.nrrd", nrrd_in("left-posterior-superior"), 8, {14, 20, 34});
  expect_at("a.nrrd", nrrd_in("LPS"), 8, {14, 20, 34});
  expect_at("a.nrrd", nrrd_in("right-anterior-superior"), 8, {-14, -20, 34});
  expect_at("a.nrrd", nrrd_in("RAS"), 8, {-14, -20, 34});
  expect_at("a.nrrd", nrrd_in("left-anterior-superior"), 8, {14, -20, 34});
  expect_at("a.nrrd", nrrd_in("LAS"), 8, {14, -20, 34});
}

TEST_F(StatedPlaceTest, RefusesNonAnatomicalSpaces) {
  for (const char* space :
       {"3D-left-handed", "3D-right-handed", "scanner-xyz", "scanner-xyz-time", "LPST", "elsewhere"})
    expect_refused("a.nrrd", nrrd_in(space), fmt::format("space \"{}\" does not say", space));
  expect_refused("a.nrrd", nrrd("space dimension: 3\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n"),
                 "no field \"space\"");
  expect_refused("a.nrrd", nrrd("spacings: 2 3 4\n"), "no field \"space\"");
  // A pair is not a field.
  expect_refused("a.nrrd", nrrd("space:=LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n"), "no field \"space\"");
}

TEST_F(StatedPlaceTest, RefusesUnitsOtherThanMillimetres) {
  const std::string place = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
  expect_at("a.nrrd", nrrd(place, "space units: \"mm\" \"mm\" \"mm\"\n"), 8, {14, 20, 34});
  expect_at("a.nrrd", nrrd(place, "space units: \"\" \"\" \"\"\n"), 8, {14, 20, 34});
  for (const char* unit : {"cm", "m", "um"})
    expect_refused("a.nrrd", nrrd(place, fmt::format("space units: \"mm\" \"{}\" \"mm\"\n", unit)), "not mm");
}

TEST_F(StatedPlaceTest, RefusesInvalidDirections) {
  for (const char* directions :
       {"(2,0,0) (0,3,0)", "(2,0,0) (0,3,0) none", "(2,0,0) (0,3,0) (0,0,nan)", "(2,0,0) (0,3,0) (0,0,inf)",
        "(2,0,0) (0,3,0) (0,0,4) (1,1,1)", "2,0,0 0,3,0 0,0,4", "(2,0) (0,3) (0,4)"})
    expect_refused("a.nrrd", nrrd(fmt::format("space: LPS\nspace origin: (0,0,0)\nspace directions: {}\n", directions)),
                   "no three \"space directions\"");
  expect_refused("a.nrrd", nrrd("space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\n"), "one \"space origin\"");
  expect_refused("a.nrrd", nrrd("space: LPS\nspace origin: (0,0,0)\nspace directions: (2,0,0) (0,0,0) (0,0,4)\n"),
                 "without extent");
}

TEST_F(StatedPlaceTest, LimitsTheSizeOfATextHeader) {
  const std::string place = "space: LPS\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n";
  expect_refused("a.nrrd", nrrd(place, "comment: " + std::string(3'000, 'A') + "\n"), "a field of 3009 characters");
  expect_refused("a.nrrd", nrrd(place, "content: " + std::string(600, 'A') + "\n"), "a field of 609 characters");
  std::string no_order = nrrd(place);
  no_order.replace(no_order.find("little"), 6, std::string(300, '4'));
  expect_refused("a.nrrd", no_order, "neither little nor big");
  expect_refused("a.nrrd", nrrd(place, "comment: hello\n"), "\"comment\", which NRRD does not know");
  expect_refused("a.nrrd", nrrd(place, "space: LPS\n"), "\"space\" twice");
  expect_refused("a.nrrd", nrrd(place, "key:=" + std::string(70'000, 'A') + "\n"), "longer than");
  std::string many;
  for (int n = 0; n < 10'000; ++n) many += "key" + std::to_string(n) + ":=value\n";
  expect_refused("a.nrrd", nrrd(place, many), "more than 10000 lines");
  const auto pairs = [](std::size_t count) {  // of 64,000 bytes each
    std::string text;
    for (std::size_t n = 0; n < count; ++n) text += fmt::format("key{:04}:={}\n", n, std::string(63'990, 'A'));
    return text;
  };
  expect_at("a.nrrd", nrrd(place, pairs(65)), 8, {14, 20, 34});
  expect_refused("a.nrrd", nrrd(place, pairs(66)), "more than 4 MiB");
  expect_refused("a.nrrd", nrrd(place, pairs(300)), "more than 4 MiB");
  expect_refused("a.nrrd", nrrd(place, std::string(5'000, '8') + "\n"), "line 10 of the header is no field");
  expect_refused("a.nrrd", nrrd(place, std::string(5'000, 'k') + ":=v\n"), "line 10 of the header is no field");
  expect_at("a.nrrd", nrrd(place, "# " + std::string(5'000, 'A') + "\n"), 8, {14, 20, 34});
  // Read by the library into an array on the stack.
  std::string text = nrrd(place);
  text.replace(text.find("raw"), 3, "ascii");
  text.resize(text.size() - voxel_bytes().size());
  expect_refused("a.nrrd", text + "1 2 3 4 5 6 7 8 9 10 11 1" + std::string(5'000, '0'), "more than 60 letters");
  // What 3D Slicer writes fits.
  expect_at("a.nrrd", nrrd(place, "key:=" + std::string(30'000, 'A') + "\n" + many.substr(0, 60'000)), 8, {14, 20, 34});
}

// MetaImage: voxel value 8 is i=2, j=0, k=1.

const std::string kMetaPlace = "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\n";

std::string meta(const std::string& place, const std::string& more = {}) {
  return "ObjectType = Image\nNDims = 3\n" + place + "DimSize = 3 2 2\nElementType = MET_SHORT\n" + more +
         "ElementDataFile = LOCAL\n" + voxel_bytes();
}

TEST_F(StatedPlaceTest, ReadsTheRowsOfTheTransformMatrixAsAxes) {
  expect_at("a.mha", meta(kMetaPlace), 8, {14, 20, 34});
  // i runs along +y, j along -x.
  expect_at("a.mha", meta("TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\n"), 8,
            {10, 24, 34});
}

TEST_F(StatedPlaceTest, RefusesAMetaImageWithContradictoryPosition) {
  expect_at("a.mha", meta(kMetaPlace, "AnatomicalOrientation = RAI\nDistanceUnits = mm\n"), 8, {14, 20, 34});
  expect_at("a.mha", meta(kMetaPlace, "AnatomicalOrientation = ???\n"), 8, {14, 20, 34});
  for (const char* letters : {"LAI", "RPI", "RAS", "LPS", "IAR"})
    expect_refused("a.mha", meta(kMetaPlace, fmt::format("AnatomicalOrientation = {}\n", letters)), letters);
  for (const char* unit : {"cm", "um", "m"})
    expect_refused("a.mha", meta(kMetaPlace, fmt::format("DistanceUnits = {}\n", unit)), "not mm");
  expect_refused("a.mha", meta(""), "TransformMatrix");
  expect_refused("a.mha", meta("TransformMatrix = 1 0 0 0 1 0 0 0 1\nElementSpacing = 2 3 4\n"), "Offset");
  expect_refused("a.mha", meta(kMetaPlace, "Position = 1 2 3\n"), "both Offset and Position");
  expect_refused("a.mha", meta("TransformMatrix = 2 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 2 3 4\n"),
                 "scales");
  expect_refused("a.mha", meta("TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 2 3 0\n"),
                 "not above zero");
  expect_refused("a.mha", meta("TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 nan\nElementSpacing = 2 3 4\n"),
                 "3 finite numbers");
}

TEST_F(StatedPlaceTest, RefusesAMetaImageThatItkMisreads) {
  for (const char* dimensions : {"-3", "0", "2", "4", "3.5", "x"}) {
    std::string bytes = meta(kMetaPlace);
    bytes.replace(bytes.find("NDims = 3"), 9, fmt::format("NDims = {}", dimensions));
    expect_refused("a.mha", bytes, "NDims");
  }
  expect_refused("a.mha", meta(kMetaPlace, "CompressedData = True\n"), "no CompressedDataSize");
  expect_refused("a.mha", meta(kMetaPlace, "HeaderSize = 12\n"), "HeaderSize");
  expect_refused("a.mha", meta(kMetaPlace, "Comment = " + std::string(300, 'A') + "\n"), "too long");
  // A field that MetaIO does not know in this spelling: it would read a spacing of 1 mm.
  std::string lower = meta(kMetaPlace);
  lower.replace(lower.find("ElementSpacing"), 14, "elementspacing");
  expect_refused("a.mha", lower, "understood differently");
}

TEST_F(StatedPlaceTest, AppliesTheIntensityFunctionOfAMetaImage) {
  write_bytes(folder_ / "a.mha",
              meta(kMetaPlace, "ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -1024\n"));
  const auto ct = read_ct(folder_ / "a.mha");
  ASSERT_TRUE(ct) << ct.error().text();
  EXPECT_EQ(ct->voxels[8], 2 * 8 - 1024);
}

}  // namespace
}  // namespace trocar::io
