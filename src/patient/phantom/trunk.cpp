#include <algorithm>
#include <array>
#include <cmath>

#include "phantom/skeleton.h"
#include "phantom/structure.h"

namespace trocar::phantom {
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

namespace {

/// The border of the iliac wing: height (mm) by the angle from the back's midline (deg). The crest is highest at the
/// level of L4; it ends behind at the posterior superior iliac spine and in front at the anterior one.
constexpr std::array<std::array<float, 2>, 8> kCrest{{{34.0F, -168.0F},
                                                      {40.0F, -148.0F},
                                                      {54.0F, -118.0F},
                                                      {74.0F, -99.0F},
                                                      {90.0F, -101.0F},
                                                      {104.0F, -122.0F},
                                                      {112.0F, -146.0F},
                                                      {114.0F, -172.0F}}};
constexpr float kWingBottom = -226.0F;
constexpr float kOutwardMm = 17.0F;  ///< From the pelvic cavity, with the iliacus between.

const Vec3f kHip(89.0F, -2.0F, -224.0F);  ///< Middle of the left femur's head.
constexpr float kHeadMm = 23.5F, kSocketMm = 27.0F;

float crest_height(float side_deg) {
  if (side_deg <= kCrest.front()[0]) return kCrest.front()[1];
  for (std::size_t n = 1; n < kCrest.size(); ++n)
    if (side_deg < kCrest[n][0])
      return mix(kCrest[n - 1][1], kCrest[n][1],
                 smooth_step(0.0F, 1.0F, (side_deg - kCrest[n - 1][0]) / (kCrest[n][0] - kCrest[n - 1][0])));
  return kCrest.back()[1];
}

/// A sheet along the wall of the pelvic cavity, thick at the crest and towards the hip joint and the sacrum.
float iliac_wing(const Place& place) {
  const Vec3f& p = place.p;
  const float side_deg = std::atan2(std::abs(p.x()), p.y()) / kDegree;
  const float radius = std::hypot(p.x(), p.y());
  const float top = crest_height(side_deg);
  const float below_crest = top - p.z();
  const float to_joint = smooth_step(-178.0F, -220.0F, p.z());
  const float to_sacrum = smooth_step(62.0F, 38.0F, side_deg);
  const float half = 2.6F + 3.4F * std::exp(-std::max(below_crest, 0.0F) / 9.0F) + 6.5F * to_joint + 4.5F * to_sacrum;
  // Towards the hip the wing turns inwards less than the cavity.
  const float sheet = std::abs(place.cavity - kOutwardMm - 4.0F * to_joint + 8.0F * to_sacrum) - half;
  const float back_end = mix(35.0F, 58.0F, smooth_step(-172.0F, -205.0F, p.z()));  // the greater sciatic notch
  const float front_end = mix(114.0F, 101.0F, smooth_step(-150.0F, -200.0F, p.z()));
  const float ends = std::max(back_end - side_deg, side_deg - front_end) * kDegree * radius;
  return smooth_max(smooth_max(sheet, 0.75F * -below_crest, 4.0F), std::max(ends, kWingBottom - p.z()), 5.0F);
}

/// Pubis and ischium.
Tube lower_bones(float sign) {
  const auto at = [sign](float x, float y, float z) { return Vec3f(sign * x, y, z); };
  return Tube({{at(76, -20, -216), at(48, -46, -230), 9.0F, 6.5F},
               {at(48, -46, -230), at(12, -62, -246), 6.5F, 8.5F},
               {at(12, -62, -246), at(10, -60, -268), 9.0F, 7.5F},
               {at(90, 22, -226), at(80, 32, -262), 13.0F, 13.0F},
               {at(80, 32, -262), at(62, 26, -292), 14.0F, 14.0F},
               {at(10, -60, -268), at(40, -20, -292), 6.5F, 7.0F}});
}

Tube femur(float sign) {
  const Vec3f hip(sign * kHip.x(), kHip.y(), kHip.z());
  const auto from_hip = [&](float x, float y, float z) -> Vec3f { return hip + Vec3f(sign * x, y, z); };
  return Tube({{hip, hip, kHeadMm, kHeadMm},
               {from_hip(10, 2, -6), from_hip(38, 8, -26), 15.0F, 15.0F},
               {from_hip(46, 16, -10), from_hip(44, 12, -40), 13.0F, 17.0F},
               {from_hip(44, 10, -40), from_hip(40, 4, -80), 17.0F, 15.0F}});
}

void add_side(Anatomy& anatomy, float sign) {
  const auto& noise = anatomy.noise;
  const float density = marrow_share(anatomy.body);
  const Vec3f hip(sign * kHip.x(), kHip.y(), kHip.z());
  const Tube lower = lower_bones(sign);
  const std::uint8_t hip_label = anatomy.label("hip" + side_of(sign));
  Box half = whole_box();
  (sign < 0.0F ? half.high : half.low).x() = 0.0F;
  half.high.z() = -85.0F;
  anatomy.add({"hip" + side_of(sign), half,
               [=](const Place& place) {
                 const float head = (place.p - hip).norm();
                 const float socket = std::max(head - kSocketMm - 6.0F, 0.6F * (place.p.x() - hip.x()) * sign - 6.0F);
                 const float solid =
                     smooth_min(iliac_wing(place), smooth_min(lower.distance(place.p), socket, 6.0F), 7.0F);
                 return smooth_max(solid, kHeadMm + 2.6F - head, 2.0F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float marrow = density * 150.0F + 60.0F * noise(place.p / 4.0F);
                 return bone(distance, 1.7F, 780.0F, marrow, hip_label, brush);
               }});
  const Tube thigh = femur(sign);
  const std::uint8_t femur_label = anatomy.label("femur" + side_of(sign));
  anatomy.add({"femur" + side_of(sign), thigh.bounds(), [=](const Place& place) { return thigh.distance(place.p); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float marrow = density * 220.0F + 70.0F * noise(place.p / 4.0F);
                 return bone(distance, 2.2F, 950.0F, marrow, femur_label, brush);
               }});
}

}  // namespace

void add_pelvis(Anatomy& anatomy) {
  if (anatomy.torso.box().low.z() > -120.0F) return;
  add_side(anatomy, -1.0F);
  add_side(anatomy, 1.0F);
}

namespace {

constexpr float kUrineHu = 6.0F, kBladderWallHu = 55.0F, kUterusHu = 96.0F;
constexpr float kBladderWallMm = 3.0F;

void add_bladder(Anatomy& anatomy) {
  Random random = anatomy.random("bladder");
  const BladderData& data = anatomy.data.bladder;
  const Vec3f radii = data.radii_mm * data.size.draw(random);
  const std::uint8_t label = anatomy.label("urinary_bladder");
  const auto& noise = anatomy.noise;
  anatomy.add({"urinary_bladder", warped(Box::around(data.centre, radii)),
               [=, &noise](const Place& place) {
                 const float bag = ellipsoid(place.q - data.centre, radii) + 1.5F * noise(place.p / 25.0F);
                 return smooth_max(bag, place.cavity + 5.0F, 6.0F);
               },
               [=](const Place&, float distance, const Brush& brush) {
                 return Paint{mix(kBladderWallHu, kUrineHu, brush.cover(distance + kBladderWallMm)), label};
               }});
}

void add_uterus(Anatomy& anatomy) {
  Random random = anatomy.random("uterus");
  const UterusData& data = anatomy.data.uterus;
  const Vec3f centre = varied(random, data.centre, data.spread_mm);
  const auto& noise = anatomy.noise;
  const auto bladder = anatomy.find("urinary_bladder").distance;
  anatomy.add_plain(
      "uterus", warped(Box::around(centre, data.radii_mm)),
      [=, &noise](const Place& place) {
        const Vec3f u = place.q - centre;
        // The fundus leans forwards over the bladder.
        const Vec3f leaning(u.x(), u.y() + 0.45F * u.z(), u.z());
        const float bulk = ellipsoid(leaning, data.radii_mm) + 1.5F * noise(place.p / 16.0F);
        return smooth_max(bulk, 2.0F - bladder(place), 3.0F);
      },
      kUterusHu, 8.0F, 8.0F);
}

}  // namespace

void add_pelvic_organs(Anatomy& anatomy) {
  add_bladder(anatomy);
  if (anatomy.body.sex == Sex::kFemale) add_uterus(anatomy);
}

}  // namespace trocar::phantom
