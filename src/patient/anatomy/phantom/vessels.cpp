#include <algorithm>
#include <cmath>

#include "anatomy/phantom/bile_ducts.h"
#include "anatomy/phantom/biopsy.h"
#include "anatomy/phantom/structure.h"
#include "anatomy/phantom/vessel_tree.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kArteryHu = 152.0F;
constexpr float kVeinHu = 160.0F;
constexpr float kPortalHu = 168.0F;

void add_vessel(Anatomy& anatomy, const std::string& label, std::vector<Cone> cones, float hu) {
  const Tube tube(std::move(cones));
  anatomy.add_plain(
      label, warped(tube.bounds()), [=](const Place& place) { return tube.distance(place.q); }, hu, 3.0F, 5.0F);
}

/// The main course of a vessel and its branches.
std::vector<Cone> with_branches(const Course& course, const std::vector<Course>& branches) {
  std::vector<Cone> all = chain(course);
  for (const Course& branch : branches) {
    const std::vector<Cone> cones = chain(branch);
    all.insert(all.end(), cones.begin(), cones.end());
  }
  return all;
}

Course aorta_course(const AortaData& aorta, const SpineCurve& spine) {
  Course course = aorta.chest;
  for (Knot knot : aorta.before_spine) {
    knot.p.y() = spine.y_at(knot.p.z()) - aorta.spine_front_mm - knot.p.y();
    course.push_back(knot);
  }
  return course;
}

/// The angle at which the cavity's surface is this far from the midline, in front.
float front_angle(const TorsoContours& contours, float x, float z) {
  float low = 0.5F * kPi, high = kPi;
  for (int n = 0; n < 24; ++n) {
    const float middle = 0.5F * (low + high);
    (contours.cavity_radius(middle, z) * std::sin(middle) > x ? low : high) = middle;
  }
  return low;
}

void add_epigastric_vessels(Anatomy& anatomy) {
  if (anatomy.torso.box().low.z() > anatomy.data.epigastric.course.front()[1]) return;
  const EpigastricData& data = anatomy.data.epigastric;
  const TorsoContours& contours = anatomy.torso.contours();
  for (const float sign : {-1.0F, 1.0F}) {
    Course course;
    for (const auto& [x, z] : data.course)
      course.push_back({contours.on_cavity(sign * front_angle(contours, x, z), z, data.outward_mm), data.radius_mm});
    const Tube tube(chain(course));
    anatomy.add_plain(
        "epigastric_vessels", tube.bounds(), [=](const Place& place) { return tube.distance(place.p); }, kVeinHu, 3.0F,
        5.0F);
  }
}

/// Points distributed evenly in the liver: the territory of a vessel tree.
std::vector<Vec3f> liver_territory(const Anatomy& anatomy, float depth_mm) {
  const Structure& liver = anatomy.find("liver");
  constexpr float kStepMm = 6.0F;
  std::vector<Vec3f> territory;
  for (float z = liver.bounds.low.z(); z < liver.bounds.high.z(); z += kStepMm)
    for (float y = liver.bounds.low.y(); y < liver.bounds.high.y(); y += kStepMm)
      for (float x = liver.bounds.low.x(); x < liver.bounds.high.x(); x += kStepMm)
        if (const Vec3f p(x, y, z); liver.distance(anatomy.torso.at(p)) < -depth_mm) territory.push_back(p);
  return territory;
}

GrowthRule growth_rule(const TreeData& tree, std::function<bool(const Vec3f&, float)> allowed) {
  return {tree.root_radius_mm, tree.root_share, tree.least_radius_mm, std::move(allowed)};
}

void add_tree(Anatomy& anatomy, const std::string& name, const Tube& tree, float hu) {
  const std::uint8_t label = anatomy.label(name);
  const Structure& liver = anatomy.find("liver");
  anatomy.add({name, tree.bounds(),
               [tree, outside = liver.distance](const Place& place) {
                 return std::max(tree.distance(place.p), outside(place) + 0.8F);
               },
               [=](const Place&, float, const Brush&) {
                 return Paint{hu, label};
               }});
}

}  // namespace

void add_great_vessels(Anatomy& anatomy) {
  const AbdomenData& data = anatomy.data;
  add_vessel(anatomy, "aorta", with_branches(aorta_course(data.aorta, anatomy.torso.spine()), data.aorta.branches),
             kArteryHu);
  add_vessel(anatomy, "inferior_vena_cava", with_branches(data.vena_cava.course, data.vena_cava.branches), kVeinHu);
  add_vessel(anatomy, "portal_vein_and_splenic_vein", with_branches(data.portal_vein.course, data.portal_vein.branches),
             kPortalHu);
  add_epigastric_vessels(anatomy);
}

DuctTree add_liver_vessels(Anatomy& anatomy, const BiopsyPlan& plan) {
  const Structure& liver = anatomy.find("liver");
  const Structure& gallbladder = anatomy.find("gallbladder");
  const auto is_free = [&](const Vec3f& p, float radius) {
    const Place place = anatomy.torso.at(p);
    return liver.distance(place) < -(radius + 2.0F) && gallbladder.distance(place) > radius + 2.0F &&
           !plan.is_in_the_way(p, radius);
  };
  const std::vector<Vec3f> territory = liver_territory(anatomy, 5.0F);

  Random portal_random = anatomy.random("portal_vein");
  const LiverData& gates = anatomy.data.liver;
  const TreeData& portal_data = anatomy.data.portal_tree;
  const Tube portal(grow_tree({anatomy.unwarped(gates.hilum), portal_data.direction.normalized()}, territory,
                              growth_rule(portal_data, is_free), portal_random));
  add_tree(anatomy, "portal_vein", portal, kPortalHu);
  const DuctTree ducts = add_bile_ducts(anatomy, portal.cones());

  Random hepatic_random = anatomy.random("hepatic_veins");
  const TreeData& hepatic_data = anatomy.data.hepatic_tree;
  const auto is_beside_portal = [&](const Vec3f& p, float radius) {
    return is_free(p, radius) && portal.distance(p) > radius + 0.8F && ducts.inside.distance(p) > radius + 0.8F;
  };
  const Tube hepatic(grow_tree({anatomy.unwarped(gates.venous_confluence), hepatic_data.direction.normalized()},
                               territory, growth_rule(hepatic_data, is_beside_portal), hepatic_random));
  add_tree(anatomy, "hepatic_veins", hepatic, kVeinHu);
  return ducts;
}

}  // namespace trocar::anatomy::phantom
