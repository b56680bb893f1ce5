#include "volume/spline_field.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace trocar::volume {
namespace {

SplineField make_field() {
  SplineField field;
  field.lattice.size = {9, 8, 10};
  field.lattice.spacing_mm = Vec3(20, 25, 15);
  field.lattice.origin_P = Vec3(-60, 10, 5);
  field.lattice.R_PV = Eigen::AngleAxisd(0.4, Vec3(1, 2, 2) / 3.0).toRotationMatrix();
  field.coefficients_mm.assign(field.lattice.voxel_count(), Vec3::Zero());
  return field;
}

TEST(SplineField, ReproducesAffineDisplacements) {
  SplineField field = make_field();
  Mat3 slope;
  slope << 0.02, 0.1, 0, -0.05, 0.03, 0.01, 0, 0.04, -0.06;
  for (std::size_t n = 0; n < field.coefficients_mm.size(); ++n)
    field.coefficients_mm[n] = slope * field.lattice.centre_mm(field.lattice.index_of(n)) + Vec3(1, 2, 3);
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = field.lattice.to_mm(Vec3(random.uniform(1, 7), random.uniform(1, 6), random.uniform(1, 8)));
    EXPECT_LT((displacement_at(field, p) - slope * p - Vec3(1, 2, 3)).norm(), 1e-11);
    EXPECT_NEAR(jacobian_at(field, p), (Mat3::Identity() + slope).determinant(), 1e-12);
  }
}

TEST(SplineField, JacobianIsTheDerivativeOfTheDisplacement) {
  SplineField field = make_field();
  Random random(2);
  for (Vec3& c : field.coefficients_mm) c = 4.0 * Vec3(random.normal(), random.normal(), random.normal());
  constexpr double kStep_mm = 1e-4;
  for (int n = 0; n < 20; ++n) {
    const Vec3 p = field.lattice.to_mm(Vec3(random.uniform(1, 7), random.uniform(1, 6), random.uniform(1, 8)));
    Mat3 numeric = Mat3::Identity();
    for (int a = 0; a < 3; ++a)
      numeric.col(a) += (displacement_at(field, p + kStep_mm * Vec3::Unit(a)) -
                         displacement_at(field, p - kStep_mm * Vec3::Unit(a))) /
                        (2.0 * kStep_mm);
    EXPECT_NEAR(jacobian_at(field, p), numeric.determinant(), 1e-6);
  }
}

TEST(SplineField, IsZeroOutsideOfItsDomain) {
  SplineField field = make_field();
  field.coefficients_mm.assign(field.coefficients_mm.size(), Vec3(5, 5, 5));
  EXPECT_EQ(displacement_at(field, field.lattice.to_mm(Vec3(0.9, 3, 3))), Vec3(0, 0, 0));
  EXPECT_LT((displacement_at(field, field.lattice.to_mm(Vec3(1.1, 3, 3))) - Vec3(5, 5, 5)).norm(), 1e-12);
  EXPECT_EQ(displacement_at(field, Vec3::Constant(std::nan(""))), Vec3(0, 0, 0));
  EXPECT_EQ(jacobian_at(field, Vec3(1e9, 0, 0)), 1.0);
}

}  // namespace
}  // namespace trocar::volume
