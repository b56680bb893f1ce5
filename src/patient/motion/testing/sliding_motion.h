#pragma once

#include <memory>

#include "motion/patient_motion.h"

namespace trocar::motion::testing {

/// A motion for tests that no rigid pose can imitate: beyond a plane that stands for the chest wall (x = `wall_mm`, the
/// patient's right) everything rests, on its other side the anatomy shears along z, and a bump around `centre_A` pushes
/// it towards the front. The two sides slide along the plane.
inline std::shared_ptr<const MotionModel> sliding_model(double wall_mm, const Vec3& centre_A) {
  MotionParts parts;
  parts.drivers = {"diaphragm", "belly"};
  parts.regions = {{"wall", {{Vec3::UnitX(), wall_mm}}}, {"inside", {}}};
  MotionMode shear;
  shear.driver = 0;
  shear.region = 1;
  shear.profile = Profile::kRamp;
  shear.displacement_mm = {0.0, 0.0, -18.0};
  shear.centre_A = {centre_A.x(), centre_A.y() - 90.0, centre_A.z()};
  shear.axis_A = Vec3::UnitY();
  shear.extent_mm = 90.0;
  MotionMode bump;
  bump.driver = 1;
  bump.region = 1;
  bump.profile = Profile::kBump;
  bump.displacement_mm = {0.0, -8.0, 0.0};
  bump.centre_A = centre_A;
  bump.extent_mm = 35.0;
  parts.modes = {shear, bump};
  return *MotionModel::make(std::move(parts), "sliding test motion");
}

/// Everything is displaced by the same vector where the first driver is 1.
inline std::shared_ptr<const MotionModel> uniform_model(const Vec3& displacement_mm) {
  MotionParts parts;
  parts.drivers = {"shift"};
  parts.regions = {{"everywhere", {}}};
  MotionMode mode;
  mode.displacement_mm = displacement_mm;
  parts.modes = {mode};
  return *MotionModel::make(std::move(parts), "uniform test motion");
}

/// A breath of 4 s for that model.
inline MotionDrive sliding_drive() {
  MotionDrive drive;
  drive.period_s = 4.0;
  drive.depth = {1.0, 0.8, 0.0, 0.0};
  return drive;
}

}  // namespace trocar::motion::testing
