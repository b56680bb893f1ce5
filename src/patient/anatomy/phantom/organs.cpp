#include <algorithm>
#include <cmath>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kRenalFatHu = -98.0F;
const Vec3f kKidneyReach(52.0F, 48.0F, 74.0F);  ///< The kidney's fat lies within it around the centre, mm.

/// Kidney in its own frame: x away from the spine, y posterior, z up, the origin in its centre.
struct KidneyShape {
  const KidneyData& data;
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
    const float bean = ellipsoid(u, data.radii_mm);
    const float hilum = ellipsoid(u - data.hilum_centre, data.hilum_radii_mm);
    return smooth_max(bean, -hilum, 9.0F) * scale;
  }
  float sinus(const Vec3f& u) const { return ellipsoid(u - data.sinus_centre, data.sinus_radii_mm) * scale; }
  /// Pyramids around the sinus, with their tips in it.
  float pyramids(const Vec3f& u, float wobble) const {
    const float along = std::cos(u.z() * 0.36F + wobble);
    const float around = std::cos(std::atan2(u.y(), u.x() - data.sinus_centre.x()) * 4.0F + 1.6F * wobble);
    return (0.15F - 0.6F * along - 0.5F * around) * 5.0F;
  }
};

/// Over the upper pole of a kidney, medially.
void add_adrenal_gland(Anatomy& anatomy, const Vec3f& kidney_centre, float sign) {
  const AdrenalGlandData& data = anatomy.data.adrenal_glands;
  const Vec3f top = kidney_centre + Vec3f(sign * data.top.x(), data.top.y(), data.top.z());
  const Tube gland(chain(moved(sign < 0.0F ? mirrored(data.course) : data.course, top)));
  anatomy.add_plain(
      "adrenal_gland" + side_of(sign), warped(gland.bounds()),
      [=](const Place& place) { return gland.distance(place.q); }, 85.0F);
}

void add_kidney(Anatomy& anatomy, float sign) {
  const std::string side = side_of(sign);
  Random random = anatomy.random("kidney" + side);
  const KidneyData& data = anatomy.data.kidneys;
  const Vec3f centre = varied(random, sign < 0.0F ? data.right_centre : data.left_centre, data.spread_mm);
  const KidneyShape shape{data, centre, sign, data.size.draw(random)};
  const auto& noise = anatomy.noise;
  const std::uint8_t fat = anatomy.label("fat");
  const Box bounds = warped(Box::around(centre, kKidneyReach));
  const auto outline = [=, &noise](const Place& place) {
    return shape.outline(shape.local(place.q)) + 1.3F * noise(place.p / 17.0F);
  };
  // Fat of the capsule, thicker behind, inside a thin fascia.
  const auto capsule = [=](const Place& place) {
    const Vec3f u = shape.local(place.q);
    return ellipsoid(u - shape.data.capsule_centre, shape.data.capsule_radii_mm) * shape.scale;
  };
  anatomy.add({"perirenal_fat", bounds,
               [=](const Place& place) { return std::max(capsule(place), place.cavity + 2.5F); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float fascia = brush.cover(std::abs(distance + 1.2F) - 0.35F);
                 const float strands = noise(place.p / 7.0F) / 0.10F;
                 const float stranding = 35.0F * std::max(0.0F, 1.0F - strands * strands);
                 return Paint{mix(kRenalFatHu, -25.0F, fascia) + 0.6F * stranding, fat};
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
         const float content = mix(kRenalFatHu + 15.0F, 35.0F, smooth_step(-0.1F, 0.25F, calyces));
         hu = mix(hu, content, brush.cover(sinus));
         return Paint{hu, label};
       }});
  add_adrenal_gland(anatomy, centre, sign);
}

}  // namespace

void add_kidneys(Anatomy& anatomy) {
  add_kidney(anatomy, -1.0F);
  add_kidney(anatomy, 1.0F);
}

void add_spleen(Anatomy& anatomy) {
  Random random = anatomy.random("spleen");
  const SpleenData& data = anatomy.data.spleen;
  const Vec3f centre = varied(random, data.centre, data.spread_mm);
  const Vec3f radii = data.radii_mm * data.size.draw(random);
  const auto& noise = anatomy.noise;
  const float fluid_mm = 6.0F * floating_share(anatomy.body);  // free fluid between spleen and wall
  anatomy.add_plain(
      "spleen", warped(Box::around(centre, radii)),
      [=, &noise, &data](const Place& place) {
        const Vec3f u = place.q - centre;
        const Vec3f turned(u.x() + 0.15F * u.z(), u.y() - 0.2F * u.z(), u.z());
        const float bulk = ellipsoid(turned, radii);
        const float hollow = ellipsoid(u - data.hollow_centre, data.hollow_radii_mm);
        const float carved = smooth_max(bulk, -hollow, 14.0F);
        const float under = smooth_max(carved, place.diaphragm + 3.6F, 5.0F);
        return smooth_max(under, place.cavity + 3.2F + fluid_mm, 5.0F) + 1.6F * noise(place.p / 24.0F);
      },
      118.0F, 4.0F, 9.0F);
}

void add_pancreas(Anatomy& anatomy) {
  Random random = anatomy.random("pancreas");
  const PancreasData& data = anatomy.data.pancreas;
  const Tube tube(chain(moved(data.course, varied(random, Vec3f::Zero(), data.spread_mm))));
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
