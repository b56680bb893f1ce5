#pragma once

#include <cstdint>

#include "geometry/vec.h"

namespace trocar::xray::detail {

/// Heterogeneity of tissue: a seeded random number at each point of P with mean 0 and variance 1, a sum of quadratic
/// B-splines on a lattice of `correlation_mm` (> 0) with independent uniform coefficients. Averaged over the places of
/// the lattice, its correlation along an axis is the quintic B-spline: 0.39 at correlation_mm, 0.015 at twice, 0 at
/// three times that distance. Real-time safe.
double uptake_field(const Vec3& p_P, double correlation_mm, std::uint64_t seed) noexcept;

}  // namespace trocar::xray::detail
