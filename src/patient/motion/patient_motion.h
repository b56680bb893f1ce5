#pragma once

#include "motion/motion_model.h"

namespace trocar::motion {

/// What a motion model needs to tell where the patient is at one moment.
struct MotionState {
  double time_s = 0.0;  ///< Of the motion's clock (MotionDrive).
  double phase = 0.0;   ///< Of the breath, 0..1; 0: end-expiration.
  MotionModel::Scalars drivers{};
  MotionModel::Scalars rates_per_s{};
};

/// Where the patient is at one moment: the map between frame A (the anatomy at rest, as in the CT) and frame P (the
/// patient now). An immutable value, made once by the clock (MotionDrive) and taken by everything that looks at the
/// patient: forces, images, surfaces, scores. Without a model both frames are the same. The model belongs to the
/// patient (anatomy::VirtualPatient::motion) and outlives the value. All functions are real-time safe.
class PatientMotion {
 public:
  PatientMotion() = default;  ///< At rest: both frames are the same.
  PatientMotion(const MotionModel* model, const MotionState& state) noexcept;

  /// True if the frames are the same because the patient has no model; it breathes all the same (phase()). A patient
  /// that holds its breath has a model.
  bool is_rest() const noexcept { return model_ == nullptr; }
  double time_s() const noexcept { return state_.time_s; }
  double phase() const noexcept { return state_.phase; }
  const MotionState& state() const noexcept { return state_; }
  const MotionModel* model() const noexcept { return model_; }

  /// A point of the tissue: where it is now.
  Vec3 to_now(const Vec3& p_A) const noexcept { return model_ == nullptr ? p_A : moved(p_A); }
  /// The tissue at a point now: where it is at rest. To 1e-6 mm within a region. Where regions that slide past each
  /// other leave a gap or overlap, the region that is nearest, or listed first, has the point.
  Vec3 to_rest(const Vec3& p_P) const noexcept { return model_ == nullptr ? p_P : resting(p_P); }
  /// Region of the tissue at rest; 0 without a model.
  int region(const Vec3& p_A) const noexcept { return model_ == nullptr ? 0 : model_->region_of(p_A); }
  /// d to_now / d p_A, determinant > 0.
  Mat3 jacobian(const Vec3& p_A) const noexcept;
  /// Both at once.
  struct Moved {
    Vec3 p_P;
    Mat3 jacobian;
  };
  Moved moved_with_jacobian(const Vec3& p_A) const noexcept;
  /// Velocity in P (mm/s) of the tissue that rests at p_A.
  Vec3 velocity(const Vec3& p_A) const noexcept;

  /// No point of the tissue is further (mm) from its place in another motion; infinite if the models differ.
  double most_shift_mm(const PatientMotion& other) const noexcept;

  bool is_same_place(const PatientMotion& other) const noexcept {
    return model_ == other.model_ && (model_ == nullptr || state_.drivers == other.state_.drivers);
  }
  /// False for a state with a number that is not finite.
  bool is_finite() const noexcept;

  /// A small material line (a direction along tissue) at p_A, now: J v.
  Vec3 line_to_now(const Vec3& p_A, const Vec3& v_A) const noexcept;
  Vec3 line_to_rest(const Vec3& p_A, const Vec3& v_P) const noexcept;
  /// A gradient or a force that is conjugate to motion in A, now: J^-T g. Work is the same in both frames.
  Vec3 gradient_to_now(const Vec3& p_A, const Vec3& g_A) const noexcept;

 private:
  Vec3 moved(const Vec3& p_A) const noexcept;
  Vec3 resting(const Vec3& p_P) const noexcept;
  Vec3 resting_in(int region, const Vec3& p_P) const noexcept;

  const MotionModel* model_ = nullptr;
  MotionState state_;
};

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
