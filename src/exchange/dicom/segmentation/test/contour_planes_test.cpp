// Planes of contours beside the slices of the CT: cylinders and spheres keep their volume, separate parts stay
// separate.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dicom/segmentation/detail/contour_raster.h"

namespace trocar::dicom::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// 120 x 120 pixels of 1 mm; slices of `step_mm` over 240 mm.
volume::GridGeometry slices_of(double step_mm) {
  volume::GridGeometry g;
  g.size = {120, 120, static_cast<std::int64_t>(240.0 / step_mm) + 1};
  g.spacing_mm = {1, 1, step_mm};
  g.origin_P = {-59.7, -60.2, -120};
  return g;
}

Contour circle(double x, double y, double z, double radius_mm) {
  Contour points;
  for (int n = 0; n < 90; ++n)
    points.emplace_back(x + radius_mm * std::cos(n * kPi / 45), y + radius_mm * std::sin(n * kPi / 45), z);
  return points;
}

struct Drawn {
  double ml = 0.0;
  std::vector<std::size_t> planes;  ///< Voxels in each slice.
  PlaneDistances distances;
  double outside_ml = 0.0;
};

Drawn draw(const std::vector<Contour>& contours, const volume::GridGeometry& ct) {
  const ContourStructure structure{{1, "Liver"}, contours, 0};
  const auto grid = choose_grid(structure, ct, "rs.dcm");
  EXPECT_TRUE(grid);
  const RasterResult raster = rasterise(structure, *grid);
  Drawn drawn{0.0, std::vector<std::size_t>(static_cast<std::size_t>(grid->geometry.size[2])), raster.distances,
              raster.outside_ml};
  const std::size_t pixels = raster.mask.size() / drawn.planes.size();
  for (std::size_t n = 0; n < raster.mask.size(); ++n)
    if (raster.mask[n] != 0) ++drawn.planes[n / pixels];
  std::size_t voxels = 0;
  for (const std::size_t count : drawn.planes) voxels += count;
  drawn.ml = static_cast<double>(voxels) * grid->geometry.voxel_volume_mm3() / 1000.0;
  return drawn;
}

/// Places every `step_mm` from `first_mm` to `last_mm`, each moved by up to `jitter_mm`.
std::vector<double> places(double first_mm, double last_mm, double step_mm, double jitter_mm = 0.0, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-jitter_mm, jitter_mm);
  std::vector<double> result;
  for (double z = first_mm; z <= last_mm + 1e-9; z += step_mm)
    result.push_back(z + (jitter_mm > 0.0 ? shift(random) : 0.0));
  return result;
}

std::vector<Contour> cylinder(const std::vector<double>& places_mm, double radius_mm = 30.0, double x = 0.0) {
  std::vector<Contour> contours;
  for (const double z : places_mm) contours.push_back(circle(x, 0.0, z, radius_mm));
  return contours;
}

std::vector<Contour> sphere(const std::vector<double>& places_mm, double radius_mm) {
  std::vector<Contour> contours;
  for (const double z : places_mm)
    if (std::abs(z) < radius_mm) contours.push_back(circle(0.0, 0.0, z, std::sqrt(radius_mm * radius_mm - z * z)));
  return contours;
}

double cylinder_ml(double radius_mm, double length_mm) {
  return kPi * radius_mm * radius_mm * length_mm / 1000.0;
}

TEST(ContourPlanes, JitteredPlanesKeepTheVolume) {
  // Each of the 21 slices takes a plane, whatever the jitter; polygons and pixels are exact to 0.3 %.
  const volume::GridGeometry ct = slices_of(5.0);
  for (const double jitter_mm : {0.05, 0.5, 1.0, 1.5, 2.0}) {
    double mean = 0.0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
      const Drawn drawn = draw(cylinder(places(-50, 50, 5, jitter_mm, seed)), ct);
      EXPECT_NEAR(drawn.ml / cylinder_ml(30, 105), 1.0, 0.01) << jitter_mm << " mm, seed " << seed;
      EXPECT_EQ(drawn.distances.open_gaps, 0U) << jitter_mm << " mm, seed " << seed;
      const Drawn ball = draw(sphere(places(-55, 55, 5, jitter_mm, seed), 50), ct);
      // A single sum of jittered discs is more uncertain than its mean.
      EXPECT_NEAR(ball.ml / (4.0 / 3.0 * kPi * 125.0), 1.0, 0.03) << jitter_mm << " mm, seed " << seed;
      mean += ball.ml / 12.0;
    }
    EXPECT_NEAR(mean / (4.0 / 3.0 * kPi * 125.0), 1.0, 0.01) << jitter_mm;
  }
}

