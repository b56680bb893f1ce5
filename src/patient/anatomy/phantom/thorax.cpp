#include <algorithm>
#include <cmath>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

/// Bounds of all structures above the diaphragm.
Box upper_box() {
  Box box = whole_box();
  box.low.z() = -20.0F;
  return box;
}

void add_lungs(Anatomy& anatomy) {
  const std::uint8_t left = anatomy.label("lung_lower_lobe_left");
  const std::uint8_t right = anatomy.label("lung_lower_lobe_right");
  const auto& noise = anatomy.noise;
  anatomy.add({"lung", upper_box(), [](const Place& place) { return std::max(place.cavity + 0.6F, -place.diaphragm); },
               [=, &noise](const Place& place, float distance, const Brush&) {
                 const float vessels = 880.0F * thread(noise, place.p / 17.0F, 0.16F) +
                                       600.0F * thread(noise, place.p / 8.0F + Vec3f(2.0F, 5.0F, 9.0F), 0.12F);
                 const float gravity = 40.0F * smooth_step(-40.0F, 90.0F, place.p.y());
                 const float inner = clamp01(-distance / 6.0F);
                 return Paint{
                     -880.0F + gravity + inner * std::min(vessels, 860.0F) + 14.0F * noise.fractal(place.p, 9.0F),
                     place.p.x() > 0.0F ? left : right};
               }});
}

void add_mediastinum(Anatomy& anatomy) {
  Random random = anatomy.random("heart");
  const auto& noise = anatomy.noise;
  const HeartData& data = anatomy.data.heart;
  const Vec3f heart(data.x_mm.draw(random), data.y_mm, data.z_mm.draw(random));
  const Vec3f heart_radii = data.radii_mm;
  const auto heart_distance = [=](const Place& place) { return ellipsoid(place.q - heart, heart_radii); };
  const std::uint8_t fat = anatomy.label("fat");
  anatomy.add({"mediastinum", upper_box(),
               [=, &around = data.mediastinum](const Place& place) {
                 const float column = elliptic_cylinder(place.q.x() - around.x, place.q.y() - around.y, around.radius_x,
                                                        around.radius_y);
                 const float pericardium = heart_distance(place) - 5.0F;
                 return std::max({smooth_min(column, pericardium, 14.0F), -place.diaphragm, place.cavity + 1.5F});
               },
               [=, &noise](const Place& place, float, const Brush&) {
                 return Paint{-95.0F + 60.0F * thread(noise, place.p / 12.0F, 0.14F), fat};
               }});
  const std::uint8_t heart_label = anatomy.label("heart");
  const Box heart_box = warped(Box::around(heart, heart_radii));
  anatomy.add(
      {"heart", heart_box, [=](const Place& place) { return std::max(heart_distance(place), -place.diaphragm + 2.0F); },
       [=, &noise](const Place& place, float distance, const Brush& brush) {
         const float chamber = brush.cover(distance + 9.0F + 4.0F * noise(place.p / 25.0F));
         const float septum = brush.cover(std::abs(place.q.x() - heart.x() + 0.5F * (place.q.y() - heart.y())) - 5.0F);
         return Paint{mix(112.0F, 158.0F, chamber * (1.0F - septum)), heart_label};
       }});
}

void add_oesophagus(Anatomy& anatomy) {
  const Tube oesophagus(chain(anatomy.data.oesophagus));
  anatomy.add_plain(
      "esophagus", warped(oesophagus.bounds()), [=](const Place& place) { return oesophagus.distance(place.q); }, 62.0F,
      12.0F, 5.0F);
}

}  // namespace

void add_thorax(Anatomy& anatomy) {
  add_lungs(anatomy);
  add_mediastinum(anatomy);
  add_oesophagus(anatomy);
}

}  // namespace trocar::anatomy::phantom
