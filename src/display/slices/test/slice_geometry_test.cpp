#include "slices/slice_geometry.h"

#include <gtest/gtest.h>

#include "coarse_abdomen.h"
#include "core/random.h"

namespace trocar::slices {
namespace {

Vec3 random_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

SliceGeometry random_geometry(Random& random) {
  SliceGeometry geometry;
  const NeedlePlane plane = random.uniform() < 0.5 ? NeedlePlane::kAlong : NeedlePlane::kAcross;
  geometry.axes = needle_axes(random_direction(random), plane);
  geometry.center_P = 300.0 * random_direction(random);
  geometry.mm_per_px = random.uniform(0.05, 4.0);
  geometry.columns = 1 + static_cast<int>(random.next() % 900);
  geometry.rows = 1 + static_cast<int>(random.next() % 900);
  return geometry;
}

TEST(SliceGeometry, PixelsAndPointsAreExactInverses) {
  Random random(1);
  for (int n = 0; n < 500; ++n) {
    const SliceGeometry geometry = random_geometry(random);
    const Eigen::Vector2d pixel(random.uniform(-100.0, 1000.0), random.uniform(-100.0, 1000.0));
    const Vec3 p_P = geometry.to_P(pixel);
    EXPECT_LT((geometry.to_pixel(p_P) - pixel).norm(), 1e-8);  // rounding of 300 mm / 0.05 mm
    EXPECT_NEAR(geometry.height_mm(p_P), 0.0, 1e-9);
    EXPECT_NEAR(geometry.height_mm(p_P - 7.0 * geometry.axes.normal_P()), -7.0, 1e-9);
    const volume::SlicePlane plane = geometry.plane();
    EXPECT_LT((plane.origin_P + pixel.x() * plane.step_u_P + pixel.y() * plane.step_v_P - p_P).norm(), 1e-9);
  }
}

TEST(SliceGeometry, ZoomsAtAPoint) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    SliceGeometry geometry = random_geometry(random);
    const Eigen::Vector2d pixel(random.uniform(0.0, 900.0), random.uniform(0.0, 900.0));
    const Vec3 under_P = geometry.to_P(pixel);
    geometry.zoom_at(pixel, random.uniform(0.05, 4.0));
    EXPECT_LT((geometry.to_P(pixel) - under_P).norm(), 1e-9);
    EXPECT_NEAR(geometry.height_mm(under_P), 0.0, 1e-9);
  }
}

TEST(NeedleAxes, AreRadiologicalForANeedleFromTheFront) {
  const Vec3 axis_P = Vec3::UnitY();
  const SliceAxes along = needle_axes(axis_P, NeedlePlane::kAlong);
  EXPECT_LT((along.u_P - slice_axes(SliceOrientation::kAxial).u_P).norm(), 1e-12);
  EXPECT_LT((along.v_P - slice_axes(SliceOrientation::kAxial).v_P).norm(), 1e-12);
  const SliceAxes across = needle_axes(axis_P, NeedlePlane::kAcross);
  EXPECT_LT((across.u_P - slice_axes(SliceOrientation::kCoronal).u_P).norm(), 1e-12);
  EXPECT_LT((across.v_P - slice_axes(SliceOrientation::kCoronal).v_P).norm(), 1e-12);
  const SliceAxes turned = needle_axes(axis_P, NeedlePlane::kAlongTurned);
  EXPECT_EQ(direction_letters(-turned.u_P), "H");
}

TEST(NeedleAxes, ContainTheAxisAndAreOrthogonal) {
  Random random(3);
  for (int n = 0; n < 500; ++n) {
    const Vec3 axis_P = n == 0 ? Vec3(Vec3::UnitZ()) : random_direction(random);
    const SliceAxes along = needle_axes(axis_P, NeedlePlane::kAlong);
    const SliceAxes turned = needle_axes(axis_P, NeedlePlane::kAlongTurned);
    const SliceAxes across = needle_axes(axis_P, NeedlePlane::kAcross);
    for (const SliceAxes& axes : {along, turned, across}) {
      EXPECT_NEAR(axes.u_P.norm(), 1.0, 1e-12);
      EXPECT_NEAR(axes.v_P.norm(), 1.0, 1e-12);
      EXPECT_NEAR(axes.u_P.dot(axes.v_P), 0.0, 1e-12);
    }
    EXPECT_LT((along.v_P - axis_P).norm(), 1e-12);  // The tip points down.
    EXPECT_LT((turned.v_P - axis_P).norm(), 1e-12);
    EXPECT_LT((across.normal_P() - axis_P).norm(), 1e-12);  // Seen from the hub.
    EXPECT_NEAR(along.normal_P().dot(turned.normal_P()), 0.0, 1e-12);
  }
}

TEST(DirectionLetters, NameTheStrongestDirectionsFirst) {
  EXPECT_EQ(direction_letters({1, 0, 0}), "L");
  EXPECT_EQ(direction_letters({0, -5, 0}), "A");
  EXPECT_EQ(direction_letters({0, 0.1, -1}), "F");
  EXPECT_EQ(direction_letters({-1, -0.7, 0.1}), "RA");
  EXPECT_EQ(direction_letters(Vec3::Zero()), "");
}

TEST(FittingScale, ShowsTheWholeBox) {
  const Box box(Vec3(-100, -50, 0), Vec3(100, 50, 400));
  EXPECT_NEAR(fitting_scale(box, slice_axes(SliceOrientation::kAxial), 400, 400), 0.5, 1e-12);
  EXPECT_NEAR(fitting_scale(box, slice_axes(SliceOrientation::kCoronal), 400, 400), 1.0, 1e-12);
}

TEST(BodyBox, EnclosesTheBodyTightly) {
  const anatomy::VirtualPatient& patient = coarse_abdomen();
  const Box box = body_box(patient);
  const Box whole = volume_box(patient.ct.geometry);
  EXPECT_LT(box.sizes().x(), whole.sizes().x());  // There is air around it.
  const volume::FloatGrid& distance = patient.skin_distance_mm;
  for (std::size_t n = 0; n < distance.voxels.size(); n += 101) {
    if (distance.voxels[n] >= 0.0F) continue;
    const auto [i, j, k] = distance.geometry.index_of(n);
    ASSERT_TRUE(box.contains(
        distance.geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)})));
  }
}

}  // namespace
}  // namespace trocar::slices
