#include <algorithm>
#include <cmath>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kFatHu = -102.0F;
constexpr float kMuscleHu = 58.0F;
constexpr float kSkinHu = 55.0F;
constexpr float kSkinMm = 2.0F;
/// Thickness of the diaphragm's costal part and the transversus around the cavity.
constexpr float kLiningMm = 2.2F;

/// 1 on a curved sheet at the zero of the noise, decreasing to 0 within about `thickness` of a cell.
float sheet(const ValueNoise& noise, const Vec3f& cell, float thickness) {
  const float n = noise(cell);
  return std::max(0.0F, 1.0F - std::abs(n) / thickness);
}

void add_subcutaneous_fat(Anatomy& anatomy) {
  const std::uint8_t fat = anatomy.label("fat");
  const auto& noise = anatomy.noise;
  anatomy.add({"body", whole_box(), [](const Place& place) { return place.skin; },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const Vec3f stretched = place.p.cwiseQuotient(Vec3f(15.0F, 13.0F, 24.0F));
                 const float septa =
                     26.0F * sheet(noise, stretched, 0.055F) + 70.0F * thread(noise, place.p / 19.0F, 0.10F);
                 const float tissue = kFatHu + septa + 5.0F * noise.fractal(place.p, 20.0F);
                 return Paint{mix(kSkinHu, tissue, brush.cover(distance + kSkinMm)), fat};
               }});
}

/// Position in the wall: the layers of the flank, the rectus in front, the chest's muscles above.
struct WallPlace {
  float depth;      ///< 0 at the wall's outer surface, 1 at the cavity.
  float thickness;  ///< mm.
  float side;       ///< Angle from the back's midline, rad.
};

WallPlace wall_place(const Place& place) {
  const float outer = std::max(-place.wall, 0.0F);
  const float inner = std::max(place.cavity + kLiningMm, 0.0F);
  return {outer / std::max(outer + inner, 0.1F), outer + inner, std::atan2(std::abs(place.p.x()), place.p.y())};
}

/// Distance (mm, negative inside) to the fat between the muscles of the wall.
float fat_planes(const Place& place, const ValueNoise& noise) {
  const WallPlace at = wall_place(place);
  const float wobble = 0.05F * noise(place.p / 28.0F);
  const float chest = smooth_step(-5.0F, 45.0F, place.p.z());
  const float flank = smooth_step(48.0F * kDegree, 66.0F * kDegree, at.side) *
                      (1.0F - smooth_step(138.0F * kDegree, 150.0F * kDegree, at.side));
  const auto plane = [&](float depth, float half_mm) {
    return std::abs(at.depth - depth - wobble) * at.thickness - half_mm;
  };
  // Outer oblique (above: latissimus, serratus) | inner oblique | transversus.
  float d = plane(mix(0.36F, 0.40F, chest), 0.75F * flank);
  d = std::min(d, plane(0.70F, 0.55F * flank * (1.0F - chest)));
  if (flank < 0.05F) d = 1.0F;
  // Linea semilunaris next to the rectus, and its sheath's fat behind it.
  const float x = std::abs(place.p.x());
  const float front = smooth_step(120.0F * kDegree, 128.0F * kDegree, at.side);
  if (front > 0.5F) {
    const float semilunaris = std::abs(x - 62.0F - 6.0F * (at.depth - 0.5F)) - 1.6F;
    d = std::min(d, std::max(semilunaris, place.p.z() - 60.0F));
    d = std::min(d, std::max(plane(0.93F, 0.5F), x - 58.0F));
  }
  return d;
}

void add_wall(Anatomy& anatomy) {
  const std::uint8_t muscle = anatomy.label("muscle");
  const std::uint8_t fat = anatomy.label("fat");
  const auto& noise = anatomy.noise;
  anatomy.add({"wall", whole_box(), [](const Place& place) { return place.wall; },
               [=, &noise](const Place& place, float, const Brush& brush) {
                 const float fibres = 10.0F * noise(place.p.cwiseQuotient(Vec3f(5.0F, 4.0F, 14.0F)));
                 const float marbling =
                     -45.0F * thread(noise, place.p.cwiseQuotient(Vec3f(13.0F, 10.0F, 22.0F)), 0.16F);
                 const float planes = fat_planes(place, noise);
                 const float hu = mix(kMuscleHu + fibres + marbling, kFatHu + 14.0F, brush.cover(planes));
                 return Paint{hu, planes < 0.0F ? fat : muscle};
               }});
  // The linea alba is tendon between the two recti.
  anatomy.add({"linea_alba", Box{Vec3f(-14.0F, -250.0F, -255.0F), Vec3f(14.0F, -50.0F, 88.0F)},
               [](const Place& place) {
                 return std::max({std::abs(place.p.x()) - 4.5F - 0.02F * std::max(place.p.z() + 114.0F, -100.0F),
                                  place.wall + 2.5F, -(place.cavity + kLiningMm) + 1.5F});
               },
               [=](const Place& place, float, const Brush& brush) {
                 const float middle = std::abs(place.wall + 5.0F) - 1.4F;
                 return Paint{mix(kFatHu, 45.0F, brush.cover(middle)), fat};
               }});
}

void add_cavity(Anatomy& anatomy) {
  const std::uint8_t fat = anatomy.label("fat");
  const auto& noise = anatomy.noise;
  anatomy.add({"cavity", whole_box(), [](const Place& place) { return place.cavity + kLiningMm; },
               [=, &noise](const Place& place, float, const Brush&) {
                 const float vessels = 150.0F * thread(noise, place.p / 17.0F, 0.15F) +
                                       90.0F * thread(noise, place.p / 9.0F + Vec3f(3.0F, 7.0F, 1.0F), 0.13F);
                 return Paint{kFatHu + 6.0F + std::min(vessels, 190.0F) + 6.0F * noise.fractal(place.p, 16.0F), fat};
               }});
}

void add_diaphragm(Anatomy& anatomy) {
  anatomy.add_plain(
      "muscle", whole_box(),
      [](const Place& place) { return std::max(place.cavity + 0.5F, std::abs(place.diaphragm + 1.4F) - 1.4F); },
      kMuscleHu);
}

}  // namespace

void add_trunk(Anatomy& anatomy) {
  add_subcutaneous_fat(anatomy);
  add_wall(anatomy);
  add_cavity(anatomy);
  add_diaphragm(anatomy);
}

}  // namespace trocar::anatomy::phantom
