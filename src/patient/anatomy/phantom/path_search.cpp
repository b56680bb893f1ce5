#include "anatomy/phantom/path_search.h"

#include <algorithm>
#include <array>

namespace trocar::anatomy::phantom {

Obstacles::Obstacles(const Anatomy& anatomy, std::span<const std::string_view> prefixes) {
  for (const Structure& s : anatomy.structures)
    if (std::any_of(prefixes.begin(), prefixes.end(), [&](std::string_view p) { return s.name.starts_with(p); }))
      structures_.push_back(&s);
}

bool Obstacles::all_farther(const Place& place, float mm) const {
  const Box reach = Box::around(place.p, Vec3f::Constant(mm));
  return std::all_of(structures_.begin(), structures_.end(),
                     [&](const Structure* s) { return !s->bounds.overlaps(reach) || s->distance(place) > mm; });
}

Obstacles bones_of(const Anatomy& anatomy) {
  static constexpr std::array<std::string_view, 7> kBones{"rib_", "vertebrae", "costal_cartilages", "sternum", "sacrum",
                                                          "hip_", "femur_"};
  return {anatomy, kBones};
}

Vec3f leave_body(const Anatomy& anatomy, const Vec3f& inside, const Vec3f& direction) {
  constexpr float kFarthest = 330.0F;
  float low = 0.0F;
  float high = kFarthest;
  for (int n = 0; n < 40; ++n) {
    const float middle = 0.5F * (low + high);
    (anatomy.torso.at(inside + middle * direction).skin < 0.0F ? low : high) = middle;
  }
  return inside + low * direction;
}

}  // namespace trocar::anatomy::phantom
