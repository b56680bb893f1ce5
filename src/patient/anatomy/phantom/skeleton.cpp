#include "anatomy/phantom/skeleton.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kDegree = kPi / 180.0F;

// A rib follows the chest wall, just outside the cavity, and descends from its vertebra to the front.
constexpr float kRibOutwardMm = 6.3F;
constexpr float kRibHalfThicknessMm = 3.2F;
constexpr float kRibHalfHeightMm = 6.2F;
constexpr float kRibBeginDeg = 33.0F;
constexpr std::array<float, 8> kRibEndDeg{140.0F, 136.0F, 131.0F, 126.0F, 119.0F, 110.0F, 98.0F, 50.0F};  // 5..12

float rib_drop(float side_deg) {
  return 80.0F * std::pow(side_deg / 90.0F, 1.25F) - 6.0F;
}

float rib_height(int rib, float side_deg) {
  return vertebra_height(rib - 5) - rib_drop(side_deg);
}

struct RibHit {
  int rib;
  float distance;
};

RibHit nearest_rib(const Place& place) {
  const float side_deg = std::atan2(std::abs(place.p.x()), place.p.y()) / kDegree;
  const float level = place.p.z() + rib_drop(side_deg);
  int best = 5;
  for (int rib = 6; rib <= 12; ++rib)
    if (std::abs(level - vertebra_height(rib - 5)) < std::abs(level - vertebra_height(best - 5))) best = rib;
  const float off = std::abs(level - vertebra_height(best - 5)) * 0.88F;  // the rib is oblique: perpendicular to it
  const float along = std::max(off - kRibHalfHeightMm + kRibHalfThicknessMm, 0.0F);
  const float swept = std::hypot(along, place.cavity - kRibOutwardMm) - kRibHalfThicknessMm;
  const float radius = std::hypot(place.p.x(), place.p.y());
  const float end = (side_deg - kRibEndDeg[static_cast<std::size_t>(best - 5)]) * kDegree * radius;
  const float begin = (kRibBeginDeg - side_deg) * kDegree * radius;
  return {best, smooth_max(swept, std::max(end, begin), 3.0F)};
}

/// Bone: a dense shell around marrow.
Paint bone(float distance, float cortex_mm, float cortex_hu, float marrow_hu, std::uint8_t label, const Brush& brush) {
  return {mix(cortex_hu, marrow_hu, brush.cover(distance + cortex_mm)), label};
}

void add_ribs(Anatomy& anatomy) {
  std::array<std::array<std::uint8_t, 8>, 2> labels;
  for (int rib = 5; rib <= 12; ++rib)
    for (std::size_t side = 0; side < 2; ++side)
      labels[side][static_cast<std::size_t>(rib - 5)] =
          anatomy.label((side == 0 ? "rib_right_" : "rib_left_") + std::to_string(rib));

  const auto& noise = anatomy.noise;
  anatomy.add({"rib_cage", whole_box(), [](const Place& place) { return nearest_rib(place).distance; },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const auto rib = static_cast<std::size_t>(nearest_rib(place).rib - 5);
                 return bone(distance, 1.3F, 820.0F, 210.0F + 60.0F * noise(place.p / 4.0F),
                             labels[place.p.x() > 0.0F ? 1 : 0][rib], brush);
               }});
  // Necks: from the side of the vertebra back and out to the angle of the rib.
  for (int rib = 9; rib <= 12; ++rib)
    for (std::size_t side = 0; side < 2; ++side) {
      const float sign = side == 0 ? -1.0F : 1.0F;
      const float z = vertebra_height(rib - 5);
      const float begin = (kRibBeginDeg + 1.5F) * kDegree;
      const Vec3f angle =
          anatomy.torso.contours().on_cavity(sign * begin, rib_height(rib, kRibBeginDeg + 1.5F), kRibOutwardMm);
      const Vec3f head(sign * 19.0F, spine_y(z) + 11.0F, z + 6.0F);
      const Vec3f tubercle(sign * 30.0F, mix(head.y(), angle.y(), 0.62F), z + 1.0F);
      const Tube neck(chain({{head, 5.0F}, {tubercle, 4.2F}, {angle, 4.0F}}));
      const std::uint8_t label = labels[side][static_cast<std::size_t>(rib - 5)];
      anatomy.add({"rib_neck", neck.bounds(), [neck](const Place& place) { return neck.distance(place.p); },
                   [=](const Place&, float distance, const Brush& brush) {
                     return bone(distance, 1.2F, 800.0F, 230.0F, label, brush);
                   }});
    }
}

