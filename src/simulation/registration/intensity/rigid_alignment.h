#pragma once

#include <vector>

#include "geometry/pose.h"
#include "volume/grid.h"

namespace trocar::registration {

/// Points of a fixed volume with their values and slopes (per mm), for alignment.
struct AlignmentPoint {
  Vec3f p_A{0, 0, 0};
  Vec3f slope_A{0, 0, 0};
  float value = 0.0F;
};

/// Every `stride`-th voxel along each axis (>= 1) that has a value and a slope; NaN voxels have none.
std::vector<AlignmentPoint> alignment_points(const volume::FloatGrid& fixed, int stride);

/// A small motion: rotation vector (rad), then translation (mm).
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct AlignmentOptions {
  int iterations = 20;          ///< Of Gauss-Newton.
  double least_overlap = 0.08;  ///< Share of the points that must meet a value of the moving volume.
  double enough_mm = 0.003;     ///< Ends when a step moves the points less.
};

struct Alignment {
  Pose X_AB;
  double ncc = -1.0;     ///< Normalised correlation over the overlap, -1..1; -1 if the volumes overlap too little.
  double overlap = 0.0;  ///< Share of the points in use.
  Matrix6 information = Matrix6::Zero();  ///< Of (rotation about the middle of the points in use, translation).
  Vec3 middle_A{0, 0, 0};
};

/// Normalised correlation at a pose.
Alignment correlate(const std::vector<AlignmentPoint>& fixed, const volume::FloatGrid& moving, const Pose& X_AB,
                    const AlignmentOptions& options = {});

/// Improves X_AB to a maximum of the normalised correlation (docs/physics.md R8), by Gauss-Newton steps with the mean
/// of both volumes' slopes, damped. Parallel; independent of the number of threads.
Alignment align(const std::vector<AlignmentPoint>& fixed, const volume::FloatGrid& moving, const Pose& X_AB,
                const AlignmentOptions& options = {});

}  // namespace trocar::registration
