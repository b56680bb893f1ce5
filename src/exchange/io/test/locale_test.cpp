// Every file is the same, and is read the same, whatever the user's locale writes for a decimal point.
#include <functional>
#include <map>

#include "core/testing/user_locale.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/mesh_file.h"
#include "io/sequence/transform_file.h"
#include "io/test/test_support.h"

namespace trocar::io {
namespace {

namespace fs = std::filesystem;

TriangleMesh tilted_triangle() {
  TriangleMesh mesh;
  mesh.vertices = {{0.25F, 1.5F, -3.75F}, {10.125F, 2.0F, 0.5F}, {-1.0F, 9.875F, 4.25F}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Pose tilted_pose() {
  return {Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3(12.25, -3.5, 104.125)};
}

/// Every kind of file that this module writes, with fractions in all its numbers.
const std::map<std::string, std::function<Status(const fs::path&)>>& writers() {
  static const std::map<std::string, std::function<Status(const fs::path&)>> all = [] {
    std::map<std::string, std::function<Status(const fs::path&)>> table;
    for (const char* name : {"ct.nii", "ct.nii.gz", "ct.nrrd", "ct.mha", "ct.mhd"})
      table[name] = [](const fs::path& path) {
        return write_image(testing::numbered_grid<std::int16_t>(testing::oblique_geometry()), path);
      };
    for (const char* name : {"skin.stl", "skin.vtp"})
      table[name] = [](const fs::path& path) { return write_mesh(tilted_triangle(), path); };
    table["pose.tfm"] = [](const fs::path& path) { return write_transform(tilted_pose(), path); };
    return table;
  }();
  return all;
}

std::map<std::string, std::string> written_in(const fs::path& folder) {
  std::map<std::string, std::string> bytes;
  fs::create_directory(folder);
  for (const auto& [name, write] : writers()) {
    const Status status = write(folder / name);
    EXPECT_TRUE(status) << name << ": " << status.error().text();
    bytes[name] = testing::read_bytes(folder / name);
  }
  return bytes;
}

class CommaLocale : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
};

TEST_P(CommaLocale, DoesNotChangeWrittenFiles) {
  const auto plain = [&] {
    const testing::UserLocale c("C");
    return written_in(folder_ / "plain");
  }();
  const testing::UserLocale user(GetParam());
  if (!user.is_there()) GTEST_SKIP() << GetParam() << " is not on this machine";
  ASSERT_STREQ(std::localeconv()->decimal_point, ",") << "the test must see commas";
  const auto local = written_in(folder_ / "local");
  for (const auto& [name, bytes] : plain) EXPECT_TRUE(local.at(name) == bytes) << name << " depends on the locale";
}

TEST_P(CommaLocale, DoesNotChangeReadNumbers) {
  const testing::UserLocale user(GetParam());
  if (!user.is_there()) GTEST_SKIP() << GetParam() << " is not on this machine";
  written_in(folder_ / "files");
  for (const char* name : {"ct.nii", "ct.nii.gz", "ct.nrrd", "ct.mha", "ct.mhd"}) {
    const auto read = read_ct(folder_ / "files" / name);
    ASSERT_TRUE(read) << name << ": " << read.error().text();
    constexpr double kSinglePrecision_mm = 1e-4;
    testing::expect_same_place(read->geometry, testing::oblique_geometry(), kSinglePrecision_mm);
  }
  const auto pose = read_transform(folder_ / "files" / "pose.tfm");
  ASSERT_TRUE(pose) << pose.error().text();
  EXPECT_LT((pose->p() - tilted_pose().p()).norm(), 1e-9);
  for (const char* name : {"skin.stl", "skin.vtp"}) {
    const auto mesh = read_mesh(folder_ / "files" / name);
    ASSERT_TRUE(mesh) << name << ": " << mesh.error().text();
    EXPECT_NEAR(area_mm2(*mesh), area_mm2(tilted_triangle()), 1e-4);
  }
}

TEST_P(CommaLocale, ReadsTextSurfaces) {
  testing::write_bytes(
      folder_ / "a.stl",
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0.5 0.25 0\nvertex 2.75 0.25 0\nvertex 0.5 4.5 0\n"
      "endloop\nendfacet\nendsolid a\n");
  const testing::UserLocale user(GetParam());
  if (!user.is_there()) GTEST_SKIP() << GetParam() << " is not on this machine";
  const auto mesh = read_mesh(folder_ / "a.stl");
  ASSERT_TRUE(mesh) << mesh.error().text();
  EXPECT_NEAR(area_mm2(*mesh), 0.5 * 2.25 * 4.25, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(OfUsers, CommaLocale, ::testing::Values("de_DE.UTF-8", "fr_FR.UTF-8", "tr_TR.UTF-8"));

}  // namespace
}  // namespace trocar::io
