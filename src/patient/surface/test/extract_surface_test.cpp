#include "surface/extract_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stop_token>
#include <thread>

#include "core/progress.h"
#include "core/random.h"
#include "surface/detail/contour.h"

namespace trocar::surface {
namespace {

volume::GridGeometry cube(std::int64_t size, const Vec3& spacing_mm) {
  volume::GridGeometry geometry;
  geometry.size = {size, size, size};
  geometry.spacing_mm = spacing_mm;
  return geometry;
}

volume::MaskGrid fill(const volume::GridGeometry& geometry, const auto& is_inside) {
  volume::MaskGrid mask(geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    mask.voxels[n] = is_inside(geometry.centre_mm(ijk));
  }
  return mask;
}

volume::MaskGrid ball(const volume::GridGeometry& geometry, const Vec3& centre_P, double radius_mm) {
  return fill(geometry, [&](const Vec3& p_P) { return (p_P - centre_P).norm() < radius_mm; });
}

double voxel_volume_mm3(const volume::MaskGrid& mask) {
  return static_cast<double>(std::count(mask.voxels.begin(), mask.voxels.end(), 1)) * mask.geometry.voxel_volume_mm3();
}

/// Every edge is walked as often in one direction as in the other: no hole, and all triangles face the same side.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> walks;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangle[c];
      const std::uint32_t b = triangle[(c + 1) % 3];
      walks[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return std::all_of(walks.begin(), walks.end(), [](const auto& edge) { return edge.second == 0; });
}

// Wherever the stop comes, no half-made surface is returned.
TEST(ExtractSurface, StopsWhenCancelled) {
  const volume::GridGeometry geometry = cube(150, Vec3::Ones());
  const volume::MaskGrid mask = ball(geometry, Vec3::Constant(75.0), 60.0);
  std::stop_source source;
  const CancellationScope scope(source.get_token());
  const std::jthread stop([&source] { source.request_stop(); });
  EXPECT_THROW(extract_surface(mask, {}), Cancelled);
}

TEST(ExtractSurface, ASphereKeepsVolumeAndRadius) {
  constexpr double kRadiusMm = 15.0;
  const Vec3 centre_P(20.0, 20.0, 20.0);
  const volume::MaskGrid mask = ball(cube(41, {1, 1, 1}), centre_P, kRadiusMm);
  const TriangleMesh mesh = extract_surface(mask);
  ASSERT_FALSE(mesh.triangles.empty());
  EXPECT_TRUE(is_closed(mesh));
  // Positive: triangles face outward.
  EXPECT_NEAR(enclosed_volume_mm3(mesh) / voxel_volume_mm3(mask), 1.0, 0.005);
  EXPECT_NEAR(enclosed_volume_mm3(mesh) / (4.0 / 3.0 * M_PI * std::pow(kRadiusMm, 3)), 1.0, 0.02);
  for (const Vec3f& vertex : mesh.vertices)
    EXPECT_NEAR((vertex.cast<double>() - centre_P).norm(), kRadiusMm, 1.0);  // a voxel
}

TEST(ExtractSurface, SmoothingRemovesStairsteps) {
  const volume::MaskGrid mask = ball(cube(41, {1, 1, 1}), {20, 20, 20}, 15.0);
  SurfaceOptions rough;
  rough.smoothing_iterations = 0;
  rough.decimate_to_fraction = 1.0;
  SurfaceOptions smooth = rough;
  smooth.smoothing_iterations = 20;
  const double sphere_mm2 = 4.0 * M_PI * 15.0 * 15.0;
  const double rough_error = area_mm2(extract_surface(mask, rough)) / sphere_mm2 - 1.0;
  const double smooth_error = area_mm2(extract_surface(mask, smooth)) / sphere_mm2 - 1.0;
  EXPECT_GT(rough_error, 0.05);
  EXPECT_LT(std::abs(smooth_error), 0.02);
}

TEST(ExtractSurface, PlacesARotatedAnisotropicGrid) {
  volume::GridGeometry geometry;
  geometry.size = {60, 50, 24};
  geometry.spacing_mm = {0.8, 0.9, 2.5};
  geometry.R_PV = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  geometry.origin_P = {-100.0, 40.0, 300.0};
  const Vec3 centre_P = geometry.to_mm({30.0, 25.0, 12.0});
  const TriangleMesh mesh = extract_surface(ball(geometry, centre_P, 16.0));
  ASSERT_FALSE(mesh.vertices.empty());
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume_mm3(mesh) / (4.0 / 3.0 * M_PI * std::pow(16.0, 3)), 1.0, 0.02);
  for (const Vec3f& vertex : mesh.vertices)
    EXPECT_NEAR((vertex.cast<double>() - centre_P).norm(), 16.0, 2.5);  // the widest voxel
}

TEST(ExtractSurface, ClosesAStructureCutByTheGrid) {
  const volume::MaskGrid mask = ball(cube(30, {1, 1, 1}), {0, 15, 29}, 12.0);
  const TriangleMesh mesh = extract_surface(mask);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume_mm3(mesh) / voxel_volume_mm3(mask), 1.0, 0.02);
}

