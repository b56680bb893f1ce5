#pragma once

#include "geometry/vec.h"

namespace trocar::testing {

/// A mass moved by the motors and damped by a loose hand, in the vendor's axes.
struct SimulatedArm {
  Vec3 p_mm = Vec3::Zero();
  Vec3 v_mm_per_s = Vec3::Zero();
  Mat3 R = Mat3::Identity();
  Vec3 force_n = Vec3::Zero();     ///< Force of the motors.
  Vec3 torque_nmm = Vec3::Zero();  ///< Torque of the motors.

  void advance(double dt_s) {
    constexpr double kMass_kg = 0.1;
    constexpr double kHand_ns_per_mm = 0.01;  // without it, the mass becomes too fast within 0.1 s
    constexpr double kMmPerM = 1000.0;
    v_mm_per_s += kMmPerM / kMass_kg * (force_n - kHand_ns_per_mm * v_mm_per_s) * dt_s;
    p_mm += v_mm_per_s * dt_s;
  }
};

}  // namespace trocar::testing
