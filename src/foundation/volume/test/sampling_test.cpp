#include "volume/sampling.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <limits>
#include <vector>

#include "make_grids.h"
#include "volume/detail/column_range.h"

namespace trocar::volume {
namespace {

constexpr float kOutside = -3000.0F;

/// Voxels of noise differ by up to 4095 between neighbours; positions are good to 1e-5 of a voxel on each of three
/// axes.
constexpr double kToleranceHu = 3 * 4095 * 1e-5;

/// The value that sample_slice promises, in double precision.
double reference(const CtGrid& ct, const Vec3& p_P) {
  if (!detail::is_inside(ct.geometry, ct.geometry.to_index(p_P))) return kOutside;
  return sample_linear(ct, p_P);
}

bool is_near_a_face(const GridGeometry& geometry, const Vec3& index) {
  for (int a = 0; a < 3; ++a) {
    const double high = static_cast<double>(geometry.size[static_cast<std::size_t>(a)]) - 0.5;
    if (std::abs(index[a] + 0.5) < 2e-4 || std::abs(index[a] - high) < 2e-4) return true;
  }
  return false;
}

Vec3 point_of(const SlicePlane& plane, int u, int v) {
  return plane.origin_P + u * plane.step_u_P + v * plane.step_v_P;
}

void expect_slice_equals_reference(const CtGrid& ct, const SlicePlane& plane) {
  std::vector<float> out(static_cast<std::size_t>(plane.columns * plane.rows), 77.0F);
  sample_slice(ct, plane, kOutside, out);
  std::size_t n = 0;
  for (int v = 0; v < plane.rows; ++v)
    for (int u = 0; u < plane.columns; ++u, ++n)
      ASSERT_NEAR(out[n], reference(ct, point_of(plane, u, v)), kToleranceHu) << "column " << u << " row " << v;
}

void expect_points_equal_reference(const CtGrid& ct, std::size_t count, Random& random) {
  std::vector<Vec3f> points_P;
  while (points_P.size() < count) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = random.uniform(-3.0, static_cast<double>(ct.geometry.size[static_cast<std::size_t>(a)]) + 3.0);
    const Vec3f p_P = ct.geometry.to_mm(index).cast<float>();
    if (!is_near_a_face(ct.geometry, ct.geometry.to_index(p_P.cast<double>()))) points_P.push_back(p_P);
  }
  std::vector<float> out(count);
  sample_points(ct, points_P, kOutside, out);
  for (std::size_t n = 0; n < count; ++n) ASSERT_NEAR(out[n], reference(ct, points_P[n].cast<double>()), kToleranceHu);
}

/// A plane through a random voxel, with columns and rows that need not be square to each other.
SlicePlane random_plane(const GridGeometry& geometry, Random& random) {
  SlicePlane plane;
  plane.columns = 1 + static_cast<int>(random.next() % 300);
  plane.rows = 1 + static_cast<int>(random.next() % 40);
  plane.step_u_P = random_direction(random) * random.uniform(0.05, 2.0);
  plane.step_v_P = random_direction(random) * random.uniform(0.05, 2.0);
  const Vec3 index(random.uniform() * static_cast<double>(geometry.size[0]),
                   random.uniform() * static_cast<double>(geometry.size[1]),
                   random.uniform() * static_cast<double>(geometry.size[2]));
  plane.origin_P = geometry.to_mm(index) - 0.5 * plane.columns * plane.step_u_P - 0.5 * plane.rows * plane.step_v_P;
  return plane;
}

TEST(SampleLinear, ReproducesAnAffineFieldExactly) {
  Random random(4);
  Grid<float> grid(oblique_geometry({7, 8, 9}, random));
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const auto [i, j, k] = grid.geometry.index_of(n);
    grid.voxels[n] = static_cast<float>(2 * i - 3 * j + 5 * k + 1);
  }
  for (int n = 0; n < 1000; ++n) {
    const Vec3 index(random.uniform(0, 6), random.uniform(0, 7), random.uniform(0, 8));
    EXPECT_NEAR(sample_linear(grid, grid.geometry.to_mm(index)), 2 * index.x() - 3 * index.y() + 5 * index.z() + 1,
                1e-9);
  }
}

TEST(SampleLinear, ContinuesEdgeValues) {
  CtGrid ct(plain_geometry({2, 2, 2}));
  for (std::size_t n = 0; n < 8; ++n) ct.voxels[n] = static_cast<std::int16_t>(n);
  EXPECT_EQ(sample_linear(ct, {-10, -10, -10}), 0.0);
  EXPECT_EQ(sample_linear(ct, {10, 10, 10}), 7.0);
  EXPECT_EQ(sample_linear(ct, {0.5, -10, -10}), 0.5);
}

