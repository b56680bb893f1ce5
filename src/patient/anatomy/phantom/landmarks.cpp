#include "anatomy/phantom/landmarks.h"

#include <cmath>
#include <numbers>
#include <string>

#include "anatomy/phantom/bone.h"

namespace trocar::anatomy::phantom {

std::vector<Landmark> find_landmarks(const Anatomy& anatomy) {
  const auto& contours = anatomy.torso.contours();
  const LandmarkData& data = anatomy.data.landmarks;
  const SpineData& spine = anatomy.data.spine;
  const auto on_skin = [&](float phi, float z) -> Vec3 {
    const double r = contours.skin_radius(phi, z);
    return {r * std::sin(phi), r * std::cos(phi), z};
  };
  constexpr int kT10 = 5;
  constexpr float kFront = std::numbers::pi_v<float>;
  std::vector<Landmark> landmarks{
      {"xiphoid", on_skin(kFront, data.xiphoid_z_mm)},
      {"umbilicus", on_skin(kFront, anatomy.data.torso.umbilicus_z_mm)},
      {"spinous process T12", on_skin(0.0F, spine.height(kT12) - data.t12_spinous_below_mm)},
      {"spinous process L3", on_skin(0.0F, spine.height(kL3) - data.l3_spinous_below_mm)},
      {"right mid-axillary line, tenth rib", on_skin(-0.5F * kFront, spine.height(kT10) - data.tenth_rib_below_t10_mm)}};
  for (Landmark& landmark : landmarks) landmark.p_P *= static_cast<double>(anatomy.scale());
  return landmarks;
}

}  // namespace trocar::anatomy::phantom