TEST(ContourPlanes, JitterAboveTheSliceDistanceKeepsTheVolume) {
  // Planes 1.6 mm apart, moved by up to 2 mm, change their order; the ends are uncertain.
  const volume::GridGeometry ct = slices_of(1.6);
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Drawn drawn = draw(cylinder(places(-50, 50, 1.6, 2.0, seed)), ct);
    EXPECT_NEAR(drawn.ml / cylinder_ml(30, 101.6), 1.0, 0.06) << seed;
    const Drawn ball = draw(sphere(places(-51.2, 51.2, 1.6, 2.0, seed), 50), ct);
    EXPECT_EQ(drawn.distances.open_gaps + ball.distances.open_gaps, 0U) << seed;
    EXPECT_NEAR(ball.ml / (4.0 / 3.0 * kPi * 125.0), 1.0, 0.03) << seed;
  }
}

TEST(ContourPlanes, KeepVolumeBetweenSlicesAndOnEverySecondSlice) {
  const volume::GridGeometry ct = slices_of(5.0);
  EXPECT_NEAR(draw(cylinder(places(-47.5, 47.5, 5)), ct).ml / cylinder_ml(30, 100), 1.0, 0.005);
  EXPECT_NEAR(draw(cylinder(places(-47.4, 47.6, 5)), ct).ml / cylinder_ml(30, 100), 1.0, 0.005);
  // Every second and fourth slice: half-way is a slice, which belongs to one of the two.
  EXPECT_NEAR(draw(cylinder(places(-50, 50, 10)), ct).ml / cylinder_ml(30, 110), 1.0, 0.005);
  EXPECT_NEAR(draw(cylinder(places(-40, 40, 20)), ct).ml / cylinder_ml(30, 100), 1.0, 0.005);
  EXPECT_NEAR(draw(cylinder(places(-50, 50, 10, 2.0)), ct).ml / cylinder_ml(30, 110), 1.0, 0.05);
  EXPECT_NEAR(draw(sphere(places(-50, 50, 10), 50), ct).ml / (4.0 / 3.0 * kPi * 125.0), 1.0, 0.02);
  // Finer than the slices, at distances that are no part of theirs.
  EXPECT_NEAR(draw(cylinder(places(-49, 49, 0.7)), ct).ml / cylinder_ml(30, 98.7), 1.0, 0.05);
  EXPECT_NEAR(draw(sphere(places(-50, 50, 1.3), 50), ct).ml / (4.0 / 3.0 * kPi * 125.0), 1.0, 0.02);
}

TEST(ContourPlanes, UnevenDistancesKeepTheVolume) {
  // 2 mm in one half, 5 mm in the other; few of one kind among many of the other; distances that grow.
  const volume::GridGeometry ct = slices_of(1.0);
  const auto length = [](const std::vector<double>& z) { return z.back() - z.front(); };
  std::vector<double> halves = places(-50, 0, 2), few = places(-50, 20, 2), growing{-50.0};
  for (double z = 5; z <= 50; z += 5) halves.push_back(z);
  for (double z = 25; z <= 35; z += 5) few.push_back(z);
  for (double step = 1.0; growing.back() < 40.0; step *= 1.1) growing.push_back(growing.back() + step);
  for (const auto& z : {halves, few, growing}) {
    const Drawn drawn = draw(cylinder(z), ct);
    EXPECT_EQ(drawn.distances.open_gaps, 0U) << length(z);
    // The ends reach half a usual distance, 1 to 2.5 mm.
    EXPECT_NEAR(drawn.ml / cylinder_ml(30, length(z) + 3), 1.0, 0.03) << length(z);
  }
}

TEST(ContourPlanes, CountOnceWhenDrawnTwice) {
  const volume::GridGeometry ct = slices_of(1.0);
  for (const double apart_mm : {0.1, 0.4, 0.9, 1.2}) {
    std::vector<double> twice;
    for (const double z : places(-50, 50, 5)) twice.insert(twice.end(), {z, z + apart_mm});
    const Drawn drawn = draw(cylinder(twice), ct);
    EXPECT_EQ(drawn.distances.open_gaps, 0U) << apart_mm;
    EXPECT_NEAR(drawn.ml / cylinder_ml(30, 105), 1.0, apart_mm > 1.0 ? 0.035 : 0.015) << apart_mm;
  }
  // A few of them.
  std::vector<double> some = places(-50, 50, 5);
  some.insert(some.end(), {0.3, 20.2, -30.1});
  EXPECT_NEAR(draw(cylinder(some), ct).ml / cylinder_ml(30, 105), 1.0, 0.01);
}

TEST(ContourPlanes, SeparatePartsStaySeparate) {
  const volume::GridGeometry ct = slices_of(5.0);
  for (const double jitter_mm : {0.0, 1.0, 2.0})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      std::vector<double> z = places(-80, -40, 5, jitter_mm, seed);
      for (const double upper : places(-10, 30, 5, jitter_mm, seed + 100)) z.push_back(upper);
      const Drawn drawn = draw(cylinder(z), ct);
      EXPECT_EQ(drawn.distances.open_gaps, 1U) << jitter_mm << " mm, seed " << seed;
      EXPECT_NEAR(drawn.ml / cylinder_ml(30, 90), 1.0, 0.01) << jitter_mm << " mm, seed " << seed;
      for (std::size_t plane = 17; plane <= 21; ++plane) EXPECT_EQ(drawn.planes[plane], 0U) << plane;  // -35 to -15 mm
    }
  // A single plane far from the others is as thick as they are.
  std::vector<double> z = places(-80, -40, 5);
  z.push_back(20.0);
  EXPECT_NEAR(draw(cylinder(z), ct).ml / cylinder_ml(30, 50), 1.0, 0.01);
}

