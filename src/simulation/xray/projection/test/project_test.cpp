#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"
#include "volume/sampling.h"
#include "volume/testing/simd_targets.h"
#include "xray/physics/beam.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {
namespace {

volume::GridGeometry cube(std::int64_t size, double spacing_mm) {
  volume::GridGeometry g;
  g.size = {size, size, size};
  g.spacing_mm = Vec3::Constant(spacing_mm);
  g.origin_P = Vec3::Constant(-0.5 * spacing_mm * static_cast<double>(size - 1));
  return g;
}

/// A body of density 1: `distance` (mm) to its surface, negative inside. A voxel at the surface has its share.
template <class Distance>
volume::FloatGrid body_of(const volume::GridGeometry& g, const Distance& distance) {
  volume::FloatGrid grid(g);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const double share = 0.5 - distance(g.centre_mm(g.index_of(n))) / g.spacing_mm.x();
    grid.voxels[n] = static_cast<float>(std::clamp(share, 0.0, 1.0));
  }
  return grid;
}

/// A sphere of 30 mm off the middle, as a CT of water.
constexpr double kSphere_mm = 30.0;
Vec3 sphere_centre() {
  return {5.0, -4.0, 3.0};
}
volume::FloatGrid sphere(const volume::GridGeometry& g) {
  return body_of(g, [](const Vec3& p) { return (p - sphere_centre()).norm() - kSphere_mm; });
}

double chord_cm(const XrayRays& rays, int column, int row, const Vec3& centre, double radius_mm) {
  const Vec3 d = (rays.pixel_P(column, row) - rays.source_P).normalized();
  const Vec3 to = centre - rays.source_P;
  const double distance_squared = to.squaredNorm() - std::pow(to.dot(d), 2);
  return 0.2 * std::sqrt(std::max(0.0, radius_mm * radius_mm - distance_squared));
}

/// Integral along a ray by dense trilinear sampling: an independent, slow projector.
double slow_integral_cm(const volume::FloatGrid& grid, const XrayRays& rays, int column, int row) {
  const Vec3 along = rays.pixel_P(column, row) - rays.source_P;
  const double step_mm = 0.1;
  const auto count = static_cast<int>(along.norm() / step_mm);
  double sum = 0.0;
  for (int n = 0; n < count; ++n) {
    const Vec3 index = grid.geometry.to_index(rays.source_P + along * ((n + 0.5) / count));
    bool beyond = false;  // beyond the outermost voxels, the field falls to zero within one voxel
    double fade = 1.0;
    for (int a = 0; a < 3; ++a) {
      const auto last = static_cast<double>(grid.geometry.size[static_cast<std::size_t>(a)] - 1);
      const double out = std::max(-index[a], index[a] - last);
      if (out > 0.0) fade *= 1.0 - out;
      beyond = beyond || out >= 1.0;
    }
    if (!beyond) sum += fade * volume::sample_linear_at_index(grid, index);
  }
  return 0.1 * sum * along.norm() / count;
}

TEST(Project, MatchesSphereChordsFromAllSides) {
  const volume::FloatGrid grid = sphere(cube(96, 1.0));
  Random random(5);
  for (int n = 0; n < 12; ++n) {
    const CArm arm{.lao_deg = random.uniform(-180.0, 180.0),
                   .cranial_deg = random.uniform(-60.0, 60.0),
                   .field_mm = 150.0,
                   .pixels = 60};
    const XrayRays rays = rays_of(arm);
    std::vector<float> integrals;
    project(grid, rays, integrals);
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 60; ++column) {
        const double expected = chord_cm(rays, column, row, sphere_centre(), kSphere_mm);
        const double found = static_cast<double>(integrals[static_cast<std::size_t>(row * 60 + column)]);
        // 1 %, and more at the rim, where a voxel's share of the chord is large.
        if (expected > 4.0) {
          ASSERT_NEAR(found, expected, 0.01 * expected) << arm.lao_deg << " " << arm.cranial_deg;
        } else {
          ASSERT_NEAR(found, expected, 0.7) << arm.lao_deg << " " << arm.cranial_deg;
        }
      }
  }
}

