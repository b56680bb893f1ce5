#pragma once

#include "haptics/patient_now.h"

namespace trocar::haptics {

/// A needle flatter to the skin than this does not pierce it: cosine of 80 degrees to the normal.
inline constexpr double kGrazing = 0.17;

/// Signed distance (mm, in P, also where motion compresses the tissue) to the undented skin, negative inside the body,
/// and the unit normal into the body. Real-time safe.
double skin_distance_mm(const PatientNow& now, const Vec3& p_P) noexcept;
Vec3 inward_normal(const PatientNow& now, const Vec3& p_P) noexcept;
/// The point of the undented skin nearest to a point close to it. Real-time safe.
Vec3 nearest_skin(const PatientNow& now, const Vec3& p_P) noexcept;
/// Where the way from a point outside the body to one inside meets the skin. Real-time safe.
Vec3 meet_skin(const PatientNow& now, const Vec3& outside_P, const Vec3& inside_P) noexcept;

/// The tip on unpierced skin (physics.md V2): the point of the undented skin that it holds, and the way from there to
/// the device's tip. The force is along that way and depends on its length alone, one energy; the point slides on the
/// skin where the force leaves the cone of friction, which only dissipates.
struct SkinContact {
  Vec3 anchor_P = Vec3::Zero();  ///< On the undented skin.
  Vec3 anchor_A = Vec3::Zero();  ///< The same point at rest; used where the patient moves.
  Vec3 way_P = Vec3::UnitZ();    ///< Unit, from there to the device's tip; into the body.
  double to_device_mm = 0.0;     ///< Length of that way; negative: the device's tip is that far outside the skin.
  Vec3 slides_P = Vec3::Zero();  ///< Velocity of that point, mm/s, smoothed like the device's; with the patient's.
};

/// Velocities of the device are smoothed so long against the ripple of encoder counts. [assumed]
inline constexpr double kVelocitySmoothing_s = 0.002;

/// Begins a contact at a point of the undented skin. Real-time safe.
SkinContact begin_contact(const PatientNow& now, const Vec3& anchor_P) noexcept;

/// Follows the device's tip for a tick, with the coefficient of friction `friction`. Real-time safe.
void follow_skin(SkinContact& contact, const PatientNow& now, const Vec3& device_tip_P, double friction,
                 double dt_s) noexcept;

/// Share of a force along the contact's way that pushes a needle with this unit axis along its axis: its cosine; 0 for
/// a needle that is flat on the skin or pushed sideways, which does not pierce.
double piercing_share(const SkinContact& contact, const PatientNow& now, const Vec3& axis_P) noexcept;

}  // namespace trocar::haptics
