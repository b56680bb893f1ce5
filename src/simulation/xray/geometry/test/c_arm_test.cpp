#include "xray/geometry/c_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"

namespace trocar::xray {
namespace {

constexpr double kTiny = 1e-9;  // rounding of mm

TEST(CArm, LooksFromTheFrontAtRest) {
  const CArm arm;
  EXPECT_NEAR((towards_detector_P(arm) - Vec3(0, -1, 0)).norm(), 0.0, kTiny);
  const XrayRays rays = rays_of(arm);
  EXPECT_NEAR((rays.source_P - Vec3(0, 700, 0)).norm(), 0.0, kTiny);  // the back is +y
  // Upper left pixel: the patient's right (-x), the head (+z).
  EXPECT_LT(rays.first_pixel_P.x(), 0.0);
  EXPECT_GT(rays.first_pixel_P.z(), 0.0);
  EXPECT_NEAR(rays.first_pixel_P.y(), 700.0 - 1100.0, kTiny);
}

TEST(CArm, TurnsTowardsLeftAndHead) {
  EXPECT_NEAR((towards_detector_P({.lao_deg = 90.0}) - Vec3(1, 0, 0)).norm(), 0.0, kTiny);
  EXPECT_NEAR((towards_detector_P({.lao_deg = -90.0}) - Vec3(-1, 0, 0)).norm(), 0.0, kTiny);
  EXPECT_NEAR((towards_detector_P({.cranial_deg = 90.0}) - Vec3(0, 0, 1)).norm(), 0.0, kTiny);
  // At LAO 90 the patient's back is on the right of the image.
  const XrayRays rays = rays_of({.lao_deg = 90.0});
  EXPECT_NEAR((rays.column_P.normalized() - Vec3(0, 1, 0)).norm(), 0.0, kTiny);
}

TEST(CArm, DetectorIsSquareAndPerpendicularAtAllAngles) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const CArm arm{.lao_deg = random.uniform(-180.0, 180.0),
                   .cranial_deg = random.uniform(-90.0, 90.0),
                   .isocentre_P = {random.uniform(-100.0, 100.0), 20.0, -30.0},
                   .field_mm = 200.0,
                   .pixels = 100};
    const Vec3 towards = towards_detector_P(arm);
    const XrayRays rays = rays_of(arm);
    EXPECT_NEAR(rays.column_P.norm(), 2.0, kTiny);
    EXPECT_NEAR(rays.row_P.norm(), 2.0, kTiny);
    EXPECT_NEAR(rays.column_P.dot(rays.row_P), 0.0, kTiny);
    // Right, up and towards the viewer are right-handed.
    EXPECT_NEAR((rays.column_P.cross(-rays.row_P) / 4.0 - towards).norm(), 0.0, kTiny);
    const Vec3 middle = rays.pixel_P(49.5, 49.5);
    EXPECT_NEAR((middle - rays.source_P - arm.source_detector_mm * towards).norm(), 0.0, 1e-8);
    const auto at = rays.project(arm.isocentre_P);
    EXPECT_NEAR(at[0], 49.5, 1e-8);
    EXPECT_NEAR(at[1], 49.5, 1e-8);
  }
}

TEST(CArm, ProjectsPointsByPerspective) {
  const CArm arm{.source_isocentre_mm = 700.0, .source_detector_mm = 1050.0, .field_mm = 256.0, .pixels = 256};
  const XrayRays rays = rays_of(arm);
  // 10 mm to the patient's left in the plane of the isocentre: 15 mm on the detector; 20 mm up: 30 mm.
  const auto at = rays.project({10.0, 0.0, 20.0});
  EXPECT_NEAR(at[0], 127.5 + 15.0, 1e-9);
  EXPECT_NEAR(at[1], 127.5 - 30.0, 1e-9);
  EXPECT_NEAR(magnification(arm), 1.5, kTiny);
  // Nearer to the source: larger.
  EXPECT_NEAR(rays.project({10.0, 350.0, 0.0})[0], 127.5 + 30.0, 1e-9);
}

TEST(CArm, ProjectsEachPixelOntoItself) {
  const XrayRays rays = rays_of({.lao_deg = 33.0, .cranial_deg = -21.0, .pixels = 64});
  for (const double share : {0.2, 0.5, 1.0, 1.3}) {
    const Vec3 p = rays.source_P + share * (rays.pixel_P(7.25, 50.5) - rays.source_P);
    const auto at = rays.project(p);
    EXPECT_NEAR(at[0], 7.25, 1e-8);
    EXPECT_NEAR(at[1], 50.5, 1e-8);
  }
}

TEST(CArm, ProjectsNothingBesideOrBehindTheSource) {
  const XrayRays rays = rays_of({});
  EXPECT_FALSE(std::isfinite(rays.project(rays.source_P)[0]));
  EXPECT_FALSE(std::isfinite(rays.project(rays.source_P + Vec3(10, 0, 0))[0]));
  EXPECT_FALSE(std::isfinite(rays.project(rays.source_P + Vec3(0, 10, 0))[0]));
}

TEST(CArm, RefusesImpossibleGeometry) {
  EXPECT_TRUE(check_c_arm({}));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const CArm& arm :
       {CArm{.lao_deg = 181.0}, CArm{.cranial_deg = 91.0}, CArm{.isocentre_P = {kNaN, 0, 0}},
        CArm{.source_isocentre_mm = 100.0}, CArm{.source_isocentre_mm = 1100.0, .source_detector_mm = 1100.0},
        CArm{.source_isocentre_mm = 800.0, .source_detector_mm = 700.0}, CArm{.field_mm = 0.0}, CArm{.pixels = 4},
        CArm{.pixels = 100000}, CArm{.collimation = {0.0, 1.0}}, CArm{.lao_deg = kNaN}}) {
    const Status status = check_c_arm(arm);
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().exit_status, 2);
    EXPECT_FALSE(status.error().advice.empty());
  }
}

}  // namespace
}  // namespace trocar::xray
