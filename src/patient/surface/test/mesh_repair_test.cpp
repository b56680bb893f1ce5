#include <gtest/gtest.h>

#include "surface/detail/contour.h"

namespace trocar::surface {
namespace {

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

TEST(CloseHoles, RestoresAMissingTriangle) {
  const double volume = enclosed_volume_mm3(octahedron());
  EXPECT_NEAR(volume, 4.0 / 3.0, 1e-6);
  for (std::size_t n = 0; n < 8; ++n) {
    TriangleMesh mesh = octahedron();
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(n));
    detail::close_holes(mesh);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_NEAR(enclosed_volume_mm3(mesh), volume, 1e-6);
  }
}

TEST(CloseHoles, SpansALargerHoleByAFan) {
  TriangleMesh mesh = octahedron();
  mesh.triangles.resize(4);  // the upper half: a pyramid without its base
  detail::close_holes(mesh);
  EXPECT_EQ(mesh.triangles.size(), 6u);
  EXPECT_NEAR(enclosed_volume_mm3(mesh), 2.0 / 3.0, 1e-6);
}

TEST(CloseHoles, KeepsAClosedMesh) {
  TriangleMesh mesh = octahedron();
  detail::close_holes(mesh);
  EXPECT_EQ(mesh.triangles, octahedron().triangles);
}

TEST(RestoreVolume, MovesTheSurfaceOutAndIn) {
  for (const double volume : {1.3, 1.36}) {
    TriangleMesh mesh = octahedron();
    detail::restore_volume(mesh, volume, 1.0);
    EXPECT_NEAR(enclosed_volume_mm3(mesh), volume, 0.02);
  }
}

TEST(RestoreVolume, NeverMovesFartherThanAllowed) {
  TriangleMesh mesh = octahedron();
  detail::restore_volume(mesh, 100.0, 0.1);
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
    EXPECT_NEAR((mesh.vertices[n] - octahedron().vertices[n]).norm(), 0.1, 1e-5);
}

}  // namespace
}  // namespace trocar::surface
