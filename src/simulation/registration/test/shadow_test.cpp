#include <gtest/gtest.h>

#include <cmath>

#include "registration/intensity/gray_levels.h"
#include "registration/shadow/shadow_mask.h"

namespace trocar::registration {
namespace {

volume::GridGeometry cube(std::int64_t edge) {
  volume::GridGeometry geometry;
  geometry.size.fill(edge);
  return geometry;
}

HeaderFields fan_header() {
  return {{"trocar_apex_mm", "20 -30 20"}, {"trocar_radius_mm", "30"}, {"trocar_depth_mm", "39"},
          {"trocar_fov_rad", "0.7"},       {"trocar_beam_axis", "+y"}, {"trocar_sweep_rad", "0.6"},
          {"trocar_sweep_radius_mm", "22"}};
}

TEST(Beams, FanMappingIsInvertible) {
  const Beams beams = *Beams::from_header(fan_header(), cube(41));
  for (const Vec3& p : {Vec3(20, 10, 20), Vec3(12, 30, 26), Vec3(29, 22, 12)}) {
    EXPECT_LT((beams.to_point(beams.to_place(p)) - p).norm(), 1e-9);
    const Beams::Place place = beams.to_place(p);
    const Vec3 deeper = beams.to_point({place.lateral, place.elevation, place.depth_mm + 1.0});
    EXPECT_LT((deeper - p - beams.direction(p)).norm(), 1e-9);
  }
  EXPECT_NEAR(beams.to_place(Vec3(20, 0, 20)).depth_mm, 0.0, 1e-12);
}

TEST(Beams, RefusesInvalidDirectionsAndHeaders) {
  for (const char* axis : {"", "y", "+w", "++y", "-"}) {
    const auto beams = Beams::along_axis(axis, cube(4));
    ASSERT_FALSE(beams) << axis;
    EXPECT_EQ(beams.error().exit_status, 2);
  }
  for (const char* key : {"trocar_radius_mm", "trocar_depth_mm", "trocar_fov_rad"}) {
    HeaderFields missing = fan_header();
    missing.erase(key);
    EXPECT_FALSE(Beams::from_header(missing, cube(41))) << key;
    HeaderFields text = fan_header();
    text[key] = "wide";
    EXPECT_FALSE(Beams::from_header(text, cube(41))) << key;
    HeaderFields huge = fan_header();
    huge[key] = "-5";
    EXPECT_FALSE(Beams::from_header(huge, cube(41))) << key;
  }
}

/// Bright tissue with an obstacle; behind it the beams along +z are dark from k = 12 on, with one speckle at k = 20.
volume::LabelGrid shadowed_cube() {
  volume::LabelGrid gray(cube(32), 120);
  for (std::int64_t k = 12; k < 32; ++k)
    for (std::int64_t j = 10; j < 20; ++j)
      for (std::int64_t i = 10; i < 20; ++i) gray[{i, j, k}] = 5;
  gray[{15, 15, 20}] = 90;
  for (std::int64_t k = 5; k < 8; ++k) gray[{3, 3, k}] = 0;  // a vessel, with tissue behind it
  return gray;
}

TEST(ShadowMask, StartsAfterTheLastEchoOfABeam) {
  const volume::LabelGrid gray = shadowed_cube();
  const ImagedRegion region = *find_shadows(gray, *Beams::along_axis("+z", gray.geometry), 40.0);
  EXPECT_EQ(region.usable[(volume::Index3{12, 12, 31})], 0);
  EXPECT_EQ(region.usable[(volume::Index3{12, 12, 12})], 0);
  EXPECT_EQ(region.usable[(volume::Index3{12, 12, 11})], 1);
  EXPECT_EQ(region.usable[(volume::Index3{15, 15, 21})], 0);
  EXPECT_EQ(region.usable[(volume::Index3{15, 15, 16})], 1) << "before the last echo of its beam";
  EXPECT_EQ(region.usable[(volume::Index3{3, 3, 6})], 1) << "a dark vessel is no shadow";
  EXPECT_NEAR(region.shadow_share, (99.0 * 20.0 + 11.0) / (32.0 * 32.0 * 32.0), 1e-9);
}

TEST(ShadowMask, FollowsTheDirectionOfTheBeam) {
  const volume::LabelGrid gray = shadowed_cube();
  const ImagedRegion up = *find_shadows(gray, *Beams::along_axis("-z", gray.geometry), 40.0);
  EXPECT_EQ(up.usable[(volume::Index3{12, 12, 31})], 1) << "tissue lies behind it in this direction";
  EXPECT_EQ(up.shadow_share, 0.0);
}

TEST(ShadowMask, FollowsTheBeamsOfAFan) {
  const volume::GridGeometry geometry = cube(41);
  const Beams beams = *Beams::from_header(fan_header(), geometry);
  volume::LabelGrid gray(geometry, 100);
  const Beams::Place obstacle = beams.to_place({26, 15, 22});
  for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
    const Beams::Place at = beams.to_place(geometry.centre_mm(geometry.index_of(n)));
    const bool is_behind = std::abs(at.lateral - obstacle.lateral) < 0.12 &&
                           std::abs(at.elevation - obstacle.elevation) < 0.14 && at.depth_mm > obstacle.depth_mm;
    if (is_behind) gray.voxels[n] = 2;
  }
  const ImagedRegion region = *find_shadows(gray, beams, 30.0);
  std::size_t wrong = 0, dark = 0;
  for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
    if (region.inside.voxels[n] == 0) {
      EXPECT_EQ(region.usable.voxels[n], 0);
      continue;
    }
    const bool is_dark = gray.voxels[n] == 2;
    dark += is_dark ? 1U : 0U;
    wrong += is_dark == (region.usable.voxels[n] != 0) ? 1U : 0U;
  }
  ASSERT_GT(dark, 300U);
  EXPECT_LT(static_cast<double>(wrong), 0.15 * static_cast<double>(dark)) << "the border of the shadow only";
}