TEST(SampleNearest, SelectsTheClosestVoxelInsideTheBox) {
  CtGrid ct(plain_geometry({3, 1, 1}));
  ct.voxels = {10, 20, 30};
  const std::int16_t outside = -1;
  EXPECT_EQ(sample_nearest(ct, {-0.49, 0, 0}, outside), 10);
  EXPECT_EQ(sample_nearest(ct, {0.49, 0.49, -0.49}, outside), 10);
  EXPECT_EQ(sample_nearest(ct, {0.51, 0, 0}, outside), 20);
  EXPECT_EQ(sample_nearest(ct, {2.49, 0, 0}, outside), 30);
  EXPECT_EQ(sample_nearest(ct, {2.51, 0, 0}, outside), outside);
  EXPECT_EQ(sample_nearest(ct, {0, 0.51, 0}, outside), outside);
  EXPECT_EQ(sample_nearest(ct, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, outside), outside);
}

TEST(Gradient, OfAnAffineFieldIsItsSlope) {
  Random random(5);
  Grid<float> grid(oblique_geometry({9, 9, 9}, random));
  const Vec3 slope_P(3.0, -2.0, 0.5);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const auto [i, j, k] = grid.geometry.index_of(n);
    const Vec3 index(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
    grid.voxels[n] = static_cast<float>(slope_P.dot(grid.geometry.to_mm(index) - grid.geometry.origin_P));
  }
  for (int n = 0; n < 100; ++n) {
    const Vec3 p_P = grid.geometry.to_mm(random_vec(random, 1.0, 7.0));
    EXPECT_LT((gradient_per_mm(grid, p_P) - slope_P).norm(), 1e-4);  // voxels are floats
  }
}

TEST(SampleSlice, AgreesWithTheScalarReferenceOnRandomPlanes) {
  Random random(6);
  for (int n = 0; n < 60; ++n) {
    const CtGrid ct = noise_ct(oblique_geometry({33, 27, 21}, random), random);
    expect_slice_equals_reference(ct, random_plane(ct.geometry, random));
  }
}

TEST(SampleSlice, AgreesWithTheReferenceOnEveryInstructionSet) {
  const std::int64_t compiled_and_here = hwy::SupportedTargets() & HWY_TARGETS;
  ASSERT_NE(compiled_and_here, 0);
  for (std::int64_t left = compiled_and_here; left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // chosen anew at the next call
    Random random(66);
    for (int n = 0; n < 10; ++n) {
      const CtGrid ct = noise_ct(oblique_geometry({33, 27, 21}, random), random);
      expect_slice_equals_reference(ct, random_plane(ct.geometry, random));
      expect_points_equal_reference(ct, 300, random);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();  // chosen anew at the next call
}

TEST(SampleSlice, HitsVoxelCentresExactly) {
  Random random(7);
  const CtGrid ct = noise_ct(plain_geometry({40, 30, 20}, {0.5, 2.0, 4.0}), random);
  const auto along = [&](int axis) { return Vec3(Vec3::Unit(axis) * ct.geometry.spacing_mm[axis]); };
  for (int axis = 0; axis < 3; ++axis) {
    const int u_axis = (axis + 1) % 3;
    const int v_axis = (axis + 2) % 3;
    SlicePlane plane;
    plane.step_u_P = along(u_axis);
    plane.step_v_P = along(v_axis);
    plane.columns = static_cast<int>(ct.geometry.size[static_cast<std::size_t>(u_axis)]);
    plane.rows = static_cast<int>(ct.geometry.size[static_cast<std::size_t>(v_axis)]);
    for (std::int64_t s = 0; s < ct.geometry.size[static_cast<std::size_t>(axis)]; ++s) {
      plane.origin_P = along(axis) * static_cast<double>(s);
      std::vector<float> out(static_cast<std::size_t>(plane.columns * plane.rows));
      sample_slice(ct, plane, kOutside, out);
      Index3 voxel{};
      voxel[static_cast<std::size_t>(axis)] = s;
      std::size_t n = 0;
      for (voxel[static_cast<std::size_t>(v_axis)] = 0; voxel[static_cast<std::size_t>(v_axis)] < plane.rows;
           ++voxel[static_cast<std::size_t>(v_axis)])
        for (voxel[static_cast<std::size_t>(u_axis)] = 0; voxel[static_cast<std::size_t>(u_axis)] < plane.columns;
             ++voxel[static_cast<std::size_t>(u_axis)])
          ASSERT_EQ(out[n++], static_cast<float>(ct[voxel]));
    }
  }
}

TEST(SampleSlice, ExtendsEdgeValuesByHalfAVoxelOnly) {
  CtGrid ct(plain_geometry({3, 2, 2}), 500);
  SlicePlane plane;
  plane.origin_P = {-1.0, 0.5, 0.5};
  plane.step_u_P = {0.25, 0, 0};
  plane.columns = 18;  // x = -1 .. 3.25
  plane.rows = 1;
  std::vector<float> out(18);
  sample_slice(ct, plane, kOutside, out);
  for (int u = 0; u < plane.columns; ++u) {
    const double x = -1.0 + 0.25 * u;
    EXPECT_EQ(out[static_cast<std::size_t>(u)], x > -0.5 && x < 2.5 ? 500.0F : kOutside) << x;
  }
}

TEST(SampleSlice, ServesGridsOneVoxelThick) {
  Random random(8);
  const Index3 sizes[] = {{1, 9, 9}, {9, 1, 9}, {9, 9, 1}, {1, 1, 9}, {9, 1, 1}, {1, 1, 1}, {2, 2, 2}};
  for (const Index3& size : sizes)
    for (int n = 0; n < 10; ++n) {
      const CtGrid ct = noise_ct(oblique_geometry(size, random), random);
      expect_slice_equals_reference(ct, random_plane(ct.geometry, random));
    }
}

TEST(SampleSlice, IsOutsideForANonFinitePlane) {
  const CtGrid ct(plain_geometry({4, 4, 4}), 5);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    SlicePlane plane;
    plane.columns = 20;
    plane.rows = 3;
    std::vector<float> out(60);
    plane.origin_P.x() = bad;
    sample_slice(ct, plane, kOutside, out);
    for (const float v : out) EXPECT_EQ(v, kOutside);
    plane.origin_P.x() = 0.0;
    plane.step_v_P.z() = bad;
    plane.origin_P.z() = -1.0;  // the first row misses the grid too
    sample_slice(ct, plane, kOutside, out);
    for (const float v : out) EXPECT_EQ(v, kOutside);
  }
}

TEST(SampleSlice, IsOutsideForAnEmptyGrid) {
  SlicePlane plane;
  plane.columns = plane.rows = 8;
  std::vector<float> out(64, 0.0F);
  sample_slice(CtGrid{}, plane, kOutside, out);
  for (const float v : out) EXPECT_EQ(v, kOutside);
}

TEST(SampleSliceNearest, AgreesWithTheNearestVoxelOnRandomPlanes) {
  Random random(11);
  for (int round = 0; round < 40; ++round) {
    const CtGrid ct = noise_ct(oblique_geometry({33, 27, 21}, random), random);
    Grid<std::uint8_t> labels(ct.geometry);
    for (std::size_t n = 0; n < labels.voxels.size(); ++n)
      labels.voxels[n] = static_cast<std::uint8_t>(static_cast<unsigned>(ct.voxels[n]) % 251U);
    const SlicePlane plane = random_plane(ct.geometry, random);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(plane.columns * plane.rows), 254);
    sample_slice_nearest(labels, plane, 255, out);
    for (int v = 0; v < plane.rows; ++v)
      for (int u = 0; u < plane.columns; ++u) {
        const Vec3 index = labels.geometry.to_index(point_of(plane, u, v));
        const Vec3 to_border = (index.array() - index.array().floor() - 0.5).abs();
        if (to_border.minCoeff() < 1e-5) continue;  // to either side
        EXPECT_EQ(out[static_cast<std::size_t>(v * plane.columns + u)],
                  sample_nearest<std::uint8_t>(labels, point_of(plane, u, v), 255));
      }
  }
}

