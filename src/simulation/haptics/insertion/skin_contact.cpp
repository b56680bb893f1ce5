#include "haptics/insertion/skin_contact.h"

#include <algorithm>

#include "volume/sampling.h"

namespace trocar::haptics {

double skin_distance_mm(const HapticScene& scene, const Vec3& p_P) noexcept {
  return volume::sample_linear(scene.patient->skin_distance_mm, p_P);
}

Vec3 inward_normal(const HapticScene& scene, const Vec3& p_P) noexcept {
  return -volume::gradient_per_mm(scene.patient->skin_distance_mm, p_P).stableNormalized();
}

Vec3 nearest_skin(const HapticScene& scene, const Vec3& p_P) noexcept {
  constexpr int kSteps = 3;
  Vec3 here_P = p_P;
  for (int i = 0; i < kSteps; ++i) here_P += skin_distance_mm(scene, here_P) * inward_normal(scene, here_P);
  return here_P;
}

Vec3 meet_skin(const HapticScene& scene, const Vec3& outside_P, const Vec3& inside_P) noexcept {
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.5 * (low + high);
    (skin_distance_mm(scene, outside_P + t * (inside_P - outside_P)) > 0.0 ? low : high) = t;
  }
  return outside_P + low * (inside_P - outside_P);
}

void follow_skin(SkinContact& contact, const HapticScene& scene, const Vec3& device_tip_P, double friction,
                 double dt_s) noexcept {
  constexpr int kMostSteps = 4;
  constexpr double kOnCone_mm = 1e-9;
  Vec3 normal_P = inward_normal(scene, contact.anchor_P);
  Vec3 way = device_tip_P - contact.anchor_P;
  const Vec3 before_P = contact.anchor_P;
  for (int i = 0; i < kMostSteps; ++i) {
    const double deep_mm = way.dot(normal_P);
    const Vec3 beside = way - deep_mm * normal_P;
    const double beyond_mm = beside.norm() - friction * std::max(0.0, deep_mm);
    if (!(beyond_mm > kOnCone_mm)) break;
    contact.anchor_P = nearest_skin(scene, contact.anchor_P + beyond_mm * beside.normalized());
    normal_P = inward_normal(scene, contact.anchor_P);
    way = device_tip_P - contact.anchor_P;
  }
  contact.slides_P += dt_s / (dt_s + kVelocitySmoothing_s) * ((contact.anchor_P - before_P) / dt_s - contact.slides_P);
  const double deep_mm = way.dot(normal_P);
  contact.to_device_mm = deep_mm > 0.0 ? way.norm() : deep_mm;
  contact.way_P = deep_mm > 0.0 ? Vec3(way.stableNormalized()) : normal_P;
}

double piercing_share(const SkinContact& contact, const HapticScene& scene, const Vec3& axis_P) noexcept {
  const double share = axis_P.dot(contact.way_P);
  return share > kGrazing && axis_P.dot(inward_normal(scene, contact.anchor_P)) > kGrazing ? share : 0.0;
}

}  // namespace trocar::haptics