TEST(Project, AgreesWithDenseSamplingOfRandomVoxels) {
  volume::GridGeometry g = cube(40, 1.5);
  g.size = {40, 33, 27};
  g.spacing_mm = {1.5, 1.2, 2.0};
  g.R_PV = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  volume::FloatGrid grid(g);
  Random random(11);
  for (float& v : grid.voxels) v = static_cast<float>(random.uniform(0.5, 1.5));
  for (const auto& [lao, cranial] : {std::pair{0.0, 0.0}, {90.0, 0.0}, {0.0, 80.0}, {40.0, 20.0}, {-44.0, -35.0}}) {
    const XrayRays rays = rays_of({.lao_deg = lao, .cranial_deg = cranial, .field_mm = 120.0, .pixels = 40});
    std::vector<float> integrals;
    project(grid, rays, integrals);
    double error = 0.0, sum = 0.0;
    for (int row = 0; row < 40; row += 3)
      for (int column = 0; column < 40; column += 3) {
        const double expected = slow_integral_cm(grid, rays, column, row);
        error += std::pow(static_cast<double>(integrals[static_cast<std::size_t>(row * 40 + column)]) - expected, 2);
        sum += expected * expected;
      }
    // White noise from voxel to voxel is the worst content; no body has it.
    EXPECT_LT(std::sqrt(error / sum), 0.02) << lao << " " << cranial;
  }
}

TEST(Project, ProjectsPointsAlongTheirRays) {
  // Balls of 2 mm on a known grid: the centroid of each shadow against the projected centre.
  volume::GridGeometry g = cube(12, 0.8);
  for (const auto& [lao, cranial] : {std::pair{0.0, 0.0}, {30.0, 20.0}, {-75.0, 10.0}, {90.0, -30.0}}) {
    const XrayRays rays = rays_of({.lao_deg = lao, .cranial_deg = cranial, .field_mm = 180.0, .pixels = 256});
    for (const Vec3& centre :
         {Vec3(0, 0, 0), Vec3(20.3, -11.7, 15.1), Vec3(-30.2, 25.4, -8.9), Vec3(7.7, 31.1, 29.6)}) {
      g.origin_P = centre.array().round() - 4.4;  // the ball is off the middle of its voxels
      const volume::FloatGrid ball = body_of(g, [&](const Vec3& p) { return (p - centre).norm() - 2.0; });
      std::vector<float> integrals;
      project(ball, rays, integrals);
      double mass = 0.0, column = 0.0, row = 0.0;
      for (std::size_t n = 0; n < integrals.size(); ++n) {
        const auto m = static_cast<double>(integrals[n]);
        mass += m;
        column += m * static_cast<double>(n % 256);
        row += m * static_cast<double>(n / 256);
      }
      const auto expected = rays.project(centre);
      ASSERT_GT(mass, 0.0);
      EXPECT_NEAR(column / mass, expected[0], 0.2);
      EXPECT_NEAR(row / mass, expected[1], 0.2);
    }
  }
}

TEST(Project, MirrorsOppositeViews) {
  // A body that is the same to the left and to the right: LAO 35 and RAO 35 are mirror images.
  const volume::FloatGrid grid = body_of(cube(64, 1.5), [](const Vec3& p) {
    const Vec3 at(std::abs(p.x()) - 24.0, p.y(), p.z() - 0.2 * p.y());
    return at.norm() - 18.0;
  });
  const auto view = [&](double lao) {
    std::vector<float> integrals;
    project(grid, rays_of({.lao_deg = lao, .field_mm = 200.0, .pixels = 64}), integrals);
    return integrals;
  };
  const std::vector<float> left = view(35.0), right = view(-35.0);
  double sum = 0.0;
  for (std::size_t n = 0; n < left.size(); ++n) {
    const float difference = left[n] - right[n - n % 64 + (63 - n % 64)];
    ASSERT_NEAR(difference, 0.0F, 0.05F);  // of 3.6: rays that touch the rim meet other voxels
    sum += static_cast<double>(difference * difference);
  }
  EXPECT_LT(std::sqrt(sum / static_cast<double>(left.size())), 0.004);
}

