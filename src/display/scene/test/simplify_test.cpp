#include "scene/detail/simplify.h"

#include <gtest/gtest.h>

#include "two_organs.h"

namespace trocar::scene {
namespace {

TEST(Simplify, ReducesTrianglesAndKeepsTheShape) {
  const TriangleMesh fine = ball({10, -20, 30}, 50.0);
  // The ball's own triangles are 7 degrees wide: chords over four of them lose a fifth of the volume.
  constexpr double kChords = 0.22;
  std::size_t last = fine.triangles.size();
  for (const double coarseness : {2.0, 3.0, 4.0}) {
    const auto [coarse, normals] = detail::simplify(fine, detail::vertex_normals(fine), coarseness);
    ASSERT_EQ(normals.size(), coarse.vertices.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
      EXPECT_GT(normals[i].dot((coarse.vertices[i] - Vec3f(10, -20, 30)).normalized()), 0.9F);
    }
    EXPECT_LT(coarse.triangles.size(), last);
    EXPECT_GT(coarse.triangles.size(), 50u);
    last = coarse.triangles.size();
    EXPECT_NEAR(enclosed_volume_mm3(coarse) / enclosed_volume_mm3(fine), 1.0, kChords);
  }
}

TEST(Decimate, KeepsTheShapeWithAQuarterOfTheTriangles) {
  // The ball has many vertices at its poles: the lattice makes them one.
  const TriangleMesh poled = ball({10, -20, 30}, 50.0);
  const TriangleMesh fine = detail::simplify(poled, detail::vertex_normals(poled), 0.8).mesh;
  const auto [coarse, normals] = detail::decimate(fine, 0.25);
  EXPECT_LT(coarse.triangles.size(), 0.35 * static_cast<double>(fine.triangles.size()));
  EXPECT_NEAR(enclosed_volume_mm3(coarse) / enclosed_volume_mm3(fine), 1.0, 0.05);
  EXPECT_EQ(normals.size(), coarse.vertices.size());
}

TEST(Simplify, KeepsAnEmptyMeshEmpty) {
  EXPECT_TRUE(detail::simplify({}, {}, 2.0).mesh.triangles.empty());
}

TEST(VertexNormals, PointOutwardOnABall) {
  const TriangleMesh mesh = ball({0, 0, 0}, 10.0);
  const std::vector<Vec3f> normals = detail::vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (normals[i].norm() > 0.5F) {
      EXPECT_GT(normals[i].dot(mesh.vertices[i].normalized()), 0.98F);
    }
  }
}

}  // namespace
}  // namespace trocar::scene