void add_cartilages(Anatomy& anatomy) {
  const auto& contours = anatomy.torso.contours();
  std::vector<Cone> cones;
  // Each cartilage continues from the end of its rib to the next one above, the seventh to the sternum.
  struct Way {
    int rib;
    float middle_deg, middle_z, end_deg, end_z;
  };
  constexpr std::array<Way, 5> kWays{{{6, 152.0F, 84.0F, 173.0F, 112.0F},
                                      {7, 148.0F, 62.0F, 173.0F, 98.0F},
                                      {8, 136.0F, 38.0F, 149.0F, 62.0F},
                                      {9, 128.0F, 18.0F, 138.0F, 40.0F},
                                      {10, 116.0F, 2.0F, 128.0F, 19.0F}}};
  for (const float sign : {-1.0F, 1.0F})
    for (const Way& way : kWays) {
      const float tip = kRibEndDeg[static_cast<std::size_t>(way.rib - 5)] - 1.0F;
      const auto knot = [&](float degrees, float z, float radius) {
        return Knot{contours.on_cavity(sign * degrees * kDegree, z, kRibOutwardMm), radius};
      };
      const float tip_z = rib_height(way.rib, tip);
      const auto piece = chain({knot(tip, tip_z, 5.2F),
                                knot(0.5F * (tip + way.middle_deg), 0.5F * (tip_z + way.middle_z) - 3.0F, 5.2F),
                                knot(way.middle_deg, way.middle_z, 5.0F),
                                knot(0.5F * (way.middle_deg + way.end_deg), 0.5F * (way.middle_z + way.end_z), 4.8F),
                                knot(way.end_deg, way.end_z, 4.6F)});
      cones.insert(cones.end(), piece.begin(), piece.end());
    }
  const Tube tube(std::move(cones));
  const std::uint8_t label = anatomy.label("costal_cartilages");
  const auto& noise = anatomy.noise;
  anatomy.add({"costal_cartilages", tube.bounds(), [=](const Place& place) { return tube.distance(place.p); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float calcified = 150.0F * smooth_step(0.35F, 0.7F, noise(place.p / 7.0F));
                 return Paint{mix(150.0F, 95.0F, brush.cover(distance + 1.2F)) + calcified, label};
               }});

  const Vec3f sternum = contours.on_cavity(kPi, 122.0F, 6.5F);
  const Vec3f xiphoid = contours.on_cavity(kPi, 94.0F, 6.5F);
  const std::uint8_t sternum_label = anatomy.label("sternum");
  anatomy.add({"sternum", Box::around(sternum, Vec3f(20.0F, 20.0F, 48.0F)),
               [=](const Place& place) {
                 const auto plate = [&](const Vec3f& u, float half_width, float half_height) {
                   return smooth_max(elliptic_cylinder(u.x(), u.y(), half_width, 5.5F), std::abs(u.z()) - half_height,
                                     5.0F);
                 };
                 return smooth_min(plate(place.p - sternum, 16.0F, 26.0F), plate(place.p - xiphoid, 8.0F, 13.0F), 5.0F);
               },
               [=](const Place&, float distance, const Brush& brush) {
                 return bone(distance, 1.2F, 600.0F, 150.0F, sternum_label, brush);
               }});
}

