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

// Levels of SpineData.
constexpr int kHighestInBox = 4;  ///< T9.
constexpr int kT12 = 7;
constexpr int kL5 = 12;

constexpr float kRibCourse = 1.25F;       ///< Exponent of the fall over the angle.
constexpr float kRibObliqueness = 0.88F;  ///< Share of the height across an oblique rib.

float rib_drop(const RibData& ribs, float side_deg) {
  return ribs.fall_mm * std::pow(side_deg / 90.0F, kRibCourse) - ribs.head_above_mm;
}

/// Height of the vertebral body at which a rib begins.
float rib_level(const AbdomenData& data, int rib) {
  return data.spine.height(rib - RibData::kFirst);
}

float rib_height(const AbdomenData& data, int rib, float side_deg) {
  return rib_level(data, rib) - rib_drop(data.ribs, side_deg);
}

struct RibHit {
  int rib;
  float distance;
};

RibHit nearest_rib(const AbdomenData& data, const Place& place) {
  const RibData& ribs = data.ribs;
  const float side_deg = std::atan2(std::abs(place.p.x()), place.p.y()) / kDegree;
  const float level = place.p.z() + rib_drop(ribs, side_deg);
  const auto level_distance = [&](int rib) { return std::abs(level - rib_level(data, rib)); };
  int best = RibData::kFirst;
  for (int rib = RibData::kFirst + 1; rib <= RibData::kLast; ++rib)
    if (level_distance(rib) < level_distance(best)) best = rib;
  const float off = level_distance(best) * kRibObliqueness;
  const float along = std::max(off - ribs.half_height_mm + ribs.half_thickness_mm, 0.0F);
  const float swept = std::hypot(along, place.cavity - ribs.outward_mm) - ribs.half_thickness_mm;
  const float radius = std::hypot(place.p.x(), place.p.y());
  const float end = (side_deg - ribs.end_deg(best)) * kDegree * radius;
  const float begin = (ribs.begin_deg - side_deg) * kDegree * radius;
  return {best, smooth_max(swept, std::max(end, begin), 3.0F)};
}

/// Bone: a dense shell around marrow.
Paint bone(float distance, float cortex_mm, float cortex_hu, float marrow_hu, std::uint8_t label, const Brush& brush) {
  return {mix(cortex_hu, marrow_hu, brush.cover(distance + cortex_mm)), label};
}

/// Labels of the ribs: right, left.
using RibLabels = std::array<std::array<std::uint8_t, RibData::kLast - RibData::kFirst + 1>, 2>;

RibLabels add_rib_labels(Anatomy& anatomy) {
  RibLabels labels;
  for (int rib = RibData::kFirst; rib <= RibData::kLast; ++rib)
    for (std::size_t side = 0; side < 2; ++side)
      labels[side][static_cast<std::size_t>(rib - RibData::kFirst)] =
          anatomy.label((side == 0 ? "rib_right_" : "rib_left_") + std::to_string(rib));
  return labels;
}

/// From the side of the vertebra back and out to the angle of the rib.
void add_rib_neck(Anatomy& anatomy, int rib, float sign, std::uint8_t label) {
  const RibData& ribs = anatomy.data.ribs;
  const RibData::Neck& data = ribs.neck;
  const float z = rib_level(anatomy.data, rib);
  const Vec3f angle = anatomy.torso.contours().on_cavity(
      sign * (data.begin_deg * kDegree), rib_height(anatomy.data, rib, data.begin_deg), ribs.outward_mm);
  const Vec3f head(sign * data.head.p.x(), anatomy.data.spine.y(z) + data.head.p.y(), z + data.head.p.z());
  const Vec3f tubercle(sign * data.tubercle_x_mm, mix(head.y(), angle.y(), data.tubercle_share),
                       z + data.tubercle_above_mm);
  const Tube neck(
      chain({{head, data.head.radius}, {tubercle, data.tubercle_radius_mm}, {angle, data.angle_radius_mm}}));
  anatomy.add({"rib_neck", neck.bounds(), [neck](const Place& place) { return neck.distance(place.p); },
               [=](const Place&, float distance, const Brush& brush) {
                 return bone(distance, 1.2F, 800.0F, 230.0F, label, brush);
               }});
}