TEST(ShadowMask, WidensWithTheThreshold) {
  const volume::LabelGrid gray = shadowed_cube();
  const Beams beams = *Beams::along_axis("+z", gray.geometry);
  double before = -1.0;
  for (const double threshold : {0.0, 40.0, 100.0, 200.0}) {
    const double share = find_shadows(gray, beams, threshold)->shadow_share;
    EXPECT_GE(share, before);
    before = share;
  }
  EXPECT_EQ(find_shadows(gray, beams, 0.0)->shadow_share, 0.0);
  EXPECT_EQ(before, 1.0);
  for (const double threshold : {-1.0, 256.0, std::nan("")}) EXPECT_FALSE(find_shadows(gray, beams, threshold));
}

TEST(ShadowThreshold, SeparatesTwoClasses) {
  volume::LabelGrid gray(cube(20), 110);
  for (std::size_t n = 0; n < 2000; ++n) gray.voxels[n] = static_cast<std::uint8_t>(n % 9);
  for (std::size_t n = 2000; n < gray.voxels.size(); ++n) gray.voxels[n] = static_cast<std::uint8_t>(100 + n % 30);
  const volume::MaskGrid inside(gray.geometry, 1);
  const double threshold = *estimate_shadow_threshold(std::span(&gray, 1), std::span(&inside, 1));
  EXPECT_GT(threshold, 8.0);
  EXPECT_LE(threshold, 100.0);
  const volume::LabelGrid plain(cube(8), 50);
  const volume::MaskGrid all(plain.geometry, 1);
  EXPECT_FALSE(estimate_shadow_threshold(std::span(&plain, 1), std::span(&all, 1)));
}

TEST(BrightGray, IsTheUpperEndOfTheImagedLevels) {
  volume::LabelGrid gray(volume::GridGeometry{{100, 10, 2}, Vec3::Ones(), Vec3::Zero(), Mat3::Identity()});
  EXPECT_DOUBLE_EQ(bright_gray(gray), 255.0) << "empty";
  for (std::size_t n = 0; n < 1000; ++n) gray.voxels[n] = n < 998 ? 120 : 250;
  EXPECT_DOUBLE_EQ(bright_gray(gray), 120.0) << "zeros and single bright voxels do not count";
  gray.voxels.assign(gray.voxels.size(), 5);
  EXPECT_DOUBLE_EQ(bright_gray(gray), 32.0);
}

}  // namespace
}  // namespace trocar::registration
