#pragma once

#include "motion/breathing.h"
#include "motion/motion_model.h"

namespace trocar::motion {

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
  /// The tissue at a point now: where it is at rest. To 1e-5 mm within a region. Where regions that slide past each
  /// other leave a gap or overlap, the border is in the middle of it.
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
  Vec3 within(int region, Vec3 p_A) const noexcept;

  const MotionModel* model_ = nullptr;
  MotionState state_;
  MotionModel::Scalars drives_{};  ///< Drivers against the CT's.
  double slide_mm_ = 0.0;          ///< The regions' displacements differ by no more.
};

/// True if a drive moves a patient that has a model.
inline bool moves(const MotionDrive& drive) noexcept {
  return drive.depth != MotionModel::Scalars{};
}

/// The one clock of a patient's motion. Real-time safe.
struct MotionClock {
  const MotionModel* model = nullptr;  ///< nullptr: the patient does not move.
  MotionDrive drive;                   ///< Without any depth the patient is at rest, as in the CT.

  PatientMotion at(double time_s) const noexcept { return {moves(drive) ? model : nullptr, state_at(drive, time_s)}; }
};

}  // namespace trocar::motion
