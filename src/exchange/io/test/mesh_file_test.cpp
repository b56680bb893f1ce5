#include "io/mesh_file.h"

#include <cmath>

#include "io/test/test_support.h"

namespace trocar::io {
namespace {

using testing::read_bytes;
using testing::write_bytes;

/// A sphere of triangles facing outward.
TriangleMesh sphere(double radius_mm) {
  constexpr std::uint32_t kRings = 12, kSides = 24;
  TriangleMesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring)
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const double polar = M_PI * ring / kRings, around = 2.0 * M_PI * side / kSides;
      mesh.vertices.push_back(
          (radius_mm * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)))
              .cast<float>());
    }
  for (std::uint32_t ring = 0; ring < kRings; ++ring)
    for (std::uint32_t side = 0; side < kSides; ++side) {
      const std::uint32_t next = (side + 1) % kSides;
      const std::uint32_t a = ring * kSides + side, b = ring * kSides + next, c = a + kSides, d = b + kSides;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  return mesh;
}

class Meshes : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / (std::string("liver") + GetParam());
};

TEST_P(Meshes, KeepShapeAndOrientation) {
  const TriangleMesh mesh = sphere(30.0);
  ASSERT_TRUE(write_mesh(mesh, path_));
  const auto read = read_mesh(path_);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->triangles.size() > 0, true);
  EXPECT_NEAR(enclosed_volume_mm3(*read) / enclosed_volume_mm3(mesh), 1.0, 1e-5);
  EXPECT_NEAR(area_mm2(*read) / area_mm2(mesh), 1.0, 1e-5);
}

TEST_P(Meshes, AreRefusedWithoutOutputWhenTruncated) {
  ASSERT_TRUE(write_mesh(sphere(30.0), path_));
  const std::string whole = read_bytes(path_);
  const auto cut = folder_ / (std::string("cut") + GetParam());
  ::testing::internal::CaptureStderr();
  for (const double part : {0.0, 0.05, 0.3, 0.6, 0.9}) {
    write_bytes(cut, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    EXPECT_FALSE(read_mesh(cut)) << part;
  }
  write_bytes(cut, "hello");
  EXPECT_FALSE(read_mesh(cut));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, Meshes, ::testing::Values(".vtp", ".stl"));

TEST(MeshFile, KeepsVertexOrderInVtp) {
  TemporaryFolder folder;
  const TriangleMesh mesh = sphere(30.0);
  ASSERT_TRUE(write_mesh(mesh, folder / "liver.vtp"));
  const auto read = read_mesh(folder / "liver.vtp");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->vertices, mesh.vertices);
  EXPECT_EQ(read->triangles, mesh.triangles);
}

TEST(MeshFile, StatesItsFrameIn3dSlicerTerms) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_mesh(sphere(30.0), folder / "liver.stl"));
  EXPECT_NE(read_bytes(folder / "liver.stl").substr(0, 80).find("SPACE=LPS"), std::string::npos);
}

TEST(MeshFile, RefusesOtherEndings) {
  TemporaryFolder folder;
  EXPECT_FALSE(write_mesh(sphere(30.0), folder / "liver.obj"));
  EXPECT_FALSE(read_mesh(folder / "liver.stl"));
  EXPECT_TRUE(folder.is_empty());
}

}  // namespace
}  // namespace trocar::io
