#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "motion/patient_motion.h"

namespace trocar::motion::testing {

/// Displacement (mm) of a point at rest where the driver is 1.
using Displacement = std::function<Vec3(const Vec3& p_A)>;

inline Displacement uniform(const Vec3& displacement_mm) {
  return [=](const Vec3&) { return displacement_mm; };
}
/// Zero at the centre, `displacement_mm` at `extent_mm` along the axis from it, linear.
inline Displacement ramp(const Vec3& displacement_mm, const Vec3& centre_A, const Vec3& axis_A, double extent_mm) {
  return [=](const Vec3& p_A) -> Vec3 { return axis_A.dot(p_A - centre_A) / extent_mm * displacement_mm; };
}
inline Displacement bump(const Vec3& displacement_mm, const Vec3& centre_A, double extent_mm) {
  return [=](const Vec3& p_A) -> Vec3 {
    return std::exp(-0.5 * (p_A - centre_A).squaredNorm() / (extent_mm * extent_mm)) * displacement_mm;
  };
}

/// Nodes every `spacing_mm` within `half_mm` of a point.
inline volume::GridGeometry lattice_around(const Vec3& centre_A, double half_mm, double spacing_mm) {
  volume::GridGeometry lattice;
  const auto nodes = 2 * static_cast<std::int64_t>(std::ceil(half_mm / spacing_mm)) + 1;
  lattice.size = {nodes, nodes, nodes};
  lattice.spacing_mm = Vec3::Constant(spacing_mm);
  lattice.origin_P = centre_A - 0.5 * static_cast<double>(nodes - 1) * lattice.spacing_mm;
  return lattice;
}

/// Coefficients of the spline that is the function at the nodes; exact everywhere for polynomials up to squares.
inline std::vector<Vec3f> sampled(const Displacement& displacement, const volume::GridGeometry& lattice) {
  std::vector<Vec3f> mode(lattice.voxel_count());
  for (std::size_t n = 0; n < mode.size(); ++n) {
    const Vec3 p_A = lattice.centre_mm(lattice.index_of(n));
    const Vec3 here = displacement(p_A);
    Vec3 sum = here;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = lattice.spacing_mm[axis] * Vec3::Unit(axis);
      sum -= 0.125 * (displacement(p_A + step) + displacement(p_A - step) - 2.0 * here);
    }
    mode[n] = sum.cast<float>();
  }
  return mode;
}

/// The first region is where normal_A . p_A <= offset_mm, the second one beyond.
inline volume::FloatGrid flat_border(const Vec3& normal_A, double offset_mm) {
  volume::GridGeometry geometry = lattice_around(Vec3::Zero(), 1024.0, 512.0);  // trilinear: exact for a plane
  volume::FloatGrid border(geometry);
  for (std::size_t n = 0; n < border.voxels.size(); ++n)
    border.voxels[n] = static_cast<float>(normal_A.dot(geometry.centre_mm(geometry.index_of(n))) - offset_mm);
  return border;
}

/// One region; a driver for each displacement.
inline MotionParts whole_body(const std::vector<Displacement>& displacements,
                              const volume::GridGeometry& lattice = lattice_around(Vec3::Zero(), 240.0, 8.0)) {
  MotionParts parts;
  parts.regions = {"body"};
  parts.lattice = lattice;
  for (const Displacement& displacement : displacements) {
    parts.drivers.push_back("driver " + std::to_string(parts.drivers.size() + 1));
    parts.modes.push_back(sampled(displacement, lattice));
  }
  return parts;
}

/// A wall at rest, and an inside beyond the border that slides along it; a driver for each displacement of the inside.
inline MotionParts sliding_parts(const volume::FloatGrid& border_mm, const std::vector<Displacement>& displacements,
                                 const volume::GridGeometry& lattice = lattice_around(Vec3::Zero(), 240.0, 8.0)) {
  MotionParts parts = whole_body(displacements, lattice);
  parts.regions = {"wall", "inside"};
  parts.border_mm = border_mm;
  parts.modes.insert(parts.modes.begin(), displacements.size(),
                     std::vector<Vec3f>(lattice.voxel_count(), Vec3f::Zero()));
  return parts;
}

inline std::shared_ptr<const MotionModel> made(MotionParts parts) {
  auto model = MotionModel::make(std::move(parts), "test");
  TROCAR_CHECK(model.has_value());
  return *model;
}

/// A motion for tests that no rigid pose can imitate: beyond a plane that stands for the chest wall (x = `wall_mm`, the
/// patient's right) everything rests, on its other side the anatomy shears along z, and a bump around `centre_A` pushes
/// it towards the front. The two sides slide along the plane.
inline std::shared_ptr<const MotionModel> sliding_model(double wall_mm, const Vec3& centre_A) {
  return made(sliding_parts(flat_border(Vec3::UnitX(), wall_mm),
                            {ramp({0.0, 0.0, -18.0}, centre_A - 90.0 * Vec3::UnitY(), Vec3::UnitY(), 90.0),
                             bump({0.0, -8.0, 0.0}, centre_A, 35.0)},
                            lattice_around(centre_A, 240.0, 8.0)));
}

/// Everything is displaced by the same vector where the first driver is 1.
inline std::shared_ptr<const MotionModel> uniform_model(const Vec3& displacement_mm) {
  return made(whole_body({uniform(displacement_mm)}, lattice_around(Vec3::Zero(), 10.0, 10.0)));
}

/// A breath of 4 s for that model.
inline MotionDrive sliding_drive() {
  MotionDrive drive;
  drive.period_s = 4.0;
  drive.pause_share = 0.0;
  drive.depth = {1.0, 0.8};
  return drive;
}

}  // namespace trocar::motion::testing
