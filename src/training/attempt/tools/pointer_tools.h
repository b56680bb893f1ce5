#pragma once

#include "anatomy/skin_now.h"
#include "geometry/pose.h"
#include "geometry/shapes.h"

namespace trocar::attempt {

/// Hands moved by mouse, wheel and keys: each gesture is a small change of the hand's target pose. Contains no time;
/// LedPose (tool_motion.h) limits the speed. Frame P.

/// The needle's hand. Its state is the entry E, where the needle's axis meets the skin, the direction d, and
/// the distance of the tip past E. Before the skin (not past E) the entry glides over the skin. In the body the needle
/// only turns about E, because the hole holds it.
class PointerNeedle {
 public:
  static constexpr double kAbove_mm = 20.0;      ///< Distance before the skin at which aiming places the tip.
  static constexpr double kFarthest_mm = 80.0;   ///< Largest distance above the skin.
  static constexpr double kFlattest_rad = 1.35;  ///< Largest angle between needle and the skin's inward normal.

  /// Starts over the entry of a path, along the path. The patient must outlive it.
  PointerNeedle(const anatomy::VirtualPatient& patient, const Segment& path_A, double length_mm);

  /// Where the patient is: the entry, and with it the needle, moves with the skin. Paths are at rest.
  void set_motion(const motion::PatientMotion& motion);

  const Pose& X_PN() const noexcept { return X_PN_; }
  bool is_past_skin() const noexcept { return past_mm_ > 0.0; }
  double past_mm() const noexcept { return past_mm_; }  ///< Distance of the tip past the skin, along the needle.
  const Vec3& entry_P() const noexcept { return entry_P_; }

  void aim_at(const Segment& path_A);
  /// One step towards where aim_at() would put it, over the skin and not through the body: the entry by at most
  /// `most_mm`, the axis by at most `most_rad`. True once there; in the body it stays where it is and returns true.
  bool approach(const Segment& path_A, double most_mm, double most_rad);
  /// Takes over from the needle's pose after another hand moved it.
  void put(const Pose& X_PN);
  /// Shifts the hand (mm): over the skin, or in the body the hub about the entry. `seen_along_P`: unit direction of the
  /// view in which the shift was drawn; the entry then moves by the shift as this view shows it. Zero: no view.
  void glide(const Vec3& shift_P, const Vec3& seen_along_P = Vec3::Zero());
  /// Turns the hub about the entry by `right_rad` towards `right_P` and by `down_rad` towards `down_P` (unit vectors of
  /// a view).
  void tilt(const Vec3& right_P, const Vec3& down_P, double right_rad, double down_rad);
  void turn(double rad);  ///< Turns the needle about its axis: direction of the bevel.
  /// One step of turn(), by at most `most_rad`, until the bevel faces `bevel_P` as far as the axis allows. True once
  /// there.
  bool turn_bevel(const Vec3& bevel_P, double most_rad);
  void push(double mm);  ///< Moves the needle along its axis, inward positive.

 private:
  void lean(const Vec3& axis_P);
  void update();

  const anatomy::VirtualPatient* patient_;
  anatomy::SkinNow skin_;
  double length_mm_;
  Vec3 entry_P_;
  Vec3 axis_P_;  ///< Unit, hub to tip.
  double past_mm_ = -kAbove_mm;
  double roll_rad_ = 0.0;
  Pose X_PN_;
};

/// The transducer's hand. Its state is a point of the skin under the middle of the face, the rotation of the face
/// there, and the depth to which it is pressed in.
class PointerProbe {
 public:
  static constexpr double kDeepest_mm = 12.0;
  static constexpr double kFarthest_mm = 40.0;  ///< Largest distance off the skin.
  static constexpr double kFlattest_rad = 0.9;  ///< Largest angle between beam and the skin's inward normal.

  /// Begins at X_PT; the patient must outlive it.
  PointerProbe(const anatomy::VirtualPatient& patient, const Pose& X_PT);

  /// Where the patient is: the transducer moves with the skin below it.
  void set_motion(const motion::PatientMotion& motion);

  Pose X_PT() const noexcept;
  double pressed_mm() const noexcept { return pressed_mm_; }  ///< Negative: off the skin.

  void put(const Pose& X_PT);
  /// One step over the skin towards a pose, as PointerNeedle::approach. True once there.
  bool approach(const Pose& X_PT, double most_mm, double most_rad);
  /// Moves over the skin, as PointerNeedle::glide does; the face turns with it.
  void glide(const Vec3& shift_P, const Vec3& seen_along_P = Vec3::Zero());
  void tilt(const Vec3& right_P, const Vec3& down_P, double right_rad, double down_rad);
  void turn(double rad);  ///< Turns about the beam: the image plane.
  void push(double mm);

 private:
  const anatomy::VirtualPatient* patient_;
  anatomy::SkinNow skin_;
  Vec3 skin_P_;
  Mat3 R_PT_;
  double pressed_mm_ = 0.0;
};

}  // namespace trocar::attempt
