#include "phantom/skeleton.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "phantom/structure.h"

namespace trocar::phantom {
namespace {

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
  const Vec3f head = anatomy.torso.spine().bend(Vec3f(sign * data.head.p.x(), data.head.p.y(), z + data.head.p.z()));
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
  add_pelvis(anatomy);
}

}  // namespace trocar::phantom
