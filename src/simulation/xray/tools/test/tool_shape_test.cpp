#include "xray/tools/tool_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/random.h"

namespace trocar::xray {
namespace {

/// A detector above the source: source at (0, 0, -700), detector in the plane z = 400.
XrayRays rays_over_origin(double pixel_mm, int pixels = 128) {
  XrayRays rays;
  rays.source_P = Vec3(0, 0, -700);
  rays.column_P = Vec3(pixel_mm, 0, 0);
  rays.row_P = Vec3(0, pixel_mm, 0);
  rays.first_pixel_P = Vec3(0, 0, 400) - 0.5 * (pixels - 1) * (rays.column_P + rays.row_P);
  rays.columns = rays.rows = pixels;
  return rays;
}

/// Mass (g) of an image of thin things at one depth: mass per area times the area, perpendicular to the ray, of the
/// pixel at that depth.
double mass_g(const std::vector<float>& g_per_cm2, const XrayRays& rays, double depth_z) {
  double sum = 0.0;
  const double share = (depth_z + 700.0) / 1100.0;
  const double area_cm2 = 0.01 * rays.column_P.norm() * rays.row_P.norm() * share * share;
  for (int row = 0; row < rays.rows; ++row)
    for (int column = 0; column < rays.columns; ++column) {
      const double cosine = (rays.pixel_P(column, row) - rays.source_P).normalized().z();
      sum += g_per_cm2[static_cast<std::size_t>(row * rays.columns + column)] * area_cm2 * cosine;
    }
  return sum;
}

ToolShape wire(std::vector<Vec3> line_P, double radius_mm) {
  ToolShape tool;
  tool.line_P = std::move(line_P);
  tool.outer_radius_mm = radius_mm;
  return tool;
}

std::vector<float> steel_of(const ToolShape& tool, const XrayRays& rays) {
  MassImage masses;
  add_tools({tool}, rays, masses);
  return masses.of(Basis::kSteel);
}

double cylinder_g(double radius_mm, double length_mm, double density) {
  return std::numbers::pi * radius_mm * radius_mm * length_mm * 1e-3 * density;
}

constexpr double kMassTolerance = 0.01;

TEST(ToolShape, KeepsTheMassOfWiresThinnerThanAPixel) {
  Random random(3);
  for (const double pixel_mm : {0.2, 0.6, 1.5})
    for (const double radius_mm : {0.05, 0.2, 0.9})
      for (int n = 0; n < 12; ++n) {
        const XrayRays rays = rays_over_origin(pixel_mm);
        const double half = 0.2 * pixel_mm * rays.columns;  // in the field at this depth
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        const Vec3 shift(random.uniform(-1, 1) * pixel_mm, random.uniform(-1, 1) * pixel_mm, 0);
        const Vec3 direction(std::cos(angle), std::sin(angle), 0);
        const auto image = steel_of(wire({shift - half * direction, shift + half * direction}, radius_mm), rays);
        const double expected = cylinder_g(radius_mm, 2.0 * half, 7.9);
        EXPECT_NEAR(mass_g(image, rays, 0.0), expected, kMassTolerance * expected)
            << pixel_mm << " " << radius_mm << " " << angle;
      }
}

TEST(ToolShape, ProjectsAWireAlongItsAxis) {
  const XrayRays rays = rays_over_origin(0.6);
  for (const double x_mm : {-3.17, 0.0, 0.05, 0.21, 7.93})
    for (const double radius_mm : {0.1, 0.5}) {
      const auto image = steel_of(wire({{x_mm, -30, 0}, {x_mm, 30, 0}}, radius_mm), rays);
      const double expected = (x_mm * 1100.0 / 700.0 - rays.first_pixel_P.x()) / 0.6;
      double sum = 0.0, moment = 0.0;
      for (int column = 0; column < rays.columns; ++column) {
        const double value = image[static_cast<std::size_t>(64 * rays.columns + column)];
        sum += value;
        moment += value * column;
      }
      EXPECT_NEAR(moment / sum, expected, 0.01);
    }
}

TEST(ToolShape, MatchesTheChordThroughAWideCylinder) {
  const XrayRays rays = rays_over_origin(0.1, 129);
  const auto image = steel_of(wire({{0, -20, 0}, {0, 20, 0}}, 3.0), rays);
  const double chord_cm = 0.6;
  EXPECT_NEAR(image[64 * 129 + 64], chord_cm * 7.9, 1e-3);
  // At an angle the chord is longer by 1 / sine.
  const double angle = 0.9;
  const Vec3 along(0, std::sin(angle), std::cos(angle));
  EXPECT_NEAR(steel_of(wire({-20.0 * along, 20.0 * along}, 3.0), rays)[64 * 129 + 64], chord_cm * 7.9 / std::sin(angle),
              5e-3);
}

TEST(ToolShape, ProjectsATubeWithAFilledBore) {
  const XrayRays rays = rays_over_origin(0.1, 129);
  ToolShape tube = wire({{0, -20, 0}, {0, 20, 0}}, 2.0);
  tube.inner_radius_mm = 1.5;
  tube.filling_iodine_mg_per_ml = 300.0;
  MassImage masses;
  add_tools({tube}, rays, masses);
  EXPECT_NEAR(masses.of(Basis::kSteel)[64 * 129 + 64], 0.1 * 7.9, 1e-3);
  EXPECT_NEAR(masses.of(Basis::kIodine)[64 * 129 + 64], 0.3 * 0.3, 1e-4);
  EXPECT_TRUE(masses.of(Basis::kBone).empty());
}

TEST(ToolShape, KeepsLengthAndMassWhenViewedEndOn) {
  const XrayRays rays = rays_over_origin(0.3);
  for (const double slope : {0.0, 0.02, 0.1, 0.19, 0.21}) {
    const Vec3 along = Vec3(slope, 0.3 * slope, 1.0).normalized();
    const auto image = steel_of(wire({-1.5 * along, 1.5 * along}, 0.6), rays);
    const double expected = cylinder_g(0.6, 3.0, 7.9);
    EXPECT_NEAR(mass_g(image, rays, 0.0), expected, kMassTolerance * expected) << slope;
  }
  // The central ray lies in the axis: its chord is the length.
  EXPECT_NEAR(steel_of(wire({{0, 0, -25}, {0, 0, 25}}, 0.8), rays_over_origin(0.1, 129))[64 * 129 + 64], 5.0 * 7.9,
              0.01);
}

TEST(ToolShape, CountsJointsOfABentLineOnce) {
  const XrayRays rays = rays_over_origin(0.3, 256);
  // An arc of 60 mm length, once in few and once in many pieces: mass of the axis' length.
  for (const int pieces : {6, 60, 600}) {
    std::vector<Vec3> line;
    for (int n = 0; n <= pieces; ++n) {
      const double angle = 2.0 * n / pieces;
      line.emplace_back(20.0 * std::cos(angle) - 5.0, 20.0 * std::sin(angle) - 10.0, 0.0);
    }
    double length = 0.0;
    for (int n = 0; n < pieces; ++n)
      length += (line[static_cast<std::size_t>(n) + 1] - line[static_cast<std::size_t>(n)]).norm();
    const auto image = steel_of(wire(line, 0.7), rays);
    const double expected = cylinder_g(0.7, length, 7.9);
    EXPECT_NEAR(mass_g(image, rays, 0.0), expected, kMassTolerance * expected) << pieces;
    const double most = *std::max_element(image.begin(), image.end());
    EXPECT_LT(most, 1.03 * 0.14 * 7.9) << "no pixel has more than the diameter";
  }
}

TEST(ToolShape, IsUnchangedByPointsOnAStraightLine) {
  const XrayRays rays = rays_over_origin(0.4);
  const auto whole = steel_of(wire({{-8, -9, 3}, {9, 8, -4}}, 0.4), rays);
  std::vector<Vec3> many;
  for (int n = 0; n <= 40; ++n) many.emplace_back(Vec3(-8, -9, 3) + n / 40.0 * Vec3(17, 17, -7));
  const auto parts = steel_of(wire(many, 0.4), rays);
  for (std::size_t n = 0; n < whole.size(); ++n) EXPECT_NEAR(parts[n], whole[n], 0.02);
}

TEST(ToolShape, TouchesOnlyPixelsNearTheShadow) {
  const XrayRays rays = rays_over_origin(0.4);
  const auto image = steel_of(wire({{0, -50, 0}, {0, 50, 0}}, 0.4), rays);
  for (int row = 0; row < rays.rows; ++row)
    for (int column = 0; column < rays.columns; ++column) {
      if (std::abs(column - 63.5) < 4.0) continue;
      EXPECT_EQ(image[static_cast<std::size_t>(row * rays.columns + column)], 0.0F);
    }
}

TEST(ToolShape, IgnoresPointsBehindTheSourceOrNonFinite) {
  const XrayRays rays = rays_over_origin(0.4);
  const auto behind = steel_of(wire({{0, 0, -900}, {0, 10, -900}}, 0.4), rays);
  EXPECT_EQ(*std::max_element(behind.begin(), behind.end()), 0.0F);
  MassImage masses;
  add_tools({wire({{0, 0, std::nan("")}, {0, 10, 0}}, 0.4)}, rays, masses);
  EXPECT_TRUE(masses.of(Basis::kSteel).empty());
}

TEST(ToolShape, IsTheSameOnAnyNumberOfThreads) {
  const XrayRays rays = rays_over_origin(0.4);
  const ToolShape tool = wire({{-8, -20, 3}, {0, 1, 0}, {9, 18, -4}}, 0.4);
  std::vector<float> one, many;
  run_on_threads(1, [&] { one = steel_of(tool, rays); });
  run_on_threads(4, [&] { many = steel_of(tool, rays); });
  EXPECT_EQ(one, many);
}

TEST(IodinePieces, HaveTheMassOfTheirCones) {
  Random random(5);
  for (int n = 0; n < 40; ++n) {
    const XrayRays rays = rays_over_origin(0.5);
    const Vec3 direction = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const double length = random.uniform(1.0, 12.0), a = random.uniform(0.3, 2.5), b = random.uniform(0.3, 2.5);
    IodinePiece piece{-0.5 * length * direction, 0.5 * length * direction, a, b, 150.0};
    std::vector<float> image;
    add_iodine({piece}, rays, image);
    const double ml = std::numbers::pi / 3.0 * length * (a * a + a * b + b * b) * 1e-3;
    // Where rays pass along the axis, depth differs within the piece.
    EXPECT_NEAR(mass_g(image, rays, 0.0), 0.15 * ml, 0.03 * 0.15 * ml)
        << length << " " << a << " " << b << " " << direction.z();
  }
}

TEST(IodinePieces, JoinWithoutAStep) {
  const XrayRays rays = rays_over_origin(0.3);
  std::vector<IodinePiece> pieces;
  for (int n = 0; n < 10; ++n) pieces.push_back({{2.0 * n - 10.0, 0, 0}, {2.0 * n - 8.0, 0, 0}, 2.0, 2.0, 200.0});
  std::vector<float> image;
  add_iodine(pieces, rays, image);
  const double expected = 0.4 * 0.2;
  for (int column = 54; column < 74; ++column)
    EXPECT_NEAR(image[static_cast<std::size_t>(63 * rays.columns + column)], expected, 0.01 * expected) << column;
}

}  // namespace
}  // namespace trocar::xray
