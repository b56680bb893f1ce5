#pragma once

#include "motion/patient_motion.h"

namespace trocar::motion {

/// What drives a patient's motion: the same in every process, in messages and in recordings. With a model and a time it
/// gives the motion exactly.
struct MotionDrive {
  double period_s = 60.0 / 14.0;  ///< Of a breath. Range 1..60. An adult at rest: 14 a minute. [assumed]
  double begins_s = 0.0;          ///< A time at which a breath begins, at end-expiration.
  bool is_held = false;           ///< The breath is held at held_phase.
  double held_phase = 0.0;        ///< 0..1.
  MotionModel::Scalars depth{};   ///< Value of each driver at end-inspiration. Range -kMostDrive..kMostDrive.

  bool operator==(const MotionDrive&) const = default;
};

/// Error: a number out of its range.
Status check(const MotionDrive& drive);

/// Phase of the breath at a time, 0..1. Real-time safe.
double phase_at(const MotionDrive& drive, double time_s) noexcept;
/// The motion at a phase: each driver is depth * (1 - cos(2 pi phase)) / 2. Recordings contain the phase of every tick:
/// with the drive it restores the motion to the bit. `time_s` is only noted. Real-time safe.
MotionState state_of_phase(const MotionDrive& drive, double phase, double time_s = 0.0) noexcept;
inline MotionState state_at(const MotionDrive& drive, double time_s) noexcept {
  return state_of_phase(drive, phase_at(drive, time_s), time_s);
}

/// The one clock of a patient's motion. Real-time safe.
struct MotionClock {
  const MotionModel* model = nullptr;  ///< nullptr: the patient does not move.
  MotionDrive drive;

  PatientMotion at(double time_s) const noexcept { return {model, state_at(drive, time_s)}; }
};

}  // namespace trocar::motion