/// The arch and its processes, around the vertebral body's centre.
Tube vertebral_arch(bool lumbar) {
  std::vector<Cone> cones;
  const auto both = [&](const Vec3f& a, const Vec3f& b, float radius_a, float radius_b) {
    for (const float sign : {-1.0F, 1.0F})
      cones.push_back({Vec3f(sign * a.x(), a.y(), a.z()), Vec3f(sign * b.x(), b.y(), b.z()), radius_a, radius_b});
  };
  both({12.0F, 11.0F, 5.0F}, {15.5F, 26.0F, 4.0F}, 4.6F, 4.4F);  // pedicles
  both({14.5F, 28.0F, 1.0F}, {2.0F, 38.0F, -5.0F}, 4.2F, 3.4F);  // laminae
  both({13.5F, 31.0F, -8.0F}, {2.0F, 38.5F, -10.0F}, 3.4F, 3.2F);
  both({17.0F, 28.0F, 13.0F}, {16.0F, 31.0F, -16.0F}, 4.6F, 4.6F);  // articular processes
  if (lumbar) {
    both({16.0F, 26.0F, 2.0F}, {39.0F, 31.0F, 4.0F}, 4.2F, 3.0F);
    for (const float z : {-2.0F, -6.0F, -10.0F, -14.0F})
      cones.push_back({Vec3f(0.0F, 38.0F, z), Vec3f(0.0F, 60.0F, z - 4.0F), 2.8F, 3.3F});
  } else {
    both({15.0F, 27.0F, 3.0F}, {31.0F, 39.0F, 7.0F}, 4.8F, 4.4F);
    cones.push_back({Vec3f(0.0F, 38.0F, -4.0F), Vec3f(0.0F, 58.0F, -22.0F), 4.0F, 3.2F});
    cones.push_back({Vec3f(0.0F, 38.0F, -9.0F), Vec3f(0.0F, 55.0F, -22.0F), 3.4F, 3.0F});
  }
  return Tube(std::move(cones));
}

float vertebral_body(const Vec3f& u, float half_height, float size) {
  const float waist = 2.6F * (1.0F - clamp01(u.z() * u.z() / (half_height * half_height)));
  const float outline = elliptic_cylinder(u.x(), u.y(), (22.5F - waist) * size, (17.0F - waist) * size);
  const float hollow_back = 26.0F - std::hypot(u.x(), u.y() - 38.5F * size);  // concave towards the canal
  return smooth_max(smooth_max(outline, hollow_back, 4.0F), std::abs(u.z()) - half_height, 3.0F);
}

float canal(const Vec3f& u) {
  return elliptic_cylinder(u.x(), u.y() - 25.0F, 10.5F, 8.2F);
}