void add_ribs(Anatomy& anatomy) {
  const RibLabels labels = add_rib_labels(anatomy);
  const auto& noise = anatomy.noise;
  const AbdomenData& data = anatomy.data;
  anatomy.add({"rib_cage", whole_box(), [&data](const Place& place) { return nearest_rib(data, place).distance; },
               [=, &noise, &data](const Place& place, float distance, const Brush& brush) {
                 const auto rib = static_cast<std::size_t>(nearest_rib(data, place).rib - RibData::kFirst);
                 return bone(distance, 1.3F, 820.0F, 210.0F + 60.0F * noise(place.p / 4.0F),
                             labels[place.p.x() > 0.0F ? 1 : 0][rib], brush);
               }});
  for (int rib = data.ribs.neck.first_rib; rib <= RibData::kLast; ++rib)
    for (std::size_t side = 0; side < 2; ++side)
      add_rib_neck(anatomy, rib, side == 0 ? -1.0F : 1.0F,
                   labels[side][static_cast<std::size_t>(rib - RibData::kFirst)]);
}

/// A cartilage from the end of its rib.
std::vector<Cone> cartilage(const Anatomy& anatomy, const CartilageData::Path& path, float sign) {
  const AbdomenData& data = anatomy.data;
  const auto& radii = data.cartilages.radii_mm;
  const float tip = data.ribs.end_deg(path.rib) - 1.0F;
  const float tip_z = rib_height(data, path.rib, tip);
  const auto knot = [&](float degrees, float z, float radius) {
    return Knot{anatomy.torso.contours().on_cavity(sign * degrees * kDegree, z, data.ribs.outward_mm), radius};
  };
  return chain({knot(tip, tip_z, radii[0]),
                knot(0.5F * (tip + path.middle_deg), 0.5F * (tip_z + path.middle_z) - data.cartilages.sag_mm, radii[1]),
                knot(path.middle_deg, path.middle_z, radii[2]),
                knot(0.5F * (path.middle_deg + path.end_deg), 0.5F * (path.middle_z + path.end_z), radii[3]),
                knot(path.end_deg, path.end_z, radii[4])});
}

