#include <algorithm>
#include <cmath>

#include "anatomy/phantom/bile_ducts.h"
#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kFullGallbladder = 1.25F;
constexpr float kFluidMm = 9.0F;  ///< Of free fluid around the liver, when there is much.

struct LiverShape {
  const LiverData& data;
  float scale;
  float left_reach;  ///< Extent of the left lobe (x, mm).
  float tip_z;       ///< Lowest point of the right lobe.
  float fluid_mm;    ///< Free fluid between liver and wall.

  float operator()(const Place& place, const ValueNoise& noise) const {
    const Vec3f& q = place.q;
    const float right = ellipsoid(q - data.right_centre, data.right_radii_mm * scale);
    const Vec3f l = q - Vec3f(left_reach + data.left_centre.x(), data.left_centre.y(), data.left_centre.z());
    const float left = ellipsoid(Vec3f(l.x(), l.y() + 0.10F * l.x(), l.z() - 0.12F * l.x()), data.left_radii_mm);
    // The visceral surface rises from the right lower tip to the left and to the back, slightly concave.
    const float rise = tip_z + data.visceral_slope[0] * (q.x() - data.tip_x_mm) + data.visceral_slope[1] * q.y() +
                       data.visceral_hollow_x.at(q.x());
    const float above = (rise - q.z()) * 0.80F;
    float d = smooth_min(smooth_max(right, above, 22.0F), left, 26.0F);
    // Behind, the liver leaves space for the spine and the great vessels.
    const Ellipse& spine = data.spine_space;
    d = smooth_max(d, -elliptic_cylinder(q.x() - spine.x, q.y() - spine.y, spine.radius_x, spine.radius_y), 10.0F);
    // Porta hepatis, and the fissure of the round ligament.
    d = smooth_max(d, -ellipsoid(q - data.porta_centre, data.porta_radii_mm), 9.0F);
    const float depth = clamp01((data.fissure_y_mm - q.y()) / 30.0F) * smooth_step(46.0F, 5.0F, q.z() - 0.25F * q.y());
    const float bend = 4.0F * noise(place.p / 26.0F);
    const float fissure = std::abs(q.x() - data.fissure_x_mm + 0.12F * q.y() + bend) - 3.6F * depth + 1.6F;
    d = smooth_max(d, -fissure, 4.0F);
    d += 1.4F * noise(place.p / 30.0F);
    d = smooth_max(d, place.diaphragm + 3.3F + 0.5F * fluid_mm, 6.0F);
    return smooth_max(d, place.cavity + 2.6F + fluid_mm, 6.0F);
  }
};

Course gallbladder_course(const Anatomy& anatomy) {
  Random random = anatomy.random("gallbladder");
  const float x = anatomy.data.gallbladder.x_mm.draw(random);
  return moved(anatomy.data.gallbladder.course, Vec3f(x, 0.0F, 0.0F));
}

}  // namespace

Vec3f gallbladder_neck(const Anatomy& anatomy) {
  return gallbladder_course(anatomy).front().p;
}

void add_liver(Anatomy& anatomy) {
  Random random = anatomy.random("liver");
  const LiverData& data = anatomy.data.liver;
  const LiverShape shape{data, data.size.draw(random) * static_cast<float>(anatomy.body.liver_size),
                         data.left_reach_mm.draw(random), data.tip_z_mm.draw(random),
                         kFluidMm * floating_share(anatomy.body)};
  const auto& noise = anatomy.noise;
  const auto kidney = anatomy.find("kidney_right").distance;  // makes the renal impression
  const Box bounds{Vec3f(-220.0F, -220.0F, -110.0F), Vec3f(90.0F, 115.0F, 112.0F)};
  anatomy.add_plain(
      "liver", bounds,
      [=, &noise](const Place& place) { return smooth_max(shape(place, noise), 4.0F - kidney(place), 4.0F); }, 106.0F,
      3.5F, 9.0F);

  // The gallbladder is in its fossa on the visceral surface.
  Course course = gallbladder_course(anatomy);
  // It is full where the bile duct is closed below the cystic duct.
  const bool is_full = anatomy.body.has_obstruction && anatomy.body.obstruction_share > kCysticDuctShare;
  if (is_full)
    for (Knot& knot : course) knot.radius *= kFullGallbladder;
  const Tube gallbladder(chain(course));
  const std::uint8_t label = anatomy.label("gallbladder");
  anatomy.add({"gallbladder", warped(gallbladder.bounds()),
               [=](const Place& place) { return smooth_max(gallbladder.distance(place.q), place.cavity + 5.0F, 3.0F); },
               [=](const Place&, float distance, const Brush& brush) {
                 return Paint{mix(75.0F, 9.0F, brush.cover(distance + 1.6F)), label};
               }});
}

}  // namespace trocar::anatomy::phantom