void add_vertebra(Anatomy& anatomy, int level) {
  const bool lumbar = level > 7;
  const std::string name =
      lumbar ? "vertebrae_L" + std::to_string(level - 7) : "vertebrae_T" + std::to_string(level + 5);
  const float z = vertebra_height(level);
  const Vec3f centre(0.0F, spine_y(z), z);
  const float half_height =
      0.5F * (vertebra_height(level - 1) - vertebra_height(level + 1)) * 0.5F - (lumbar ? 4.3F : 2.8F);
  const float size = lumbar ? 1.04F : 0.97F;
  const Tube arch = vertebral_arch(lumbar);
  const std::uint8_t label = anatomy.label(name);
  const auto& noise = anatomy.noise;
  anatomy.add({name, Box::around(centre + Vec3f(0.0F, 22.0F, -5.0F), Vec3f(44.0F, 44.0F, 34.0F)),
               [=](const Place& place) {
                 const Vec3f u = place.p - centre;
                 const float solid = smooth_min(vertebral_body(u, half_height, size), arch.distance(u), 4.0F);
                 return smooth_max(solid, -canal(u), 1.5F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const Vec3f u = place.p - centre;
                 const float behind = smooth_step(12.0F, 22.0F, u.y());
                 const float marrow = mix(200.0F, 330.0F, behind) + 55.0F * noise(place.p / 3.5F);
                 const float vein = brush.cover(std::hypot(u.z(), u.x() * 0.4F) - 2.0F) *
                                    smooth_step(2.0F, 14.0F, u.y()) * (1.0F - behind);
                 return bone(distance, mix(1.1F, 1.6F, behind), mix(560.0F, 830.0F, behind), marrow - 110.0F * vein,
                             label, brush);
               }});
}

void add_spine(Anatomy& anatomy) {
  const auto disc_distance = [](const Vec3f& p, int above) {
    const float middle = 0.5F * (vertebra_height(above) + vertebra_height(above + 1));
    const float body = elliptic_cylinder(p.x(), p.y() - spine_y(p.z()), 22.5F, 17.0F);
    return smooth_max(body, std::abs(p.z() - middle) - 6.0F, 2.0F);
  };
  anatomy.add_plain(
      "intervertebral_discs", Box{Vec3f(-26.0F, 0.0F, -kHalfHeight - 5.0F), Vec3f(26.0F, 60.0F, 119.0F)},
      [=](const Place& place) {
        float d = 1e6F;
        for (int above = 4; above <= 12; ++above) d = std::min(d, disc_distance(place.p, above));
        return d;
      },
      88.0F, 8.0F, 8.0F);
  for (int level = 4; level <= 11; ++level) add_vertebra(anatomy, level);

  const std::uint8_t cord = anatomy.label("spinal_cord");
  const std::uint8_t fat = anatomy.label("fat");
  anatomy.add({"spinal_cord", Box{Vec3f(-14.0F, 30.0F, -kHalfHeight - 5.0F), Vec3f(14.0F, 75.0F, kHalfHeight + 5.0F)},
               [](const Place& place) { return canal(place.p - Vec3f(0.0F, spine_y(place.p.z()), 0.0F)) + 0.3F; },
               [=](const Place& place, float distance, const Brush& brush) {
                 const float sac = distance + 1.6F;
                 // The cord ends at L1; below it only the roots of the cauda equina.
                 const float cord_radius = mix(3.0F, 5.0F, smooth_step(-8.0F, 12.0F, place.p.z()));
                 const float inner = std::hypot(place.p.x(), place.p.y() - spine_y(place.p.z()) - 24.5F) - cord_radius;
                 const float fluid = mix(-70.0F, 18.0F, brush.cover(sac));
                 return Paint{mix(fluid, 42.0F, brush.cover(inner)), sac < 0.0F ? cord : fat};
               }});
}

}  // namespace

float spine_y(float z) {
  return 28.0F - 5.0F * bump(z, -55.0F, 70.0F) + 3.0F * smooth_step(20.0F, 120.0F, z);
}

std::optional<int> intercostal_space(const Place& place) {
  const float side_deg = std::atan2(std::abs(place.p.x()), place.p.y()) / kDegree;
  for (int rib = 5; rib < 12; ++rib) {
    const bool reaches = side_deg > kRibBeginDeg && side_deg < kRibEndDeg[static_cast<std::size_t>(rib + 1 - 5)];
    if (reaches && place.p.z() < rib_height(rib, side_deg) && place.p.z() > rib_height(rib + 1, side_deg)) return rib;
  }
  return std::nullopt;
}

float vertebra_height(int level) {
  // T5 … L5 at 0 … 12.
  constexpr std::array<float, 13> kHeights{230.0F, 203.0F, 176.0F, 148.0F, 119.0F, 92.0F,  65.0F,
                                           37.0F,  6.0F,   -27.0F, -61.0F, -95.0F, -130.0F};
  return kHeights[static_cast<std::size_t>(std::clamp(level, 0, 12))];
}

void add_skeleton(Anatomy& anatomy) {
  add_cartilages(anatomy);
  add_ribs(anatomy);
  add_spine(anatomy);
}

}  // namespace trocar::anatomy::phantom
