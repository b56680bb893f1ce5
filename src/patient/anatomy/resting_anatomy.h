#pragma once

#include "geometry/pose.h"

namespace trocar::anatomy {

/// Transform between the patient's present state (breathing, deformation) and the resting anatomy of the volumes.
/// Forces are computed in the resting anatomy: the tick transforms the tool's pose there and the forces back. Today
/// both transforms are the identity; `breathing` is recorded.
struct RestingAnatomy {
  double breathing = 0.0;  ///< Phase 0..1, 0 = end-expiration.

  /// Transforms a tool's present pose to the resting anatomy. Real-time safe.
  Pose pull_back(const Pose& X_PN) const noexcept { return X_PN; }
  /// Vector in the resting anatomy at a point of it -> the same vector now. Real-time safe.
  Vec3 push_forward(const Vec3& /*p_rest_P*/, const Vec3& v_rest_P) const noexcept { return v_rest_P; }
};

}  // namespace trocar::anatomy
