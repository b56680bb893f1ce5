#include "haptics/insertion/skin_contact.h"

#include <algorithm>

#include "volume/sampling.h"

namespace trocar::haptics {

double skin_distance_mm(const PatientNow& now, const Vec3& p_P) noexcept {
  const volume::FloatGrid& distance = now.scene.patient->skin_distance_mm;
  const Vec3 p_A = now.motion.to_rest(p_P);
  const double at_rest_mm = volume::sample_linear(distance, p_A);
  if (now.motion.is_rest()) return at_rest_mm;
  // The unit gradient of the distance at rest, now: how much nearer the skin is now than at rest.
  const Vec3 gradient_A = volume::gradient_per_mm(distance, p_A).stableNormalized();
  const double per_mm = now.motion.gradient_to_now(p_A, gradient_A).norm();
  return per_mm > 0.0 ? at_rest_mm / per_mm : at_rest_mm;
}

Vec3 inward_normal(const PatientNow& now, const Vec3& p_P) noexcept {
  const Vec3 p_A = now.motion.to_rest(p_P);
  const Vec3 gradient_A = volume::gradient_per_mm(now.scene.patient->skin_distance_mm, p_A);
  return -now.motion.gradient_to_now(p_A, gradient_A).stableNormalized();
}

Vec3 nearest_skin(const PatientNow& now, const Vec3& p_P) noexcept {
  constexpr int kSteps = 3;
  Vec3 here_P = p_P;
  for (int i = 0; i < kSteps; ++i) here_P += skin_distance_mm(now, here_P) * inward_normal(now, here_P);
  return here_P;
}

Vec3 meet_skin(const PatientNow& now, const Vec3& outside_P, const Vec3& inside_P) noexcept {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.5 * (low + high);
    (skin_distance_mm(now, outside_P + t * (inside_P - outside_P)) > 0.0 ? low : high) = t;
  }
  return outside_P + low * (inside_P - outside_P);
}

SkinContact begin_contact(const PatientNow& now, const Vec3& anchor_P) noexcept {
  SkinContact contact;
  contact.anchor_P = anchor_P;
  contact.anchor_A = now.motion.to_rest(anchor_P);
  contact.slides_P = now.motion.velocity(contact.anchor_A);
  return contact;
}

void follow_skin(SkinContact& contact, const PatientNow& now, const Vec3& device_tip_P, double friction,
                 double dt_s) noexcept {
  constexpr int kMostSteps = 4;
  constexpr double kOnCone_mm = 1e-9;
  const Vec3 before_P = contact.anchor_P;
  if (!now.motion.is_rest()) contact.anchor_P = now.motion.to_now(contact.anchor_A);
  Vec3 normal_P = inward_normal(now, contact.anchor_P);
  Vec3 way = device_tip_P - contact.anchor_P;
  for (int i = 0; i < kMostSteps; ++i) {
    const double deep_mm = way.dot(normal_P);
    const Vec3 beside = way - deep_mm * normal_P;
    const double beyond_mm = beside.norm() - friction * std::max(0.0, deep_mm);
    if (!(beyond_mm > kOnCone_mm)) break;
    contact.anchor_P = nearest_skin(now, contact.anchor_P + beyond_mm * beside.normalized());
    normal_P = inward_normal(now, contact.anchor_P);
    way = device_tip_P - contact.anchor_P;
  }
  contact.anchor_A = now.motion.to_rest(contact.anchor_P);
  contact.slides_P += dt_s / (dt_s + kVelocitySmoothing_s) * ((contact.anchor_P - before_P) / dt_s - contact.slides_P);
  const double deep_mm = way.dot(normal_P);
  contact.to_device_mm = deep_mm > 0.0 ? way.norm() : deep_mm;
  contact.way_P = deep_mm > 0.0 ? Vec3(way.stableNormalized()) : normal_P;
}

double piercing_share(const SkinContact& contact, const PatientNow& now, const Vec3& axis_P) noexcept {
  const double share = axis_P.dot(contact.way_P);
  return share > kGrazing && axis_P.dot(inward_normal(now, contact.anchor_P)) > kGrazing ? share : 0.0;
}

}  // namespace trocar::haptics
