#include "volume/resample.h"

#include <gtest/gtest.h>

#include <cmath>

#include "make_grids.h"
#include "volume/sampling.h"

namespace trocar::volume {
namespace {

Vec3 centre_mm(const GridGeometry& geometry, std::size_t offset) {
  const auto [i, j, k] = geometry.index_of(offset);
  return geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
}

/// Another grid over the same part of space, turned a little.
GridGeometry turned(const GridGeometry& source, const Index3& size, Random& random) {
  GridGeometry target = source;
  target.size = size;
  target.spacing_mm = random_vec(random, 0.5, 2.0);
  target.R_PV = Eigen::AngleAxisd(0.3, random_direction(random)).toRotationMatrix() * source.R_PV;
  target.origin_P += source.R_PV * random_vec(random, -4.0, 4.0);
  return target;
}

TEST(ResampleLinear, IsIdentityOnItsOwnGrid) {
  Random random(30);
  const CtGrid ct = noise_ct(oblique_geometry({17, 19, 13}, random), random);
  EXPECT_EQ(resample_linear(ct, ct.geometry, -1024).voxels, ct.voxels);
}

TEST(ResampleLinear, RoundsTheTrilinearValue) {
  Random random(31);
  const CtGrid ct = noise_ct(oblique_geometry({17, 19, 13}, random), random);
  const GridGeometry target = turned(ct.geometry, {23, 11, 14}, random);
  const CtGrid result = resample_linear(ct, target, -2000);
  EXPECT_TRUE(result.geometry.matches(target));
  std::size_t inside = 0;
  for (std::size_t n = 0; n < result.voxels.size(); ++n) {
    const Vec3 p_P = centre_mm(target, n);
    const bool is_inside = sample_nearest<std::int16_t>(ct, p_P, -2000) != -2000;
    inside += is_inside ? 1 : 0;
    // Half a unit of rounding, and a tenth for the floats inside.
    ASSERT_NEAR(result.voxels[n], is_inside ? sample_linear(ct, p_P) : -2000.0, 0.6);
  }
  EXPECT_GT(inside, result.voxels.size() / 10);  // the grids do overlap
}

TEST(ResampleNearest, SelectsTheNearestLabel) {
  Random random(32);
  LabelGrid labels(oblique_geometry({17, 19, 13}, random));
  for (auto& voxel : labels.voxels) voxel = static_cast<std::uint8_t>(1 + random.next() % 100);
  const GridGeometry target = turned(labels.geometry, {23, 11, 14}, random);
  const LabelGrid result = resample_nearest(labels, target, 0);
  for (std::size_t n = 0; n < result.voxels.size(); ++n) {
    const Vec3 at = labels.geometry.to_index(centre_mm(target, n)) + Vec3::Constant(1e-4);  // half-way places go up
    ASSERT_EQ(result.voxels[n], sample_nearest<std::uint8_t>(labels, labels.geometry.to_mm(at), 0));
  }
  EXPECT_EQ(resample_nearest(labels, labels.geometry, 0).voxels, labels.voxels);
}

TEST(ResampleNearest, TiesDoNotDependOnRounding) {
  GridGeometry geometry;
  geometry.size = {1, 1, 40};
  geometry.spacing_mm = {1.0, 1.0, 2.0 / 3.0};
  LabelGrid labels(geometry);
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) labels.voxels[n] = static_cast<std::uint8_t>(n);
  GridGeometry target = geometry;
  target.size[2] = 26;
  target.spacing_mm.z() = 1.0;  // every second voxel lies half-way between two
  const LabelGrid expected = resample_nearest(labels, target, 0);
  EXPECT_EQ(expected.voxels[1], 2);
  for (const double rounding : {-1e-6, 1e-6}) {
    target.spacing_mm.z() = 1.0 + rounding;
    EXPECT_EQ(resample_nearest(labels, target, 0).voxels, expected.voxels) << rounding;
  }
}

TEST(IsotropicGeometry, CoversTheSameBox) {
  Random random(33);
  for (int n = 0; n < 20; ++n) {
    const GridGeometry source = oblique_geometry({50, 60, 31}, random);
    const GridGeometry target = isotropic_geometry(source, 0.8);
    const auto corners = [](const GridGeometry& g) {
      const Vec3 last = to_vec3(g.size);
      return std::pair{g.to_mm(Vec3::Constant(-0.5)), g.to_mm(last - Vec3::Constant(0.5))};
    };
    EXPECT_LT((corners(source).first - corners(target).first).norm(), 1e-9);
    EXPECT_LT((corners(source).second - corners(target).second).norm(), 1e-9);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(target.spacing_mm[a], 0.8, 0.8 * 0.5 / 15.0);  // at least 15 voxels
  }
}

TEST(IsotropicGeometry, HasAtLeastOneVoxel) {
  EXPECT_EQ(isotropic_geometry(plain_geometry({10, 10, 1}, {1, 1, 0.1}), 1.0).size, (Index3{10, 10, 1}));
}

TEST(OverlapFraction, CountsVoxelCentresInsideTheBox) {
  const GridGeometry source = plain_geometry({10, 10, 10});
  EXPECT_EQ(overlap_fraction(source, source), 1.0);
  GridGeometry moved = source;
  moved.origin_P.x() += 4.0;
  EXPECT_DOUBLE_EQ(overlap_fraction(source, moved), 0.6);
  moved.origin_P.x() = 100.0;
  EXPECT_EQ(overlap_fraction(source, moved), 0.0);
  EXPECT_EQ(overlap_fraction(source, GridGeometry{}), 0.0);
}

TEST(OverlapFraction, AgreesWithSamplingOnTurnedGrids) {
  Random random(34);
  for (int n = 0; n < 10; ++n) {
    const LabelGrid full(oblique_geometry({12, 14, 16}, random), 1);
    const GridGeometry target = turned(full.geometry, {13, 12, 11}, random);
    std::size_t inside = 0;
    for (std::size_t v = 0; v < target.voxel_count(); ++v)
      inside += sample_nearest<std::uint8_t>(full, centre_mm(target, v), 0);
    EXPECT_DOUBLE_EQ(overlap_fraction(full.geometry, target),
                     static_cast<double>(inside) / static_cast<double>(target.voxel_count()));
  }
}

}  // namespace
}  // namespace trocar::volume
