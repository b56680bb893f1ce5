#pragma once

#include "geometry/pose.h"

namespace trocar::anatomy {

/// The way between the patient as he lies there now and the resting anatomy that the volumes show: breathing, and
/// tissue that yields. Forces are found in the resting anatomy, so the tick pulls the tool's pose back and turns the
/// forces forward. Today the patient holds still: both ways are the identity, and `breathing` is kept for the record.
struct RestingAnatomy {
  double breathing = 0.0;  ///< Phase 0..1, 0 = end-expiration.

  /// Pose of a tool now -> the same place in the resting anatomy. Real-time safe.
  Pose pull_back(const Pose& X_PN) const noexcept { return X_PN; }
  /// Vector in the resting anatomy at a point of it -> the same vector now. Real-time safe.
  Vec3 push_forward(const Vec3& /*p_rest_P*/, const Vec3& v_rest_P) const noexcept { return v_rest_P; }
};

}  // namespace trocar::anatomy
