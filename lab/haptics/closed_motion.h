#pragma once

#include <vector>

#include "geometry/pose.h"

namespace trocar::haptics {

/// Where a prescribed motion is at a time, relative to its start: cubic Hermite curves between the keys.
struct MotionKey {
  double time_s = 0.0;
  Vec3 shift_P = Vec3::Zero();     ///< Translation, mm.
  Vec3 turn_rad_P = Vec3::Zero();  ///< Rotation vector about the pivot.
  Vec3 shift_rate_P = Vec3::Zero();
  Vec3 turn_rate_P = Vec3::Zero();
};

/// A motion of a tool that a hand prescribes, whatever the force, and that ends at the pose where it began (physics.md
/// H8). The tool's frame has its tip at the origin and points along +z. The pivot of the rotations lies `pivot_mm`
/// behind the tip, on the axis, and moves with the translation.
class ClosedMotion {
 public:
  ClosedMotion(const Pose& X_start, double pivot_mm) : X_start_(X_start), pivot_mm_(pivot_mm), keys_(1) {}

  /// Moves straight to a translation and rotation and stops there; the largest speed is 1.5 times `mm_per_s`. A radian
  /// counts as `kReach_mm`.
  void go(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s);
  void wait(double seconds);
  /// As `go`, without a stop: the keys since the last stop form a smooth curve (Catmull-Rom).
  void pass(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s);
  /// Back to the start.
  void close(double mm_per_s) { go(Vec3::Zero(), Vec3::Zero(), mm_per_s); }

  Pose at(double time_s) const noexcept;
  double seconds() const noexcept { return keys_.back().time_s; }
  const Pose& start() const noexcept { return X_start_; }
  const Vec3& shift_P() const noexcept { return keys_.back().shift_P; }
  const Vec3& turn_rad_P() const noexcept { return keys_.back().turn_rad_P; }

  static constexpr double kReach_mm = 100.0;

 private:
  void add(const Vec3& shift_P, const Vec3& turn_rad_P, double mm_per_s);

  Pose X_start_;
  double pivot_mm_;
  std::vector<MotionKey> keys_;
  std::size_t last_stop_ = 0;
};

}  // namespace trocar::haptics