TEST(ExtractSurface, ClosesRaggedMasks) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const volume::GridGeometry geometry = cube(24, {1, 1.3, 2});
    volume::MaskGrid mask(geometry);
    for (auto& voxel : mask.voxels) voxel = random.uniform() < 0.4 ? 1 : 0;
    EXPECT_TRUE(is_closed(extract_surface(mask))) << seed;
  }
}

TEST(ExtractSurface, CoarsensALargeStructureAndKeepsItsVolume) {
  // 1.8 million voxels of 0.6 mm, with ribs on it and a hollow in it.
  const volume::MaskGrid mask = fill(cube(160, {0.6, 0.6, 0.6}), [](const Vec3& p_P) {
    const Vec3 r = p_P - Vec3(48, 48, 48);
    return r.norm() < 44.0 + 1.5 * std::sin(0.4 * r.x()) && (r - Vec3(10, 0, 0)).norm() > 8.0;
  });
  SurfaceOptions options;
  options.max_triangles = 20000;
  const TriangleMesh mesh = extract_surface(mask, options);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(enclosed_volume_mm3(mesh) / voxel_volume_mm3(mask), 1.0, 0.005);
  EXPECT_LT(mesh.triangles.size(), 21000u);
  for (const Vec3f& vertex : mesh.vertices) {
    const Vec3 r = vertex.cast<double>() - Vec3(48, 48, 48);
    const double outer_mm = std::abs(r.norm() - 44.0 - 1.5 * std::sin(0.4 * r.x()));
    const double inner_mm = std::abs((r - Vec3(10, 0, 0)).norm() - 8.0);
    EXPECT_LT(std::min(outer_mm, inner_mm), 1.5);  // a coarse voxel
  }
}

TEST(BoundedOccupancy, CountsTheFacesOfABlock) {
  const volume::GridGeometry grid = cube(8, {1, 1, 1});
  EXPECT_EQ(detail::count_faces(detail::occupancy(volume::MaskGrid(grid, 1), 0.0)), 6u * 64u);
  const volume::MaskGrid corner = fill(grid, [](const Vec3& p) { return p.maxCoeff() < 1.5; });
  EXPECT_EQ(detail::count_faces(detail::occupancy(corner, 0.0)), 24u);
  EXPECT_EQ(detail::count_faces(detail::occupancy(volume::MaskGrid(grid), 0.0)), 0u);
}

