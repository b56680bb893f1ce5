#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::registration {

/// Least-squares rigid motion between point pairs.
struct RigidFit {
  Pose X_AB;                        ///< Maps points of B to A.
  double rms_mm = 0.0;              ///< Root of the weighted mean square of the residuals.
  std::vector<double> residual_mm;  ///< Distance of each pair after the fit, in the order of the pairs.
  double scale = 1.0;               ///< Scale of the best similarity fit, A over B; 1 for pairs that fit rigidly.
};

/// Fits a rotation and a translation to pairs of points (mm), A and B in the same order (Umeyama, IEEE Trans Pattern
/// Anal Mach Intell 13:376, 1991; docs/physics.md R10). `weights`: none, or one for each pair, finite and not negative.
/// Deterministic. Errors: unequal counts, values that are not finite, fewer than three pairs of positive weight, points
/// of A or B on one line (their second singular value is below a hundredth of the first, or below 1e-3 mm), mirrored
/// pairs (a reflection fits much better than any rotation).
Result<RigidFit> fit_rigid(std::span<const Vec3> points_A, std::span<const Vec3> points_B,
                           std::span<const double> weights = {});

/// Index of the pair with the largest residual; 0 if the fit has no pair.
std::size_t worst_pair(const RigidFit& fit) noexcept;

}  // namespace trocar::registration