TEST(SamplePoints, AgreesWithTheScalarReference) {
  Random random(9);
  for (const std::size_t count : {0, 1, 127, 128, 129, 5000})
    expect_points_equal_reference(noise_ct(oblique_geometry({30, 40, 50}, random), random), count, random);
}

TEST(SamplePoints, IsOutsideForNonFinitePoints) {
  const CtGrid ct(plain_geometry({4, 4, 4}), 5);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<Vec3f> points_P{{nan, 1, 1},       {1, nan, 1},   {1, 1, nan}, {infinity, 1, 1},
                                    {1, -infinity, 1}, {1e30F, 1, 1}, {1, 1, 1}};
  std::vector<float> out(points_P.size());
  sample_points(ct, points_P, kOutside, out);
  for (std::size_t n = 0; n + 1 < out.size(); ++n) EXPECT_EQ(out[n], kOutside) << n;
  EXPECT_EQ(out.back(), 5.0F);
}

TEST(ColumnsInside, AgreesWithTestingEveryColumn) {
  Random random(10);
  for (int n = 0; n < 2000; ++n) {
    GridGeometry geometry = plain_geometry({5, 6, 7});
    Vec3 step = random_vec(random, -1.0, 1.0);
    Vec3 start = random_vec(random, -6.0, 12.0);
    // Half the rows run along an axis through eighths of a voxel, where they meet the faces of the box exactly.
    if (n % 2 == 0) {
      start = (start * 8.0).array().round() / 8.0;
      step = Vec3::Unit(n / 2 % 3) * (n % 4 == 0 ? 0.125 : -0.25);
    }
    const auto range = detail::columns_inside(geometry, start, step, 90);
    for (int u = 0; u < 90; ++u)
      ASSERT_EQ(u >= range.first && u < range.last, detail::is_inside(geometry, start + u * step)) << u;
  }
}

}  // namespace
}  // namespace trocar::volume
