#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "geometry/shapes.h"

namespace trocar {
inline namespace geometry {
namespace {

TriangleMesh box(const Vec3f& size, const Vec3f& corner) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n) {
    const Vec3f unit(static_cast<float>(n & 1), static_cast<float>((n >> 1) & 1), static_cast<float>(n >> 2));
    mesh.vertices.emplace_back(corner + unit.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A sphere by latitude and longitude.
TriangleMesh sphere(double radius_mm, std::uint32_t rings, std::uint32_t spokes) {
  TriangleMesh mesh;
  for (std::uint32_t r = 0; r <= rings; ++r)
    for (std::uint32_t s = 0; s < spokes; ++s) {
      const double latitude = std::numbers::pi * r / rings;
      const double longitude = 2.0 * std::numbers::pi * s / spokes;
      const Vec3 direction(std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                           std::cos(latitude));
      mesh.vertices.emplace_back((radius_mm * direction).cast<float>());
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < spokes; ++s) {
      const std::uint32_t a = r * spokes + s;
      const std::uint32_t b = r * spokes + (s + 1) % spokes;
      mesh.triangles.push_back({a, a + spokes, b});
      mesh.triangles.push_back({b, a + spokes, b + spokes});
    }
  return mesh;
}

TEST(TriangleMesh, VolumeAndAreaOfABox) {
  const TriangleMesh mesh = box({2, 3, 4}, {0, 0, 0});
  EXPECT_NEAR(enclosed_volume_mm3(mesh), 24.0, 1e-12);
  EXPECT_NEAR(area_mm2(mesh), 52.0, 1e-12);
}

TEST(TriangleMesh, VolumeIsTranslationInvariant) {
  EXPECT_NEAR(enclosed_volume_mm3(box({2, 3, 4}, {500, -300, 100})), 24.0, 1e-6);
}

TEST(TriangleMesh, VolumeIsNegativeInsideOut) {
  TriangleMesh mesh = box({2, 3, 4}, {0, 0, 0});
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NEAR(enclosed_volume_mm3(mesh), -24.0, 1e-12);
  EXPECT_NEAR(area_mm2(mesh), 52.0, 1e-12);
}

TEST(TriangleMesh, SphereVolumeConvergesQuadraticallyFromBelow) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * 1000.0;
  const double area = 4.0 * std::numbers::pi * 100.0;
  const TriangleMesh coarse = sphere(10.0, 50, 100);
  const TriangleMesh fine = sphere(10.0, 100, 200);
  const double coarse_gap = volume - enclosed_volume_mm3(coarse);
  const double fine_gap = volume - enclosed_volume_mm3(fine);
  EXPECT_GT(fine_gap, 0.0);
  EXPECT_NEAR(coarse_gap / fine_gap, 4.0, 0.05);
  EXPECT_NEAR((area - area_mm2(coarse)) / (area - area_mm2(fine)), 4.0, 0.05);
}

TEST(TriangleMesh, HasZeroVolumeAndAreaWithoutTriangles) {
  EXPECT_EQ(enclosed_volume_mm3({}), 0.0);
  EXPECT_EQ(area_mm2({}), 0.0);
}

}  // namespace
}  // namespace geometry
}  // namespace trocar