TEST(BoundedOccupancy, CoarsensNoiseUntilItsSurfaceIsBounded) {
  const volume::GridGeometry grid = cube(64, {0.7, 0.7, 2.0});
  std::uint64_t n = 0;
  const volume::MaskGrid noise = fill(grid, [&](const Vec3&) { return uniform01(7, n++) < 0.5; });
  ASSERT_GT(detail::count_faces(detail::occupancy(noise, 0.0)), 300'000u);
  for (const std::size_t most : {100'000u, 10'000u, 100u})
    EXPECT_LE(detail::count_faces(detail::bounded_occupancy(noise, 0.0, most, most)), most);
  // An organ is left as it is.
  const volume::MaskGrid organ = ball(grid, {22, 22, 60}, 18.0);
  EXPECT_EQ(detail::bounded_occupancy(organ, 0.0, 100'000u, 100'000u).voxels, detail::occupancy(organ, 0.0).voxels);
}

TEST(ExtractSurface, SmoothingDoesNotStretch) {
  // Two balls 180 mm apart in one mask. VTK's filter alone moves them 0.4 mm further apart.
  volume::GridGeometry geometry = cube(20, {1, 1, 1});
  geometry.size[2] = 200;
  const volume::MaskGrid mask = fill(geometry, [](const Vec3& p_P) {
    return (p_P - Vec3(10, 10, 10)).norm() < 8.0 || (p_P - Vec3(10, 10, 190)).norm() < 8.0;
  });
  double sum[2] = {0.0, 0.0};
  int count[2] = {0, 0};
  SurfaceOptions options;
  options.decimate_to_fraction = 1.0;  // the vertices stay evenly spread
  for (const Vec3f& vertex : extract_surface(mask, options).vertices) {
    const int n = vertex.z() > 100.0F ? 1 : 0;
    sum[n] += static_cast<double>(vertex.z());
    ++count[n];
  }
  EXPECT_NEAR(sum[1] / count[1] - sum[0] / count[0], 180.0, 0.02);
}

TEST(ExtractSurface, ReturnsNothingForAnEmptyMask) {
  EXPECT_TRUE(extract_surface(volume::MaskGrid(cube(8, {1, 1, 1}))).vertices.empty());
}

anatomy::VirtualPatient small_patient() {
  const volume::GridGeometry geometry = cube(40, {2, 2, 2});
  anatomy::VirtualPatient patient;
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 r = geometry.centre_mm(ijk) - Vec3(39, 39, 39);
    patient.skin_distance_mm.voxels[n] = static_cast<float>(r.norm() - 35.0);
    patient.labels.voxels[n] = r.norm() < 15.0 ? 3 : r.norm() < 35.0 ? 1 : 0;
  }
  patient.labels[{19, 19, 19}] = 4;
  patient.label_table.labels = {
      {1, "fat", "adipose", {}}, {3, "liver", "liver", {}}, {4, "livertumor1", "liver_lesion", {}}};
  return patient;
}

TEST(ExtractSurfaces, ReturnsSkinAndStructuresWithoutTinyParts) {
  double last_fraction = 0.0;
  const auto meshes = extract_surfaces(small_patient(), {}, [&](std::string_view, double fraction) {
    EXPECT_GT(fraction, last_fraction);
    last_fraction = fraction;
  });
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "skin");
  EXPECT_EQ(meshes[1].name, "liver");
  EXPECT_EQ(last_fraction, 1.0);
  EXPECT_NEAR(enclosed_volume_mm3(meshes[0].mesh_P) / (4.0 / 3.0 * M_PI * std::pow(35.0, 3)), 1.0, 0.02);
  for (const Vec3f& vertex : meshes[1].mesh_P.vertices)
    EXPECT_LT((vertex.cast<double>() - Vec3(39, 39, 39)).norm(), 17.0);
}

TEST(ExtractSurfaces, OrganSurfaceEnclosesItsLesions) {
  // One within it, one at its border; of both the organ's own surface shows nothing.
  anatomy::VirtualPatient patient = small_patient();
  const double whole_mm3 = [&] {
    patient.labels[{19, 19, 19}] = 3;
    return enclosed_volume_mm3(extract_surfaces(patient)[1].mesh_P);
  }();
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const volume::Index3 ijk = patient.labels.geometry.index_of(n);
    const auto near = [&](std::int64_t i, double most) {
      return std::hypot(static_cast<double>(ijk[0] - i), static_cast<double>(ijk[1] - 19),
                        static_cast<double>(ijk[2] - 19)) < most;
    };
    if (patient.labels.voxels[n] == 3 && (near(17, 3.0) || near(25, 3.0))) patient.labels.voxels[n] = 4;
  }
  const auto meshes = extract_surfaces(patient);
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_NEAR(enclosed_volume_mm3(meshes[1].mesh_P), whole_mm3, 1e-3 * whole_mm3);
  for (const Vec3f& vertex : meshes[1].mesh_P.vertices)
    EXPECT_GT((vertex.cast<double>() - Vec3(39, 39, 39)).norm(), 13.0);
  EXPECT_GT(enclosed_volume_mm3(meshes[2].mesh_P), 1000.0);
}

TEST(ExtractSurfaces, OptionsSetTheSmallestPart) {
  SurfaceOptions options;
  options.min_voxels = 1;
  const auto meshes = extract_surfaces(small_patient(), options);
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[2].name, "livertumor1");
}

}  // namespace
}  // namespace trocar::surface
