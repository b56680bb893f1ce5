#include "xray/projection/moved_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "motion/testing/sliding_motion.h"
#include "xray/projection/xray_volume.h"
#include "xray/tools/tool_shape.h"

namespace trocar::xray {
namespace {

volume::GridGeometry centred_grid(std::int64_t side, double spacing_mm) {
  volume::GridGeometry geometry;
  geometry.size = {side, side, side};
  geometry.spacing_mm = Vec3::Constant(spacing_mm);
  geometry.origin_P = Vec3::Constant(-0.5 * spacing_mm * static_cast<double>(side - 1));
  return geometry;
}

volume::FloatGrid ball(const volume::GridGeometry& geometry, const Vec3& centre_A, double radius_mm) {
  volume::FloatGrid grid(geometry);
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const double away_mm = (geometry.centre_mm(geometry.index_of(n)) - centre_A).norm();
    grid.voxels[n] = static_cast<float>(std::clamp(0.5 + (radius_mm - away_mm) / geometry.spacing_mm.x(), 0.0, 1.0));
  }
  return grid;
}

struct Content {
  double sum = 0.0;
  Vec3 centre_P = Vec3::Zero();
};

Content content(const volume::FloatGrid& grid) {
  Content found;
  for (std::size_t n = 0; n < grid.voxels.size(); ++n) {
    const auto value = static_cast<double>(grid.voxels[n]);
    found.sum += value;
    found.centre_P += value * grid.geometry.centre_mm(grid.geometry.index_of(n));
  }
  found.centre_P /= found.sum;
  return found;
}

TEST(MovedVolume, KeepsMassAndFollowsTheTissue) {
  const auto model = motion::testing::sliding_model(-30.0, Vec3::Zero());
  const motion::MotionClock clock{model.get(), motion::testing::sliding_drive()};
  const Vec3 centre_A(8.0, 5.0, -6.0);
  const volume::FloatGrid rest = ball(centred_grid(80, 1.0), centre_A, 6.0);
  const double mass = content(rest).sum;
  for (int n = 0; n < 10; ++n) {
    const motion::PatientMotion motion = clock.at(0.4 * n);
    const Content found = content(moved_grid(rest, motion));
    EXPECT_NEAR(found.sum, mass, 2e-3 * mass) << n;
    // The middle of a ball that is bent is not where its middle was, by half of its size squared times the bend.
    EXPECT_LT((found.centre_P - motion.to_now(centre_A)).norm(), 0.15) << n;
  }
}

TEST(MovedVolume, ContainsTissueThatLeavesTheGridAtRest) {
  const auto model = motion::testing::uniform_model({25.0, -7.5, 0.0});
  const motion::PatientMotion motion(model.get(), {.drivers = {1.0}});
  const volume::FloatGrid rest = ball(centred_grid(40, 1.0), {12.0, 0.0, 0.0}, 5.0);
  const Content before = content(rest), now = content(moved_grid(rest, motion));
  EXPECT_NEAR(now.sum, before.sum, 1e-3 * before.sum);
  EXPECT_LT((now.centre_P - before.centre_P - Vec3(25.0, -7.5, 0.0)).norm(), 0.01);
}

TEST(MovedVolume, IsTheVolumeItselfAtRest) {
  volume::CtGrid ct(centred_grid(8, 1.0), 40);
  const auto volume = *XrayVolume::from_ct(ct);
  EXPECT_EQ(moved_volume(volume, {}), volume);
}

TEST(MovedVolume, ProjectsLikeABodyPlacedAtTheNewPosition) {
  // Half a voxel and more, so that each voxel is between others.
  const Vec3 shift(6.5, -3.0, 9.25);
  volume::CtGrid ct(centred_grid(48, 1.0), -1000), elsewhere = ct;
  for (std::size_t n = 0; n < ct.voxels.size(); ++n) {
    const Vec3 p = ct.geometry.centre_mm(ct.geometry.index_of(n));
    const auto hu_at = [](const Vec3& at) {
      return static_cast<std::int16_t>(at.norm() < 15.0 ? 30.0 + 10.0 * at.x() : -1000.0);
    };
    ct.voxels[n] = hu_at(p);
    elsewhere.voxels[n] = hu_at(p);
  }
  elsewhere.geometry.origin_P += shift;
  const auto model = motion::testing::uniform_model(shift);
  const auto moved = moved_volume(*XrayVolume::from_ct(ct), {model.get(), {.drivers = {1.0}}});
  const XrayRays rays = rays_of({.lao_deg = 15.0, .field_mm = 120.0, .pixels = 60});
  MassImage a, b;
  project(*moved, rays, a);
  project(**XrayVolume::from_ct(elsewhere), rays, b);
  const std::vector<float>&one = a.of(Basis::kWater), &other = b.of(Basis::kWater);
  double error = 0.0, sum = 0.0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    error += std::abs(static_cast<double>(one[n] - other[n]));
    sum += static_cast<double>(other[n]);
  }
  EXPECT_GT(sum, 100.0);
  EXPECT_LT(error, 0.02 * sum) << "interpolation softens the rim by half a voxel";
}

TEST(MovedPieces, KeepTheirIodine) {
  const auto model = motion::testing::sliding_model(-30.0, Vec3::Zero());
  const motion::PatientMotion motion(model.get(), {.drivers = {1.0, 0.8}});
  const IodinePiece piece{{10.0, -20.0, 5.0}, {10.0, -18.0, 5.5}, 2.0, 2.0, 100.0};
  const auto mass = [](const IodinePiece& p) {
    return (p.b_P - p.a_P).norm() * p.radius_a_mm * p.radius_a_mm * p.iodine_mg_per_ml;
  };
  const std::vector<IodinePiece> moved = moved_pieces({piece}, motion);
  EXPECT_NEAR(mass(moved[0]), mass(piece), 1e-3 * mass(piece));
  EXPECT_GT((moved[0].a_P - piece.a_P).norm(), 5.0);
}

}  // namespace
}  // namespace trocar::xray
