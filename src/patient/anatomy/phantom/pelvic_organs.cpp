#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
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

}  // namespace trocar::anatomy::phantom
