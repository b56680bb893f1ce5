#include <algorithm>
#include <cmath>
#include <numbers>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kFatHu = -98.0F;

Vec3f vary(Random& random, const Vec3f& centre, float spread) {
  const auto one = [&](float c) { return c + static_cast<float>(random.uniform(-spread, spread)); };
  const float x = one(centre.x());
  const float y = one(centre.y());
  return {x, y, one(centre.z())};
}

/// Kidney in its own frame: x away from the spine, y posterior, z up, the origin in its centre.
struct KidneyShape {
  Vec3f centre;
  float sign;  ///< -1 right, 1 left.
  float scale;

  Vec3f local(const Vec3f& q) const {
    const Vec3f u = (q - centre) / scale;
    const float x = sign * u.x();
    const float turned_x = 0.82F * x + 0.57F * u.y();  // the hilum faces forward and inward
    const float turned_y = -0.57F * x + 0.82F * u.y();
    return {turned_x + 0.20F * u.z(), turned_y - 0.06F * u.z(), u.z()};  // upper pole inward and back
  }
  float outline(const Vec3f& u) const {
    const float bean = ellipsoid(u, Vec3f(26.0F, 22.5F, 54.0F));
    const float hilum = ellipsoid(u - Vec3f(-30.0F, 0.0F, 0.0F), Vec3f(17.0F, 12.0F, 22.0F));
    return smooth_max(bean, -hilum, 9.0F) * scale;
  }
  float sinus(const Vec3f& u) const {
    return ellipsoid(u - Vec3f(-15.0F, 0.0F, 0.0F), Vec3f(14.0F, 6.5F, 25.0F)) * scale;
  }
  /// Pyramids around the sinus, with their tips in it.
  float pyramids(const Vec3f& u, float wobble) const {
    const float along = std::cos(u.z() * 0.36F + wobble);
    const float around = std::cos(std::atan2(u.y(), u.x() + 15.0F) * 4.0F + 1.6F * wobble);
    return (0.15F - 0.6F * along - 0.5F * around) * 5.0F;
  }
};

void add_kidney(Anatomy& anatomy, float sign) {
  const std::string side = sign < 0.0F ? "_right" : "_left";
  Random random = anatomy.random("kidney" + side);
  const Vec3f centre = vary(random, sign < 0.0F ? Vec3f(-64.0F, 33.0F, -26.0F) : Vec3f(64.0F, 32.0F, -12.0F), 3.0F);
  const KidneyShape shape{centre, sign, static_cast<float>(random.uniform(0.99, 1.07))};
  const auto& noise = anatomy.noise;
  const std::uint8_t fat = anatomy.label("fat");
  const Box bounds = warped(Box::around(centre, Vec3f(52.0F, 48.0F, 74.0F)));
  const auto outline = [=, &noise](const Place& place) {
    return shape.outline(shape.local(place.q)) + 1.3F * noise(place.p / 17.0F);
  };
  // Fat of the capsule, thicker behind, inside a thin fascia.
  const auto capsule = [=](const Place& place) {
    const Vec3f u = shape.local(place.q);
    return ellipsoid(u - Vec3f(-2.0F, 3.0F, 0.0F), Vec3f(36.0F, 31.0F, 68.0F)) * shape.scale;
  };
  anatomy.add({"perirenal_fat", bounds,
               [=](const Place& place) { return std::max(capsule(place), place.cavity + 2.5F); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float fascia = brush.cover(std::abs(distance + 1.2F) - 0.35F);
                 const float strands = noise(place.p / 7.0F) / 0.10F;
                 const float stranding = 35.0F * std::max(0.0F, 1.0F - strands * strands);
                 return Paint{mix(kFatHu, -25.0F, fascia) + 0.6F * stranding, fat};
               }});
  const std::uint8_t label = anatomy.label("kidney" + side);
  anatomy.add(
      {"kidney" + side, bounds, [=](const Place& place) { return std::max(outline(place), place.cavity + 3.0F); },
       [=, &noise](const Place& place, float distance, const Brush& brush) {
         const Vec3f u = shape.local(place.q);
         const float medulla = brush.cover(std::max(shape.pyramids(u, 2.2F * noise(place.p / 22.0F)), distance + 6.0F));
         float hu = mix(182.0F + 5.0F * noise(place.p / 6.0F), 157.0F, medulla);
         const float sinus = shape.sinus(u) + 2.0F * noise(place.p / 8.0F);
         const float calyces = noise(place.p / 7.5F);
         const float content = mix(kFatHu + 15.0F, 35.0F, smooth_step(-0.1F, 0.25F, calyces));
         hu = mix(hu, content, brush.cover(sinus));
         return Paint{hu, label};
       }});
  // Adrenal gland: a thin limb over the upper pole, medially.
  const Vec3f top = centre + Vec3f(-sign * 24.0F, -4.0F, 52.0F);
  const Tube gland(chain({{top + Vec3f(sign * 6.0F, 18.0F, -8.0F), 1.8F},
                          {top + Vec3f(0.0F, 4.0F, 0.0F), 2.6F},
                          {top + Vec3f(-sign * 1.0F, -6.0F, 4.0F), 3.0F},
                          {top + Vec3f(-sign * 4.0F, 10.0F, -4.0F), 2.0F}}));
  anatomy.add_plain(
      "adrenal_gland" + side, warped(gland.bounds()), [=](const Place& place) { return gland.distance(place.q); },
      85.0F);
}

}  // namespace

