// Contours of one plane: repeated ones, parts that overlap, holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dicom/segmentation/detail/contour_raster.h"

namespace trocar::dicom::detail {
namespace {

using std::numbers::pi;

/// A round outline of a structure in the plane z = 0.
Contour disc(double x, double y, double radius_mm, int points = 120, double z = 0.0) {
  Contour contour;
  for (int n = 0; n < points; ++n)
    contour.emplace_back(x + radius_mm * std::cos(2.0 * pi * n / points),
                         y + radius_mm * std::sin(2.0 * pi * n / points), z);
  return contour;
}

Contour block_of(double left, double right, double front, double back) {
  return {{left, front, 0}, {right, front, 0}, {right, back, 0}, {left, back, 0}};
}

Contour moved(Contour contour, double x, double y = 0.0, double z = 0.0) {
  for (Vec3& point : contour) point += Vec3(x, y, z);
  return contour;
}

struct Filled {
  double area_mm2 = 0.0;
  RasterResult raster;
};

/// One slice of 200 x 200 mm, 1 mm thick.
Filled fill(const std::vector<Contour>& contours, double pixel_mm = 0.5, bool is_exclusive_or = false) {
  volume::GridGeometry ct;
  ct.size = {static_cast<std::int64_t>(200.0 / pixel_mm), static_cast<std::int64_t>(200.0 / pixel_mm), 1};
  ct.spacing_mm = {pixel_mm, pixel_mm, 1.0};
  ct.origin_P = {-99.8, -99.9, 0.0};
  ContourStructure structure{{1, "Liver"}, contours, 0};
  structure.is_exclusive_or = is_exclusive_or;
  Filled filled;
  filled.raster = rasterise(structure, ContourGrid{ct, 2});
  const auto inside = std::count(filled.raster.mask.begin(), filled.raster.mask.end(), 1);
  filled.area_mm2 = static_cast<double>(inside) * pixel_mm * pixel_mm;
  return filled;
}

TEST(ContourOverlaps, DuplicateOutlineCountsOnce) {
  const Contour once = disc(3, 4, 50);
  Contour turned = once, reversed(once.rbegin(), once.rend()), closed = once, thinned, denser = disc(3, 4, 50, 240);
  std::rotate(turned.begin(), turned.begin() + 37, turned.end());
  closed.push_back(once.front());
  for (std::size_t n = 0; n < once.size(); n += 5) thinned.push_back(once[n]);
  for (const double pixel_mm : {0.5, 1.0, 5.0}) {
    const double expected = fill({once}, pixel_mm).area_mm2;
    for (const Contour& again : {once, turned, reversed, closed, thinned, denser, moved(once, 0.1),
                                 moved(once, 0.3, 0.3), moved(once, 0, 0, 0.02), disc(3, 4, 49.8), disc(3, 4, 50.2)}) {
      const Filled filled = fill({once, again}, pixel_mm);
      EXPECT_NEAR(filled.area_mm2 / expected, 1.0, 0.015) << pixel_mm;
      EXPECT_EQ(filled.raster.repeated, 1U) << pixel_mm;
      EXPECT_EQ(filled.raster.crossing + filled.raster.doubtful, 0U) << pixel_mm;
    }
    const Filled often = fill({once, turned, reversed, thinned, moved(once, 0.1)}, pixel_mm);
    EXPECT_NEAR(often.area_mm2 / expected, 1.0, 0.015) << pixel_mm;
    EXPECT_EQ(often.raster.repeated, 4U);
  }
  // Whatever its size.
  for (const double radius_mm : {1.0, 4.0, 90.0})
    EXPECT_EQ(fill({disc(0, 0, radius_mm), moved(disc(0, 0, radius_mm), 0.05)}).raster.repeated, 1U) << radius_mm;
}

TEST(ContourOverlaps, UnitesDifferingSecondDrawings) {
  for (const double shift_mm : {1.0, 3.0, 20.0}) {
    const Filled filled = fill({disc(0, 0, 50), moved(disc(0, 0, 50), shift_mm)});
    const double half = std::acos(shift_mm / 100.0);
    const double common = 2.0 * 2500.0 * (half - std::sin(half) * std::cos(half));
    EXPECT_NEAR(filled.area_mm2 / (2.0 * pi * 2500.0 - common), 1.0, 0.01) << shift_mm;
    EXPECT_EQ(filled.raster.crossing, 1U) << shift_mm;
    EXPECT_NEAR(filled.raster.crossing_ml / (common / 1000.0), 1.0, 0.01) << shift_mm;
  }
}

TEST(ContourOverlaps, PartsThatOverlapAreUnited) {
  for (const double overlap_mm : {0.6, 8.0, 30.0}) {
    const Filled two = fill({block_of(-50, 0.5 * overlap_mm, -20, 20), block_of(-0.5 * overlap_mm, 50, -20, 20)});
    EXPECT_NEAR(two.area_mm2, 4000.0, 50.0) << overlap_mm;
    EXPECT_NEAR(two.raster.crossing_ml, 0.04 * overlap_mm, 1e-3) << overlap_mm;
  }
  // A chain of three, and one in another direction; separate ones beside them.
  const Filled chain = fill({block_of(-60, -20, -10, 10), block_of(-30, 10, -10, 10), block_of(0, 40, -10, 10),
                             block_of(20, 30, -40, 40), block_of(-90, -70, -10, 10)});
  EXPECT_NEAR(chain.area_mm2, 2000.0 + 600.0 + 400.0, 50.0);
  EXPECT_EQ(chain.raster.crossing, 3U);
  // Parts that only touch have nothing in common.
  const Filled touching = fill({block_of(-50, 0, -20, 20), block_of(0, 50, -20, 20)});
  EXPECT_NEAR(touching.area_mm2, 4000.0, 50.0);
  EXPECT_EQ(touching.raster.crossing, 0U);
}

TEST(ContourOverlaps, NestedContoursAreHolesAndIslands) {
  const double ring = pi * (2500.0 - 900.0);
  EXPECT_NEAR(fill({disc(0, 0, 50), disc(5, 0, 30)}).area_mm2 / ring, 1.0, 0.01);
  EXPECT_NEAR(fill({disc(5, 0, 30), disc(0, 0, 50)}, 0.5, true).area_mm2 / ring, 1.0, 0.01);
  EXPECT_NEAR(fill({disc(0, 0, 50), disc(5, 0, 30), disc(5, 0, 10)}).area_mm2 / (ring + 100.0 * pi), 1.0, 0.01);
  // A hole up to the border; one that is drawn a little over it is told.
  EXPECT_NEAR(fill({disc(0, 0, 50), disc(19.9, 0, 30)}).area_mm2 / ring, 1.0, 0.01);
  const Filled over = fill({block_of(-50, 50, -50, 50), block_of(20, 50.8, -10, 10)});
  EXPECT_NEAR(over.area_mm2, 10000.0 - 600.0 + 16.0, 60.0);
  EXPECT_EQ(over.raster.doubtful, 1U);
  EXPECT_NEAR(over.raster.doubtful_ml, 0.6, 0.03);
  // A keyhole, alone and drawn twice.
  Contour keyhole = block_of(-50, 50, -50, 50);
  keyhole.push_back(keyhole.front());
  for (const Vec3& point : {Vec3(-20, -20, 0), Vec3(-20, 20, 0), Vec3(20, 20, 0), Vec3(20, -20, 0), Vec3(-20, -20, 0)})
    keyhole.push_back(point);
  for (const auto& contours : {std::vector<Contour>{keyhole}, std::vector<Contour>{keyhole, keyhole}})
    EXPECT_NEAR(fill(contours).area_mm2, 8400.0, 120.0);
  // Outline and hole, both drawn twice; a hole in parts that overlap.
  EXPECT_NEAR(fill({disc(0, 0, 50), disc(5, 0, 30), disc(0, 0, 50, 90), disc(5, 0.1, 30)}).area_mm2 / ring, 1.0, 0.01);
  EXPECT_NEAR(fill({block_of(-50, 20, -20, 20), block_of(-20, 50, -20, 20), block_of(-5, 5, -5, 5)}).area_mm2, 3900.0,
              50.0);
  // Two holes that overlap are one.
  EXPECT_NEAR(fill({block_of(-50, 50, -50, 50), block_of(-20, 5, -5, 5), block_of(-5, 20, -5, 5)}).area_mm2, 9600.0,
              120.0);
}

TEST(ContourOverlaps, KeepsThinRingsAndReportsThem) {
  for (const double wall_mm : {1.0, 2.0, 4.0}) {
    const Filled filled = fill({disc(0, 0, 80), disc(0, 0, 80 - wall_mm)}, 0.25);
    EXPECT_NEAR(filled.area_mm2 / (pi * (6400.0 - (80 - wall_mm) * (80 - wall_mm))), 1.0, 0.05) << wall_mm;
    EXPECT_EQ(filled.raster.repeated, 0U) << wall_mm;
    EXPECT_EQ(filled.raster.doubtful, 1U) << wall_mm;
    // Also if the planes of outline and hole are rounded otherwise.
    EXPECT_NEAR(fill({disc(0, 0, 80), disc(0, 0, 80 - wall_mm, 120, 0.03)}, 0.25).area_mm2, filled.area_mm2, 10.0);
  }
  EXPECT_EQ(fill({disc(0, 0, 50), disc(0, 0, 30)}).raster.doubtful, 0U);
}

TEST(ContourOverlaps, ExclusiveOrExcludesTheOverlap) {
  const std::vector<Contour> parts{block_of(-50, 10, -20, 20), block_of(-10, 50, -20, 20)};
  const Filled filled = fill(parts, 0.5, true);
  EXPECT_NEAR(filled.area_mm2, 4000.0 - 800.0, 50.0);
  EXPECT_NEAR(filled.raster.crossing_ml, 0.8, 1e-3);
  EXPECT_NEAR(fill({parts[0], parts[0]}, 0.5, true).area_mm2, 2400.0, 50.0);
}

}  // namespace
}  // namespace trocar::dicom::detail
