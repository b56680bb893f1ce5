#pragma once

#include "haptics/haptic_scene.h"
#include "motion/patient_motion.h"

namespace trocar::haptics {

/// The patient at rest.
inline const motion::PatientMotion kAtRest{};

/// The patient as a tick sees it: constant data in the anatomy at rest (frame A), and where it is now (frame P). Forces
/// and distances of the laws are in P; tissue is looked up in A. A scene alone: the patient at rest.
struct PatientNow {
  const HapticScene& scene;
  const motion::PatientMotion& motion;

  PatientNow(const HapticScene& the_scene, const motion::PatientMotion& the_motion = kAtRest) noexcept
      : scene(the_scene), motion(the_motion) {}
};

}  // namespace trocar::haptics