void add_cartilages(Anatomy& anatomy) {
  std::vector<Cone> cones;
  for (const float sign : {-1.0F, 1.0F})
    for (const CartilageData::Path& path : anatomy.data.cartilages.courses) {
      const std::vector<Cone> piece = cartilage(anatomy, path, sign);
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
}

void add_sternum(Anatomy& anatomy) {
  const SternumData& data = anatomy.data.sternum;
  const auto& contours = anatomy.torso.contours();
  const Vec3f sternum = contours.on_cavity(kPi, data.z_mm, data.outward_mm);
  const Vec3f xiphoid = contours.on_cavity(kPi, data.xiphoid_z_mm, data.outward_mm);
  const std::uint8_t label = anatomy.label("sternum");
  const auto plate = [&data](const Vec3f& u, float half_width, float half_height) {
    return smooth_max(elliptic_cylinder(u.x(), u.y(), half_width, data.half_thickness_mm),
                      std::abs(u.z()) - half_height, 5.0F);
  };
  anatomy.add({"sternum", Box::around(sternum, Vec3f(20.0F, 20.0F, 48.0F)),
               [=, &data](const Place& place) {
                 return smooth_min(plate(place.p - sternum, data.half_width_mm, data.half_height_mm),
                                   plate(place.p - xiphoid, data.xiphoid_half_width_mm, data.xiphoid_half_height_mm),
                                   5.0F);
               },
               [=](const Place&, float distance, const Brush& brush) {
                 return bone(distance, 1.2F, 600.0F, 150.0F, label, brush);
               }});
}

/// The arch and its processes, around the vertebral body's centre.
Tube vertebral_arch(const VertebraData& data) {
  std::vector<Cone> cones;
  for (const Cone& cone : data.paired)
    for (const float sign : {-1.0F, 1.0F})
      cones.push_back({Vec3f(sign * cone.a.x(), cone.a.y(), cone.a.z()),
                       Vec3f(sign * cone.b.x(), cone.b.y(), cone.b.z()), cone.radius_a, cone.radius_b});
  cones.insert(cones.end(), data.spinous.begin(), data.spinous.end());
  return Tube(std::move(cones));
}

float vertebral_body(const SpineData& spine, const Vec3f& u, float half_height, float size) {
  const float waist = spine.body_waist_mm * (1.0F - clamp01(u.z() * u.z() / (half_height * half_height)));
  const float outline = elliptic_cylinder(u.x(), u.y(), (spine.body_half_width_mm - waist) * size,
                                          (spine.body_half_depth_mm - waist) * size);
  const float hollow_back = spine.body_hollow[1] - std::hypot(u.x(), u.y() - spine.body_hollow[0] * size);
  return smooth_max(smooth_max(outline, hollow_back, 4.0F), std::abs(u.z()) - half_height, 3.0F);
}

float canal(const SpineData& spine, const Vec3f& u) {
  return elliptic_cylinder(u.x(), u.y() - spine.canal_y_mm, spine.canal_radii_mm[0], spine.canal_radii_mm[1]);
}

void add_vertebra(Anatomy& anatomy, int level) {
  const bool lumbar = level > kT12;
  const SpineData& spine = anatomy.data.spine;
  const VertebraData& data = lumbar ? anatomy.data.lumbar_vertebra : anatomy.data.thoracic_vertebra;
  const std::string name =
      lumbar ? "vertebrae_L" + std::to_string(level - kT12) : "vertebrae_T" + std::to_string(level + 5);
  const float z = spine.height(level);
  const Vec3f centre(0.0F, spine.y(z), z);
  const float half_height = 0.5F * (spine.height(level - 1) - spine.height(level + 1)) * 0.5F - data.half_disc_mm;
  const float size = data.size;
  const Tube arch = vertebral_arch(data);
  const std::uint8_t label = anatomy.label(name);
  const auto& noise = anatomy.noise;
  anatomy.add({name, Box::around(centre + Vec3f(0.0F, 22.0F, -5.0F), Vec3f(44.0F, 44.0F, 34.0F)),
               [=, &spine](const Place& place) {
                 const Vec3f u = place.p - centre;
                 const float solid = smooth_min(vertebral_body(spine, u, half_height, size), arch.distance(u), 4.0F);
                 return smooth_max(solid, -canal(spine, u), 1.5F);
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

void add_discs(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  const auto disc_distance = [&spine](const Vec3f& p, int above) {
    const float middle = 0.5F * (spine.height(above) + spine.height(above + 1));
    const float body =
        elliptic_cylinder(p.x(), p.y() - spine.y(p.z()), spine.body_half_width_mm, spine.body_half_depth_mm);
    return smooth_max(body, std::abs(p.z() - middle) - spine.disc_half_height_mm, 2.0F);
  };
  anatomy.add_plain(
      "intervertebral_discs", Box{Vec3f(-26.0F, 0.0F, -kHalfHeight - 5.0F), Vec3f(26.0F, 60.0F, 119.0F)},
      [=](const Place& place) {
        float d = 1e6F;
        for (int above = kHighestInBox; above <= kL5; ++above) d = std::min(d, disc_distance(place.p, above));
        return d;
      },
      88.0F, 8.0F, 8.0F);
}

void add_cord(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  const std::uint8_t cord = anatomy.label("spinal_cord");
  const std::uint8_t fat = anatomy.label("fat");
  anatomy.add(
      {"spinal_cord", Box{Vec3f(-14.0F, 30.0F, -kHalfHeight - 5.0F), Vec3f(14.0F, 75.0F, kHalfHeight + 5.0F)},
       [&spine](const Place& place) { return canal(spine, place.p - Vec3f(0.0F, spine.y(place.p.z()), 0.0F)) + 0.3F; },
       [=, &spine](const Place& place, float distance, const Brush& brush) {
         const float sac = distance + 1.6F;
         // Below the cord's end there are only the roots of the cauda equina.
         const float cord_radius =
             mix(spine.cord_radii_mm[0], spine.cord_radii_mm[1], spine.cord_end_z.share(place.p.z()));
         const float inner =
             std::hypot(place.p.x(), place.p.y() - spine.y(place.p.z()) - spine.cord_y_mm) - cord_radius;
         const float fluid = mix(-70.0F, 18.0F, brush.cover(sac));
         return Paint{mix(fluid, 42.0F, brush.cover(inner)), sac < 0.0F ? cord : fat};
       }});
}

void add_spine(Anatomy& anatomy) {
  add_discs(anatomy);
  for (int level = kHighestInBox; level < kL5; ++level) add_vertebra(anatomy, level);
  add_cord(anatomy);
}

}  // namespace

std::optional<int> intercostal_space(const AbdomenData& data, const Place& place) {
  const float side_deg = std::atan2(std::abs(place.p.x()), place.p.y()) / kDegree;
  for (int rib = RibData::kFirst; rib < RibData::kLast; ++rib) {
    const bool reaches = side_deg > data.ribs.begin_deg && side_deg < data.ribs.end_deg(rib + 1);
    if (reaches && place.p.z() < rib_height(data, rib, side_deg) && place.p.z() > rib_height(data, rib + 1, side_deg))
      return rib;
  }
  return std::nullopt;
}

void add_skeleton(Anatomy& anatomy) {
  add_cartilages(anatomy);
  add_sternum(anatomy);
  add_ribs(anatomy);
  add_spine(anatomy);
}

}  // namespace trocar::anatomy::phantom
