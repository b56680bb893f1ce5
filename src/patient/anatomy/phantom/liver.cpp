#include <algorithm>
#include <cmath>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

struct LiverShape {
  float scale;
  float left_reach;  ///< Extent of the left lobe (x, mm).
  float tip_z;       ///< Lowest point of the right lobe.

  float operator()(const Place& place, const ValueNoise& noise) const {
    const Vec3f& q = place.q;
    const float right = ellipsoid(q - Vec3f(-70.0F, -2.0F, 14.0F), Vec3f(94.0F, 104.0F, 94.0F) * scale);
    const Vec3f l = q - Vec3f(left_reach - 62.0F, -52.0F, 50.0F);
    const float left =
        ellipsoid(Vec3f(l.x(), l.y() + 0.10F * l.x(), l.z() - 0.12F * l.x()), Vec3f(68.0F, 50.0F, 34.0F));
    // The visceral surface rises from the right lower tip to the left and to the back, slightly concave.
    const float rise = tip_z + 0.66F * (q.x() + 112.0F) + 0.20F * q.y() + 9.0F * bump(q.x(), -50.0F, 40.0F);
    const float above = (rise - q.z()) * 0.80F;
    float d = smooth_min(smooth_max(right, above, 22.0F), left, 26.0F);
    // Behind, the liver leaves space for the spine and the great vessels.
    d = smooth_max(d, -elliptic_cylinder(q.x() - 12.0F, q.y() - 42.0F, 47.0F, 46.0F), 10.0F);
    // Porta hepatis, and the fissure of the round ligament.
    d = smooth_max(d, -ellipsoid(q - Vec3f(-22.0F, -14.0F, 6.0F), Vec3f(22.0F, 17.0F, 17.0F)), 9.0F);
    const float depth = clamp01((-24.0F - q.y()) / 30.0F) * smooth_step(46.0F, 5.0F, q.z() - 0.25F * q.y());
    const float bend = 4.0F * noise(place.p / 26.0F);
    const float fissure = std::abs(q.x() + 10.0F + 0.12F * q.y() + bend) - 3.6F * depth + 1.6F;
    d = smooth_max(d, -fissure, 4.0F);
    d += 1.4F * noise(place.p / 30.0F);
    d = smooth_max(d, place.diaphragm + 3.3F, 6.0F);
    return smooth_max(d, place.cavity + 2.6F, 6.0F);
  }
};

}  // namespace

void add_liver(Anatomy& anatomy) {
  Random random = anatomy.random("liver");
  const LiverShape shape{static_cast<float>(random.uniform(0.97, 1.03)), static_cast<float>(random.uniform(44.0, 62.0)),
                         static_cast<float>(random.uniform(-68.0, -56.0))};
  const auto& noise = anatomy.noise;
  const auto kidney = anatomy.find("kidney_right").distance;  // makes the renal impression
  const Box bounds{Vec3f(-kHalfWidth, -kHalfDepth, -95.0F), Vec3f(85.0F, 115.0F, 110.0F)};
  anatomy.add_plain(
      "liver", bounds,
      [=, &noise](const Place& place) { return smooth_max(shape(place, noise), 4.0F - kidney(place), 4.0F); }, 106.0F,
      3.5F, 9.0F);

  // The gallbladder is in its fossa on the visceral surface.
  const float x = static_cast<float>(random.uniform(-54.0, -46.0));
  const Tube gallbladder(chain({{Vec3f(x + 12.0F, -22.0F, 4.0F), 4.0F},
                                {Vec3f(x + 6.0F, -32.0F, -2.0F), 9.0F},
                                {Vec3f(x, -46.0F, -12.0F), 13.5F},
                                {Vec3f(x - 4.0F, -60.0F, -24.0F), 14.5F},
                                {Vec3f(x - 6.0F, -68.0F, -32.0F), 12.0F}}));
  const std::uint8_t label = anatomy.label("gallbladder");
  anatomy.add({"gallbladder", warped(gallbladder.bounds()),
               [=](const Place& place) { return smooth_max(gallbladder.distance(place.q), place.cavity + 5.0F, 3.0F); },
               [=](const Place&, float distance, const Brush& brush) {
                 return Paint{mix(75.0F, 9.0F, brush.cover(distance + 1.6F)), label};
               }});
}

}  // namespace trocar::anatomy::phantom
