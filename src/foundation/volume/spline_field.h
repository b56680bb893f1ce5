#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/grid.h"

namespace trocar::volume {

/// Displacements (mm) of a cubic B-spline on a lattice of coefficients, as itk::BSplineTransform: p -> p + u(p), with
/// u = 0 outside of the domain: from the second node to the last but one, along each axis.
struct SplineField {
  GridGeometry lattice;               ///< Of the coefficients. Size 4 or more along each axis.
  std::vector<Vec3> coefficients_mm;  ///< One for each node, i fastest.
};

/// The 64 nodes with an influence at a point, and their weights.
struct SplineWeights {
  Index3 first{};                                 ///< Lowest node of the 4 x 4 x 4.
  std::array<std::array<double, 4>, 3> weight{};  ///< Along i, j, k.
  std::array<std::array<double, 4>, 3> slope{};   ///< Derivatives of the weights per cell.
  bool is_inside = false;                         ///< The point lies in the domain.
};

SplineWeights spline_weights(const GridGeometry& lattice, const Vec3& p) noexcept;
/// u(p), mm.
Vec3 displacement_at(const SplineField& field, const Vec3& p) noexcept;
/// Determinant of the Jacobian of p -> p + u(p): the change of volume; 0 or less where space folds.
double jacobian_at(const SplineField& field, const Vec3& p) noexcept;

}  // namespace trocar::volume
