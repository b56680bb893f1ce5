#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kAcrossMm = 45.0F;  ///< A crooked spine brings the muscles of a side over the midline.

/// Multifidus next to the spinous processes, longissimus and iliocostalis outside it, with a cleft of fat in between.
void add_erector_spinae(Anatomy& anatomy, float sign) {
  const std::uint8_t fat = anatomy.label("fat");
  const auto& noise = anatomy.noise;
  const std::string side = side_of(sign);
  const std::uint8_t erector = anatomy.label("autochthon" + side);
  const auto bellies = [sign, &data = anatomy.data.back_muscles](const Place& place) {
    const float x = sign * place.spine.x();
    const float thoracic = data.chest_z.share(place.spine.z());
    const float y = place.spine.y();
    const Ellipse& inner = data.multifidus;
    const Ellipse& low = data.outer_lumbar;
    const Ellipse& high = data.outer_thoracic;
    const float multifidus = elliptic_cylinder(x - inner.x, y - inner.y, inner.radius_x, inner.radius_y);
    const float outer =
        elliptic_cylinder(x - low.x + (low.x - high.x) * thoracic, y - mix(low.y, high.y, thoracic),
                          mix(low.radius_x, high.radius_x, thoracic), mix(low.radius_y, high.radius_y, thoracic));
    return std::pair{multifidus, outer};
  };
  Box back = whole_box();
  (sign < 0.0F ? back.high : back.low).x() = -sign * kAcrossMm;
  back.low.y() = 20.0F;
  anatomy.add({"autochthon" + side, back,
               [=](const Place& place) {
                 const auto [multifidus, outer] = bellies(place);
                 return std::max(std::min(multifidus, outer) - 1.6F, place.wall + 0.3F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const auto [multifidus, outer] = bellies(place);
                 const float cleft = std::abs(multifidus - outer) * 0.5F - 0.6F;
                 const float border = std::max(distance + 1.4F, -cleft);
                 const float streaks = noise(place.p.cwiseQuotient(Vec3f(6.0F, 6.0F, 26.0F)));
                 const float hu = 60.0F - 75.0F * smooth_step(0.42F, 0.75F, streaks) + 8.0F * noise(place.p / 4.0F);
                 return Paint{mix(-92.0F, hu, brush.cover(border)), border < 0.0F ? erector : fat};
               }});
}

void add_psoas(Anatomy& anatomy, float sign) {
  const std::string side = side_of(sign);
  const Course& knots = anatomy.data.back_muscles.psoas;
  const Tube psoas(chain(sign < 0.0F ? mirrored(knots) : knots));
  anatomy.add_plain(
      "iliopsoas" + side, warped(psoas.bounds()), [=](const Place& place) { return psoas.distance(place.q); }, 62.0F,
      9.0F, 6.0F);
}

void add_quadratus_lumborum(Anatomy& anatomy, float sign) {
  const BackMuscleData::QuadratusLumborum& data = anatomy.data.back_muscles.quadratus_lumborum;
  const Vec3f quadratus(sign * data.x_mm, data.y_mm, 0.0F);
  anatomy.add_plain(
      "muscle", warped(Box{Vec3f(quadratus.x() - 28.0F, 40.0F, -140.0F), Vec3f(quadratus.x() + 28.0F, 80.0F, 28.0F)}),
      [=, &data](const Place& place) {
        const float widening = data.wider_z.share(place.p.z());
        const Vec3f u = place.q - quadratus;
        const float slanted = u.y() + data.slant * sign * u.x();
        const float belly = elliptic_cylinder(u.x(), slanted, data.upper_radii_mm[0] + data.wider_mm[0] * widening,
                                              data.upper_radii_mm[1] + data.wider_mm[1] * widening);
        return smooth_max(belly, place.p.z() - data.top_z_mm, 4.0F);
      },
      60.0F, 9.0F, 6.0F);
}

/// The crura of the diaphragm next to the aorta.
void add_crus(Anatomy& anatomy, float sign) {
  const Course& crus_knots = anatomy.data.back_muscles.crus;
  const Tube crus(chain(sign < 0.0F ? mirrored(crus_knots) : crus_knots));
  anatomy.add_plain(
      "muscle", warped(crus.bounds()), [=](const Place& place) { return crus.distance(place.q); }, 62.0F);
}

}  // namespace

void add_back_muscles(Anatomy& anatomy) {
  for (const float sign : {-1.0F, 1.0F}) {
    add_erector_spinae(anatomy, sign);
    add_psoas(anatomy, sign);
    add_quadratus_lumborum(anatomy, sign);
    add_crus(anatomy, sign);
  }
}

}  // namespace trocar::anatomy::phantom
