#pragma once

#include "motion/patient_motion.h"

namespace trocar::motion {

/// What drives a patient's motion: the same in every process, in messages and in recordings. With a model and a time it
/// gives the motion exactly.
struct MotionDrive {
  double period_s = 4.0;         ///< Of a breath. Range 1..60.
  double begins_s = 0.0;         ///< A time at which a breath begins, at end-expiration.
  bool is_held = false;          ///< The breath is held at held_phase.
  double held_phase = 0.0;       ///< 0..1.
  MotionModel::Scalars depth{};  ///< Value of each driver at end-inspiration. Range -kMostDrive..kMostDrive.

  bool operator==(const MotionDrive&) const = default;
};

/// Error: a number out of its range.
Status check(const MotionDrive& drive);

/// The motion at a time: each driver is depth * (1 - cos(2 pi phase)) / 2. Real-time safe.
MotionState state_at(const MotionDrive& drive, double time_s) noexcept;

/// The one clock of a patient's motion. Real-time safe.
struct MotionClock {
  const MotionModel* model = nullptr;  ///< nullptr: the patient does not move.
  MotionDrive drive;

  PatientMotion at(double time_s) const noexcept {
    return model == nullptr ? PatientMotion() : PatientMotion(model, state_at(drive, time_s));
  }
};

}  // namespace trocar::motion
