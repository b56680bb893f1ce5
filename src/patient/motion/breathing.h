#pragma once

#include <cstdint>

#include "core/result.h"
#include "motion/motion_model.h"

namespace trocar::motion {

/// What drives a patient's motion: the same in every process, in messages and in recordings. With a time it gives the
/// drivers of the model exactly, without any history. Times of the breath hold count from begins_s.
struct MotionDrive {
  static constexpr double kNever_s = -1.0;

  double period_s = 60.0 / 14.0;  ///< Of a breath. Range 1..60. An adult at rest: 14 a minute. [assumed]
  double begins_s = 0.0;          ///< A time at which a breath begins, at end-expiration.
  MotionModel::Scalars depth{};   ///< Value of each driver at end-inspiration. Range kLeastDrive..kMostDrive.
  double pause_share = 0.2;       ///< Part of a breath spent at end-expiration. Range 0..0.6. [assumed]
  /// How much rate, depth and pause vary from breath to breath; 0: not at all. Range 0..0.4.
  double irregularity = 0.0;
  double cough_every_s = 0.0;  ///< Mean time between two coughs; 0: none. Range 0, 5..3600.
  std::uint32_t seed = 1;      ///< Of what varies.
  double first_depth = 1.0;    ///< Of the first breath, in depths. Range 0.3..2.
  double drifted = 0.0;        ///< By which the first driver is off at begins_s; gone after a second. Range -1..1.

  bool is_held = false;     ///< The patient is held at held_phase: for images of one moment.
  double held_phase = 0.0;  ///< 0..1.

  double hold_s = kNever_s;     ///< The patient is asked to hold the breath; negative: is not.
  double release_s = kNever_s;  ///< The patient may breathe again; negative: not yet.
  double hold_limit_s = 20.0;   ///< The patient holds it for no longer; 0: not at all. Range 0..120. [assumed]
  double drift_per_s = 0.0;     ///< By which the first driver drifts while the breath is held. Range -0.1..0.1.

  bool operator==(const MotionDrive&) const = default;
};

/// Error: a number out of its range.
Status check(const MotionDrive& drive);

/// What a motion model needs to tell where the patient is at one moment.
struct MotionState {
  double time_s = 0.0;             ///< Of the clock of MotionDrive.
  double phase = 0.0;              ///< Of the breath, 0..1; 0: end-expiration, 0.5: end-inspiration.
  bool is_breath_held = false;     ///< The patient holds the breath.
  MotionModel::Scalars drivers{};  ///< 0: at end-expiration.
  MotionModel::Scalars rates_per_s{};
};

/// Drivers at a time. In a breath, a driver is depth * sin^2(pi phase), as of Lujan 1999 (doi 10.1118/1.598577), the
/// second one (the chest) ahead of the first: the tissue comes back on another path. Inspiration takes 40 % of the
/// breath without its pause [assumed]. Asked to hold the breath, the patient needs 0.4 to 1.0 s to react [assumed],
/// breathes out and holds it there until it is released or hold_limit_s is over; the breath after a hold that was
/// longer than half of the limit is deeper. A cough comes in the pause of a breath. Real-time safe.
MotionState state_at(const MotionDrive& drive, double time_s) noexcept;
/// Drivers of a regular breath at a phase. Real-time safe.
MotionState state_of_phase(const MotionDrive& drive, double phase, double time_s = 0.0) noexcept;

/// The drive that goes on where this one is at a time, with the patient asked then to hold the breath, or to breathe
/// again. A patient who is holding the breath already, or is not, is not asked anew.
MotionDrive asked_to_hold(const MotionDrive& drive, double time_s) noexcept;
MotionDrive released(const MotionDrive& drive, double time_s) noexcept;

/// How long (s) after MotionDrive::begins_s the patient begins to hold the breath as asked; negative: does not.
double hold_begins_s(const MotionDrive& drive) noexcept;
/// And when the patient breathes again; negative: there is no hold.
double hold_ends_s(const MotionDrive& drive) noexcept;

}  // namespace trocar::motion
