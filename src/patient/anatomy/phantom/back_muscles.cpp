#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/phantom/skeleton.h"
#include "anatomy/phantom/structure.h"

namespace trocar::anatomy::phantom {
namespace {

// sign: -1 for the right side, 1 for the left.
std::string side_of(float sign) {
  return sign < 0.0F ? "_right" : "_left";
}

/// Multifidus next to the spinous processes, longissimus and iliocostalis outside it, with a cleft of fat in between.
void add_erector_spinae(Anatomy& anatomy, float sign) {
  const std::uint8_t fat = anatomy.label("fat");
  const auto& noise = anatomy.noise;
  const std::string side = side_of(sign);
  const std::uint8_t erector = anatomy.label("autochthon" + side);
  const auto bellies = [=](const Place& place) {
    const float x = sign * place.p.x();
    const float thoracic = smooth_step(-20.0F, 90.0F, place.p.z());
    const float y = place.p.y() - spine_y(place.p.z());
    const float multifidus = elliptic_cylinder(x - 13.5F, y - 47.0F, 12.0F, 16.5F);
    const float outer = elliptic_cylinder(x - 37.0F + 2.0F * thoracic, y - mix(54.0F, 57.0F, thoracic),
                                          mix(29.0F, 25.0F, thoracic), mix(20.0F, 15.0F, thoracic));
    return std::pair{multifidus, outer};
  };
  const Box back{Vec3f(sign < 0.0F ? -75.0F : 0.0F, 40.0F, -kHalfHeight - 5.0F),
                 Vec3f(sign < 0.0F ? 0.0F : 75.0F, 130.0F, kHalfHeight + 5.0F)};
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
  const std::vector<Knot> knots{{Vec3f(22.0F, 24.0F, 26.0F), 5.0F},
                                {Vec3f(28.0F, 26.0F, -2.0F), 11.0F},
                                {Vec3f(34.0F, 27.0F, -32.0F), 15.5F},
                                {Vec3f(40.0F, 25.0F, -70.0F), 19.5F},
                                {Vec3f(45.0F, 20.0F, -125.0F), 22.5F}};
  const Tube psoas(chain(sign < 0.0F ? mirrored(knots) : knots));
  anatomy.add_plain(
      "iliopsoas" + side, warped(psoas.bounds()), [=](const Place& place) { return psoas.distance(place.q); }, 62.0F,
      9.0F, 6.0F);
}

void add_quadratus_lumborum(Anatomy& anatomy, float sign) {
  const Vec3f quadratus(sign * 64.0F, 59.0F, 0.0F);
  anatomy.add_plain(
      "muscle", warped(Box{Vec3f(quadratus.x() - 28.0F, 40.0F, -125.0F), Vec3f(quadratus.x() + 28.0F, 80.0F, 28.0F)}),
      [=](const Place& place) {
        const float widening = smooth_step(30.0F, -60.0F, place.p.z());
        const Vec3f u = place.q - quadratus;
        const float slanted = u.y() + 0.18F * sign * u.x();
        const float belly = elliptic_cylinder(u.x(), slanted, 14.0F + 9.0F * widening, 5.0F + 3.5F * widening);
        return smooth_max(belly, place.p.z() - 22.0F, 4.0F);
      },
      60.0F, 9.0F, 6.0F);
}

/// The crura of the diaphragm next to the aorta.
void add_crus(Anatomy& anatomy, float sign) {
  const std::vector<Knot> crus_knots{{Vec3f(20.0F, -2.0F, 66.0F), 4.5F},
                                     {Vec3f(19.0F, 4.0F, 45.0F), 5.0F},
                                     {Vec3f(17.0F, 10.0F, 15.0F), 4.5F},
                                     {Vec3f(14.0F, 12.0F, -18.0F), 3.0F}};
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