void add_kidneys(Anatomy& anatomy) {
  add_kidney(anatomy, -1.0F);
  add_kidney(anatomy, 1.0F);
}

void add_spleen(Anatomy& anatomy) {
  Random random = anatomy.random("spleen");
  const Vec3f centre = vary(random, Vec3f(106.0F, 34.0F, 36.0F), 3.0F);
  const Vec3f radii = Vec3f(46.0F, 60.0F, 60.0F) * static_cast<float>(random.uniform(0.94, 1.06));
  const auto& noise = anatomy.noise;
  anatomy.add_plain(
      "spleen", warped(Box::around(centre, radii)),
      [=, &noise](const Place& place) {
        const Vec3f u = place.q - centre;
        const Vec3f turned(u.x() + 0.15F * u.z(), u.y() - 0.2F * u.z(), u.z());
        const float bulk = ellipsoid(turned, radii);
        const float hollow = ellipsoid(u - Vec3f(-56.0F, -24.0F, 0.0F), Vec3f(46.0F, 52.0F, 70.0F));
        const float carved = smooth_max(bulk, -hollow, 14.0F);
        const float under = smooth_max(carved, place.diaphragm + 3.6F, 5.0F);
        return smooth_max(under, place.cavity + 3.2F, 5.0F) + 1.6F * noise(place.p / 24.0F);
      },
      118.0F, 4.0F, 9.0F);
}

void add_pancreas(Anatomy& anatomy) {
  Random random = anatomy.random("pancreas");
  const Vec3f shift = vary(random, Vec3f::Zero(), 3.0F);
  const Tube tube(chain({{shift + Vec3f(-30.0F, -18.0F, -34.0F), 11.0F},
                         {shift + Vec3f(-28.0F, -24.0F, -16.0F), 15.0F},
                         {shift + Vec3f(-10.0F, -32.0F, -6.0F), 10.5F},
                         {shift + Vec3f(14.0F, -32.0F, 2.0F), 10.0F},
                         {shift + Vec3f(42.0F, -18.0F, 12.0F), 11.0F},
                         {shift + Vec3f(66.0F, 0.0F, 22.0F), 10.0F}}));
  const std::uint8_t label = anatomy.label("pancreas");
  const auto& noise = anatomy.noise;
  anatomy.add({"pancreas", warped(tube.bounds()),
               [=, &noise](const Place& place) {
                 return tube.distance(place.q) + 1.7F * noise(place.p / 5.0F) + 1.2F * noise(place.p / 11.0F);
               },
               [=, &noise](const Place& place, float distance, const Brush&) {
                 // Fat between the lobules from outside.
                 const float lobules =
                     smooth_step(0.15F, 0.6F, noise(place.p / 4.2F)) * smooth_step(-9.0F, 0.0F, distance);
                 return Paint{mix(103.0F, 10.0F, lobules), label};
               }});
}

}  // namespace trocar::anatomy::phantom
