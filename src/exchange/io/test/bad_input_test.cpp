#include <algorithm>
#include <cstdlib>

#include "io/image/image_file.h"
#include "io/mesh_file.h"
#include "io/patient/label_sources.h"
#include "io/sequence/transform_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::test_data;

std::vector<std::filesystem::path> regular_files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// A volume that could be one, or an error of one line that names the file and says what to do.
void expect_volume_or_one_line(const Result<volume::CtGrid>& ct, const std::string& name) {
  if (ct) {
    EXPECT_EQ(ct->voxels.size(), ct->geometry.voxel_count());
    EXPECT_GT(ct->voxels.size(), 0U);
    EXPECT_TRUE((ct->geometry.spacing_mm.array() > 0.0).all());
    EXPECT_NEAR(ct->geometry.R_PV.determinant(), 1.0, 1e-9);
    return;
  }
  EXPECT_FALSE(ct.error().what.empty());
  EXPECT_FALSE(ct.error().advice.empty()) << ct.error().text();
  EXPECT_NE(ct.error().where.find(name), std::string::npos) << ct.error().text();
  EXPECT_EQ(ct.error().text().find('\n'), std::string::npos);
}

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_)) GTEST_SKIP() << "no real data at " << data_;
    ::testing::internal::CaptureStderr();
    ::testing::internal::CaptureStdout();
  }
  void TearDown() override {
    if (IsSkipped()) return;
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  }
  std::filesystem::path data_ = test_data() / "bad-input";
  TemporaryFolder folder_;
};

TEST_F(BadInput, IsReadOrRefusedInOneLine) {
  for (const auto& file : regular_files_below(data_)) {
    SCOPED_TRACE(file.string());
    expect_volume_or_one_line(read_ct(file), file.filename().string());
    (void)read_labels(file);
    (void)read_float(file);
    (void)read_label_sources({file}, "totalsegmentator");
    EXPECT_FALSE(read_transform(file));
    EXPECT_FALSE(read_mesh(file));
  }
}

TEST_F(BadInput, IsReadOrRefusedAsADicomFolder) {
  for (const auto& file : regular_files_below(data_ / "dicom")) {
    SCOPED_TRACE(file.string());
    const auto alone = folder_ / file.stem().string();
    std::filesystem::create_directory(alone);
    std::filesystem::copy_file(file, alone / file.filename());
    expect_volume_or_one_line(read_ct(alone), alone.filename().string());
    (void)read_label_sources({alone}, "");
  }
}

TEST_F(BadInput, DuplicatedDicomFileIsRefusedOrIgnored) {
  // Two slices in one place or none: whatever the header says, its pixels are never trusted with a place. An enhanced
  // file is a volume by itself, and its copy is left out.
  for (const auto& file : regular_files_below(data_ / "dicom")) {
    SCOPED_TRACE(file.string());
    const auto twice = folder_ / (file.stem().string() + "_twice");
    std::filesystem::create_directory(twice);
    std::filesystem::copy_file(file, twice / "a");
    const auto once = read_ct(twice);
    std::filesystem::copy_file(file, twice / "b");
    const auto doubled = read_ct(twice);
    EXPECT_EQ(once.has_value(), doubled.has_value());
    EXPECT_TRUE(!once || !doubled || once->voxels == doubled->voxels);
  }
}

TEST_F(BadInput, RefusesDeflatedDicomExplicitly) {
  const auto deflated = data_ / "dicom" / "image_dfl.dcm";
  if (!std::filesystem::exists(deflated)) GTEST_SKIP() << "no test data at " << deflated;
  std::filesystem::copy_file(deflated, folder_ / "slice.dcm");
  const auto volume = read_ct(folder_.path());
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().text().find("deflated"), std::string::npos) << volume.error().text();
}

TEST_F(BadInput, IsReadOrRefusedWhenCutInHalf) {
  for (const auto& file : regular_files_below(data_)) {
    SCOPED_TRACE(file.string());
    const std::string whole = testing::read_bytes(file);
    const auto cut = folder_ / ("cut_" + file.filename().string());
    testing::write_bytes(cut, whole.substr(0, whole.size() / 2));
    expect_volume_or_one_line(read_ct(cut), cut.filename().string());
  }
}

}  // namespace
}  // namespace trocar::io