TEST(ContourPlanes, LobesSideBySideHaveTheirOwnPlanes) {
  // Planes of the second lobe lie between those of the first: each fills its own slices.
  const volume::GridGeometry ct = slices_of(5.0);
  for (const double shift_mm : {0.3, 1.0, 2.4}) {
    std::vector<Contour> lobes = cylinder(places(-50, 50, 5), 20, -25);
    for (Contour& contour : cylinder(places(-50 + shift_mm, 50 + shift_mm, 5), 20, 25))
      lobes.push_back(std::move(contour));
    const Drawn drawn = draw(lobes, ct);
    EXPECT_NEAR(drawn.ml / (2.0 * cylinder_ml(20, 105)), 1.0, 0.01) << shift_mm;
    EXPECT_EQ(drawn.distances.open_gaps + drawn.distances.filled_gaps, 0U) << shift_mm;
  }
}

TEST(ContourPlanes, BranchesFillEverySlice) {
  // A trunk that splits into two branches whose planes are shifted.
  const volume::GridGeometry ct = slices_of(1.0);
  std::vector<Contour> tree = cylinder(places(-50, 0, 5), 40);
  for (Contour& c : cylinder(places(5, 50, 5), 15, -20)) tree.push_back(std::move(c));
  for (Contour& c : cylinder(places(7, 52, 5), 15, 20)) tree.push_back(std::move(c));
  const Drawn drawn = draw(tree, ct);
  const double expected = cylinder_ml(40, 55) + cylinder_ml(15, 50) + cylinder_ml(15, 52);
  EXPECT_NEAR(drawn.ml / expected, 1.0, 0.01);
  for (std::size_t plane = 71; plane <= 172; ++plane) EXPECT_GT(drawn.planes[plane], 600U) << plane;
}

TEST(ContourPlanes, AHoleBesideItsOutlineStaysAHole) {
  const volume::GridGeometry ct = slices_of(5.0);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::vector<Contour> tube = cylinder(places(-50, 50, 5, 1.0, seed));
    for (Contour& hole : cylinder(places(-45, 45, 5, 1.0, seed + 50), 10)) tube.push_back(std::move(hole));
    EXPECT_NEAR(draw(tube, ct).ml / (cylinder_ml(30, 105) - cylinder_ml(10, 95)), 1.0, 0.02) << seed;
  }
}

TEST(ContourPlanes, OnePlaneIsAsThickAsASlice) {
  const volume::GridGeometry ct = slices_of(5.0);
  EXPECT_NEAR(draw(cylinder({0.0}), ct).ml / cylinder_ml(30, 5), 1.0, 0.005);
  EXPECT_NEAR(draw(cylinder({2.5}), ct).ml / cylinder_ml(30, 5), 1.0, 0.005);
  EXPECT_NEAR(draw(cylinder({1.9}), ct).ml / cylinder_ml(30, 5), 1.0, 0.005);
}

TEST(ContourPlanes, VolumeBeyondTheGridIsCounted) {
  const volume::GridGeometry ct = slices_of(5.0);
  const Drawn above = draw(cylinder(places(70, 170, 5)), ct);  // the last slice ends at 122.5 mm
  EXPECT_NEAR(above.ml / cylinder_ml(30, 55), 1.0, 0.01);
  EXPECT_NEAR(above.outside_ml / cylinder_ml(30, 50), 1.0, 0.01);
  const Drawn beside = draw(cylinder(places(-50, 50, 5), 30, 59.8), ct);  // its axis on the last column
  EXPECT_NEAR(beside.outside_ml / (0.5 * cylinder_ml(30, 105)), 1.0, 0.03);
  EXPECT_EQ(draw(cylinder(places(-50, 50, 5)), ct).outside_ml, 0.0);
}

TEST(ContourPlanes, ObliqueJitteredPlanesKeepTheVolume) {
  const volume::GridGeometry ct = slices_of(2.0);
  const Mat3 R = (Eigen::AngleAxisd(0.6, Vec3::UnitY()) * Eigen::AngleAxisd(0.5, Vec3::UnitX())).toRotationMatrix();
  for (const double jitter_mm : {0.0, 1.0, 2.0}) {
    std::vector<Contour> tilted = cylinder(places(-50, 50, 5, jitter_mm));
    for (Contour& contour : tilted)
      for (Vec3& point : contour) point = R * point;
    EXPECT_NEAR(draw(tilted, ct).ml / cylinder_ml(30, 105), 1.0, 0.03) << jitter_mm;
  }
}

}  // namespace
}  // namespace trocar::dicom::detail
