#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ultrasound/scanner/measurements.h"

namespace trocar::ultrasound {
namespace {

RasterGeometry raster_of(double mm_per_pixel, bool is_mirrored) {
  RasterGeometry raster;
  raster.mm_per_pixel = mm_per_pixel;
  raster.first_T = {is_mirrored ? 80.0 : -80.0, -5.0};
  raster.is_mirrored = is_mirrored;
  return raster;
}

TEST(Caliper, DistanceIsPixelsTimesTheirSize) {
  for (const bool is_mirrored : {false, true}) {
    const RasterGeometry raster = raster_of(0.25, is_mirrored);
    const DistanceCaliper caliper = place_distance(raster, {100.0, 40.0}, {130.0, 80.0});
    EXPECT_NEAR(caliper.distance_mm(), 50.0 * 0.25, 1e-12);
  }
}

TEST(Caliper, MarksKeepTheirBodyPosition) {
  const RasterGeometry raster = raster_of(0.25, true);
  const DistanceCaliper caliper = place_distance(raster, {100.5, 40.25}, {12.0, 300.0});
  EXPECT_NEAR((raster.to_pixel(caliper.a_T) - Vec2(100.5, 40.25)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((raster.to_pixel(caliper.b_T) - Vec2(12.0, 300.0)).norm(), 0.0, 1e-9);

  const RasterGeometry deeper = raster_of(0.5, false);
  const DistanceCaliper again = place_distance(deeper, deeper.to_pixel(caliper.a_T), deeper.to_pixel(caliper.b_T));
  EXPECT_NEAR(again.distance_mm(), caliper.distance_mm(), 1e-9);
}

TEST(Caliper, EllipseHasTheAxesThatWereSet) {
  const RasterGeometry raster = raster_of(0.5, false);
  // Axis of 80 pixels along a 3-4-5 direction; a point 30 pixels beside it, wherever along it.
  const Vec2 a(100.0, 100.0), b(148.0, 164.0);
  const Vec2 side = a + 0.3 * (b - a) + 30.0 * Vec2(-0.8, 0.6);
  const EllipseCaliper caliper = place_ellipse(raster, a, b, side);
  EXPECT_NEAR(caliper.length_mm(), 40.0, 1e-12);
  EXPECT_NEAR(caliper.width_mm(), 30.0, 1e-12);
  EXPECT_NEAR(caliper.area_mm2(), std::numbers::pi * 20.0 * 15.0, 1e-9);
}

TEST(Caliper, CircleHasItsCircumference) {
  const EllipseCaliper circle{{-10.0, 0.0}, {10.0, 0.0}, 10.0};
  EXPECT_NEAR(circle.circumference_mm(), 20.0 * std::numbers::pi, 1e-12);
}

TEST(Caliper, FlatEllipseIsTwiceItsAxis) {
  EXPECT_NEAR((EllipseCaliper{{0.0, 0.0}, {0.0, 30.0}, 0.0}).circumference_mm(), 60.0, 1e-12);
  EXPECT_NEAR((EllipseCaliper{{0.0, 0.0}, {0.0, 30.0}, 1e-6}).circumference_mm(), 60.0, 1e-3);
  EXPECT_EQ(EllipseCaliper{}.circumference_mm(), 0.0);
}

TEST(Caliper, CircumferenceIsTheLengthOfTheOutline) {
  for (const double half_width_mm : {3.0, 12.0, 45.0}) {
    const EllipseCaliper ellipse{{5.0, 20.0}, {35.0, 60.0}, half_width_mm};
    constexpr int kPoints = 20000;
    const std::vector<Vec2> outline = ellipse.outline_T(kPoints);
    double length_mm = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      length_mm += (outline[(i + 1) % outline.size()] - outline[i]).norm();
    }
    EXPECT_NEAR(ellipse.circumference_mm(), length_mm, 1e-6 * length_mm);
  }
}

TEST(Caliper, AngleIsBetweenTheArms) {
  for (const bool is_mirrored : {false, true}) {
    const RasterGeometry raster = raster_of(0.3, is_mirrored);
    const Vec2 corner(200.0, 200.0);
    const auto angle_rad = [&](const Vec2& a, const Vec2& b) {
      return place_angle(raster, corner, corner + a, corner + b).angle_rad();
    };
    EXPECT_NEAR(angle_rad({50.0, 0.0}, {0.0, -20.0}), 0.5 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(angle_rad({50.0, 0.0}, {30.0, 30.0}), 0.25 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(angle_rad({50.0, 0.0}, {-1.0, 0.0}), std::numbers::pi, 1e-12);
    EXPECT_EQ(angle_rad({50.0, 0.0}, {0.0, 0.0}), 0.0);
  }
}

}  // namespace
}  // namespace trocar::ultrasound