TEST(Project, IsZeroOutsideTheVolumeAndForAnEmptyOne) {
  const volume::FloatGrid grid = sphere(cube(96, 1.0));
  XrayRays rays = rays_of({.field_mm = 100.0, .pixels = 32});
  rays.source_P.x() += 400.0;
  rays.first_pixel_P.x() += 400.0;
  std::vector<float> integrals{1.0F};
  project(grid, rays, integrals);
  ASSERT_EQ(integrals.size(), 32U * 32U);
  for (const float v : integrals) ASSERT_EQ(v, 0.0F);
  project(volume::FloatGrid{}, rays, integrals);
  for (const float v : integrals) ASSERT_EQ(v, 0.0F);
  // Rays past the ball, inside the grid's box.
  project(grid, rays_of({.field_mm = 300.0, .pixels = 64}), integrals);
  EXPECT_EQ(integrals.front(), 0.0F);
  EXPECT_GT(integrals[32 * 64 + 32], 5.0F);
}

TEST(Project, SurvivesASourceInsideTheVolume) {
  volume::FloatGrid grid(cube(64, 10.0), 1.0F);  // 640 mm of water around a source
  for (const double lao : {0.0, 45.0, 90.0}) {
    const CArm arm{
        .lao_deg = lao, .source_isocentre_mm = 300.0, .source_detector_mm = 400.0, .field_mm = 500.0, .pixels = 32};
    const XrayRays rays = rays_of(arm);
    std::vector<float> integrals;
    project(grid, rays, integrals);
    for (const float v : integrals) ASSERT_TRUE(std::isfinite(v) && v >= 0.0F);
    if (lao != 45.0) {
      EXPECT_NEAR(integrals[16 * 32 + 16], 62.0F, 1.5F);  // 300 + 320 mm ahead, to one voxel
    }
  }
}

TEST(Project, HasNoSeamsForSteepRays) {
  const volume::FloatGrid grid = sphere(cube(96, 1.0));
  const CArm arm{.lao_deg = 45.0,
                 .cranial_deg = 35.0,
                 .source_isocentre_mm = 300.0,
                 .source_detector_mm = 400.0,
                 .field_mm = 500.0,
                 .pixels = 128};
  const XrayRays rays = rays_of(arm);
  std::vector<float> integrals;
  project(grid, rays, integrals);
  for (int row = 0; row < 128; ++row)
    for (int column = 0; column < 128; ++column) {
      const double expected = chord_cm(rays, column, row, sphere_centre(), kSphere_mm);
      const double found = static_cast<double>(integrals[static_cast<std::size_t>(row * 128 + column)]);
      ASSERT_NEAR(found, expected, expected > 4.0 ? 0.01 * expected : 0.7);
    }
}

TEST(Project, AgreesBetweenInstructionSets) {
  const volume::FloatGrid grid = sphere(cube(64, 1.4));
  volume::CtGrid ct(grid.geometry);
  for (std::size_t n = 0; n < ct.voxels.size(); ++n)
    ct.voxels[n] = static_cast<std::int16_t>(std::lround(1300.0F * grid.voxels[n] - 1000.0F));
  const auto volume = *XrayVolume::from_ct(ct);
  const XrayRays rays = rays_of({.lao_deg = 71.0, .cranial_deg = 9.0, .field_mm = 180.0, .pixels = 101});
  MassImage best, baseline;
  std::vector<float> best_integrals, baseline_integrals;
  project(*volume, rays, best);
  project(grid, rays, best_integrals);
  {
    const volume::testing::BaselineSimd only_baseline;
    project(*volume, rays, baseline);
    project(grid, rays, baseline_integrals);
  }
  EXPECT_GT(best.of(Basis::kBone)[50 * 101 + 50], 0.5F);
  for (std::size_t n = 0; n < best.size(); ++n) {  // of 6: rounding of positions and sums in floats
    ASSERT_NEAR(best.of(Basis::kWater)[n], baseline.of(Basis::kWater)[n], 1e-3F);
    ASSERT_NEAR(best.of(Basis::kBone)[n], baseline.of(Basis::kBone)[n], 1e-3F);
    ASSERT_NEAR(best_integrals[n], baseline_integrals[n], 1e-3F);
  }
}

TEST(Project, IsTheSameForAnyNumberOfThreads) {
  const volume::FloatGrid grid = sphere(cube(64, 1.4));
  const XrayRays rays = rays_of({.lao_deg = 12.0, .pixels = 100});
  std::vector<float> many, one;
  project(grid, rays, many);
  run_on_threads(1, [&] { project(grid, rays, one); });
  EXPECT_EQ(many, one);
}

}  // namespace
}  // namespace trocar::xray
