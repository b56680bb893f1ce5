#include <algorithm>
#include <cmath>

#include "anatomy/phantom/biopsy.h"
#include "anatomy/phantom/skeleton.h"
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

std::vector<Cone> joined(std::initializer_list<std::vector<Cone>> parts) {
  std::vector<Cone> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
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
  const auto spine_front = [](float z) { return spine_y(z) - 17.5F; };
  add_vessel(anatomy, "aorta",
             joined({chain({{Vec3f(24.0F, 16.0F, 130.0F), 12.0F},
                            {Vec3f(20.0F, 10.0F, 95.0F), 11.5F},
                            {Vec3f(10.0F, spine_front(50.0F) - 12.0F, 50.0F), 11.0F},
                            {Vec3f(8.0F, spine_front(0.0F) - 10.5F, 0.0F), 10.0F},
                            {Vec3f(5.0F, spine_front(-70.0F) - 9.5F, -70.0F), 8.8F},
                            {Vec3f(3.0F, spine_front(-130.0F) - 9.0F, -130.0F), 8.5F}}),
                     chain({{Vec3f(9.0F, 0.0F, 22.0F), 4.0F},
                            {Vec3f(8.0F, -14.0F, 22.0F), 3.6F},
                            {Vec3f(4.0F, -22.0F, 23.0F), 3.0F}}),
                     chain({{Vec3f(4.0F, -22.0F, 23.0F), 2.8F},
                            {Vec3f(-12.0F, -24.0F, 20.0F), 2.4F},
                            {Vec3f(-26.0F, -19.0F, 13.0F), 2.2F}}),
                     chain({{Vec3f(8.0F, 0.0F, 4.0F), 4.2F},
                            {Vec3f(6.0F, -14.0F, -4.0F), 3.8F},
                            {Vec3f(4.0F, -22.0F, -30.0F), 3.5F},
                            {Vec3f(0.0F, -26.0F, -70.0F), 3.2F},
                            {Vec3f(-4.0F, -26.0F, -130.0F), 2.8F}}),
                     chain({{Vec3f(14.0F, 2.0F, -12.0F), 3.0F},
                            {Vec3f(28.0F, 10.0F, -12.0F), 2.7F},
                            {Vec3f(46.0F, 22.0F, -12.0F), 2.5F}}),
                     chain({{Vec3f(2.0F, 2.0F, -16.0F), 3.0F},
                            {Vec3f(-24.0F, 12.0F, -20.0F), 2.7F},
                            {Vec3f(-46.0F, 23.0F, -25.0F), 2.5F}})}),
             kArteryHu);
  add_vessel(anatomy, "inferior_vena_cava",
             joined({chain({{Vec3f(-20.0F, 0.0F, -130.0F), 11.0F},
                            {Vec3f(-21.0F, 1.0F, -60.0F), 11.0F},
                            {Vec3f(-23.0F, 0.0F, -10.0F), 11.5F},
                            {Vec3f(-25.0F, -1.0F, 40.0F), 12.0F},
                            {Vec3f(-23.0F, -6.0F, 70.0F), 12.5F},
                            {Vec3f(-18.0F, -16.0F, 100.0F), 13.0F},
                            {Vec3f(-14.0F, -24.0F, 125.0F), 14.0F}}),
                     chain({{Vec3f(-14.0F, -2.0F, -8.0F), 4.5F},
                            {Vec3f(8.0F, -10.5F, -8.0F), 4.0F},
                            {Vec3f(30.0F, 2.0F, -9.0F), 4.2F},
                            {Vec3f(48.0F, 18.0F, -12.0F), 4.2F}}),
                     chain({{Vec3f(-26.0F, 2.0F, -20.0F), 4.5F},
                            {Vec3f(-36.0F, 8.0F, -23.0F), 4.3F},
                            {Vec3f(-48.0F, 19.0F, -26.0F), 4.2F}})}),
             kVeinHu);
  add_vessel(anatomy, "portal_vein_and_splenic_vein",
             joined({chain({{Vec3f(-6.0F, -24.0F, -130.0F), 4.0F},
                            {Vec3f(-8.0F, -25.0F, -70.0F), 5.0F},
                            {Vec3f(-8.0F, -22.0F, -30.0F), 5.8F},
                            {Vec3f(-8.0F, -20.0F, -6.0F), 6.8F},
                            {Vec3f(-18.0F, -16.0F, 5.0F), 7.2F},
                            {kHilum, 7.0F}}),
                     chain({{Vec3f(-8.0F, -20.0F, -6.0F), 5.0F},
                            {Vec3f(16.0F, -20.0F, 4.0F), 4.6F},
                            {Vec3f(44.0F, -6.0F, 14.0F), 4.4F},
                            {Vec3f(66.0F, 10.0F, 26.0F), 4.0F},
                            {Vec3f(78.0F, 16.0F, 34.0F), 3.6F}})}),
             kPortalHu);
}

void add_liver_vessels(Anatomy& anatomy, const BiopsyPlan& plan) {
  const Structure& liver = anatomy.find("liver");
  const Structure& gallbladder = anatomy.find("gallbladder");
  const auto is_free = [&](const Vec3f& p, float radius) {
    const Place place = anatomy.torso.at(p);
    return liver.distance(place) < -(radius + 2.0F) && gallbladder.distance(place) > radius + 2.0F &&
           !plan.is_in_the_way(p, radius);
  };
  const std::vector<Vec3f> territory = liver_territory(anatomy, 5.0F);

  Random portal_random = anatomy.random("portal_vein");
  const GrowthRule portal_rule{6.5F, 0.45F, 1.25F, is_free};
  const Tube portal(grow_tree({anatomy.unwarped(kHilum), Vec3f(-0.6F, -0.2F, 0.7F).normalized()}, territory,
                              portal_rule, portal_random));
  add_tree(anatomy, "portal_vein", portal, kPortalHu);

  Random hepatic_random = anatomy.random("hepatic_veins");
  const GrowthRule hepatic_rule{6.8F, 0.12F, 1.25F, [&](const Vec3f& p, float radius) {
                                  return is_free(p, radius) && portal.distance(p) > radius + 0.8F;
                                }};
  const Tube hepatic(grow_tree({anatomy.unwarped(kVenousConfluence), Vec3f(-0.6F, -0.5F, 0.1F).normalized()}, territory,
                               hepatic_rule, hepatic_random));
  add_tree(anatomy, "hepatic_veins", hepatic, kVeinHu);
}

}  // namespace trocar::anatomy::phantom
