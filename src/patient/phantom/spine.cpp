#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "phantom/skeleton.h"
#include "phantom/structure.h"

namespace trocar::phantom {
namespace {

constexpr float kBelowL5Mm = 34.0F;  ///< From the middle of L5 to that of S1.

// The sacrum in coordinates along the spine.
constexpr float kSacrumTop = -151.0F, kSacrumEnd = -256.0F;
constexpr float kCanalEnd = -238.0F;
constexpr float kCanalTaper = -142.0F;

/// The arch and its processes, around the vertebral body's centre. Spinous processes are made lower or higher so that
/// the spaces between them become `interspace_share` of the usual.
Tube vertebral_arch(const VertebraData& data, float interspace_share) {
  constexpr float kGapMm = 11.0F;  ///< Between two spinous processes of the reference.
  constexpr float kCaudalShare = 0.6F;
  const float longer = (1.0F - interspace_share) * kGapMm;
  std::vector<Cone> cones;
  for (const Cone& cone : data.paired)
    for (const float sign : {-1.0F, 1.0F})
      cones.push_back({Vec3f(sign * cone.a.x(), cone.a.y(), cone.a.z()),
                       Vec3f(sign * cone.b.x(), cone.b.y(), cone.b.z()), cone.radius_a, cone.radius_b});
  for (const Cone& cone : data.spinous)
    for (const float offset : {kCaudalShare * -longer, 0.0F, (1.0F - kCaudalShare) * longer}) {
      const Vec3f shift(0.0F, 0.0F, offset);
      cones.push_back({cone.a + shift, cone.b + shift, cone.radius_a, cone.radius_b});
      if (longer == 0.0F) break;
    }
  return Tube(std::move(cones));
}

float vertebral_body(const SpineData& spine, const Vec3f& u, float half_height, float size) {
  const float waist = spine.body_waist_mm * (1.0F - clamp01(u.z() * u.z() / (half_height * half_height)));
  const float outline = elliptic_cylinder(u.x(), u.y(), (spine.body_half_width_mm - waist) * size,
                                          (spine.body_half_depth_mm - waist) * size);
  const float hollow_back = spine.body_hollow[1] - std::hypot(u.x(), u.y() - spine.body_hollow[0] * size);
  return smooth_max(smooth_max(outline, hollow_back, 4.0F), std::abs(u.z()) - half_height, 3.0F);
}

float below(const SpineData& spine, int level) {
  return level == kL5 ? spine.height(kL5) - kBelowL5Mm : spine.height(level + 1);
}

/// Bounds in P of a region around a point of the spine, given along it.
Box bounds_along(const SpineCurve& spine, const Vec3f& middle, const Vec3f& half) {
  Box box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f sign((corner & 1) != 0 ? 1.0F : -1.0F, (corner & 2) != 0 ? 1.0F : -1.0F,
                     (corner & 4) != 0 ? 1.0F : -1.0F);
    box.add(spine.bend(middle + half.cwiseProduct(sign)), 3.0F);
  }
  return box;
}

void add_vertebra(Anatomy& anatomy, int level) {
  const bool lumbar = level > kT12;
  const SpineData& spine = anatomy.data.spine;
  const VertebraData& data = lumbar ? anatomy.data.lumbar_vertebra : anatomy.data.thoracic_vertebra;
  const std::string name =
      lumbar ? "vertebrae_L" + std::to_string(level - kT12) : "vertebrae_T" + std::to_string(level + 5);
  const float z = spine.height(level);
  const float half_height = 0.25F * (spine.height(level - 1) - below(spine, level)) - data.half_disc_mm;
  const float size = data.size;
  const Tube arch = vertebral_arch(data, lumbar ? static_cast<float>(anatomy.body.interspace_share) : 1.0F);
  const std::uint8_t label = anatomy.label(name);
  const auto& noise = anatomy.noise;
  const float density = marrow_share(anatomy.body);
  const Vec3f middle(0.0F, 22.0F, z - 5.0F);
  anatomy.add({name, bounds_along(anatomy.torso.spine(), middle, Vec3f(44.0F, 44.0F, 36.0F)),
               [=, &spine](const Place& place) {
                 const Vec3f u = place.spine - Vec3f(0.0F, 0.0F, z);
                 const float solid = smooth_min(vertebral_body(spine, u, half_height, size), arch.distance(u), 4.0F);
                 return smooth_max(solid, -canal(spine, place.spine), 1.5F);
               },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const Vec3f u = place.spine - Vec3f(0.0F, 0.0F, z);
                 const float behind = smooth_step(12.0F, 22.0F, u.y());
                 const float marrow = density * mix(200.0F, 330.0F, behind) + 55.0F * noise(place.p / 3.5F);
                 const float vein = brush.cover(std::hypot(u.z(), u.x() * 0.4F) - 2.0F) *
                                    smooth_step(2.0F, 14.0F, u.y()) * (1.0F - behind);
                 return bone(distance, mix(1.1F, 1.6F, behind), mix(560.0F, 830.0F, behind), marrow - 110.0F * vein,
                             label, brush);
               }});
}

/// The sacrum: fused bodies, wings beside them, the wall behind the canal with its crest, and four pairs of openings.
class Sacrum {
 public:
  explicit Sacrum(const SpineData& spine) : spine_(spine) {
    std::vector<Cone> crest{{Vec3f(0, 33, -160), Vec3f(0, 27, -200), 5.0F, 4.5F},
                            {Vec3f(0, 27, -200), Vec3f(0, 18, -238), 4.5F, 3.5F},
                            {Vec3f(0, 1, -252), Vec3f(0, 0, -262), 7.0F, 6.0F},
                            {Vec3f(0, 0, -262), Vec3f(0, -1, -282), 5.0F, 3.0F}};
    std::vector<Cone> holes;
    for (const float sign : {-1.0F, 1.0F}) {
      crest.push_back({Vec3f(sign * 17.0F, 25, -154), Vec3f(sign * 16.0F, 24, -164), 6.0F, 4.5F});
      for (int n = 0; n < 4; ++n) {
        const auto down = static_cast<float>(n);
        const float s = -171.0F - 20.5F * down, x = sign * (17.5F - 1.8F * down);
        holes.push_back({Vec3f(x, -20, s), Vec3f(x, 40, s), 4.6F - 0.5F * down, 3.6F - 0.4F * down});
      }
    }
    crest_ = Tube(std::move(crest));
    holes_ = Tube(std::move(holes));
  }

  float distance(const Vec3f& u) const {
    const float down = smooth_step(kSacrumTop, kSacrumEnd, u.z());
    const float half_width = mix(27.0F, 13.0F, down) + 9.0F * bump(u.z(), -200.0F, 26.0F);
    const float half_depth = mix(17.0F, 6.5F, down);
    const float ends = std::max(u.z() - kSacrumTop, kSacrumEnd - u.z());
    const float bodies = smooth_max(elliptic_cylinder(u.x(), u.y() - 1.0F, half_width, half_depth), ends, 4.0F);
    const Vec3f side(std::abs(u.x()), u.y(), u.z());
    const float wings = ellipsoid(side - Vec3f(36.0F, 7.0F, -173.0F), Vec3f(23.0F, 17.0F, 27.0F));
    const float wall = smooth_max(canal(spine_, u) - 4.2F, std::max(u.z() + 155.0F, kCanalEnd - 6.0F - u.z()), 4.0F);
    float d = smooth_min(smooth_min(bodies, wings, 10.0F), smooth_min(wall, crest_.distance(u), 4.0F), 5.0F);
    d = smooth_max(d, -canal(spine_, u), 1.5F);
    return smooth_max(d, -holes_.distance(u), 2.0F);
  }

 private:
  const SpineData& spine_;
  Tube crest_, holes_;
};

}  // namespace

float marrow_share(const BodyParameters& body) {
  constexpr double kReferenceAge = 50.0, kSharePerYear = 0.0125;
  return static_cast<float>(std::clamp(1.0 - kSharePerYear * (body.age_years - kReferenceAge), 0.4, 1.3));
}

CanalSection canal_section(const SpineData& spine, float s_mm) {
  const float down = smooth_step(kCanalTaper, kCanalEnd, s_mm);
  const float wider = 3.0F * bump(s_mm, -158.0F, 26.0F);  // triangular and wide at S1
  return {mix(spine.canal_y_mm, 11.0F, down), mix(spine.canal_radii_mm[0], 4.0F, down) + wider,
          mix(spine.canal_radii_mm[1], 2.2F, down)};
}

float canal(const SpineData& spine, const Vec3f& along) {
  const CanalSection section = canal_section(spine, along.z());
  const float wall = elliptic_cylinder(along.x(), along.y() - section.y, section.radius_x, section.radius_y);
  return std::max(wall, kCanalEnd - along.z());
}

float disc_position(const SpineData& spine, int above) {
  return 0.5F * (spine.height(above) + below(spine, above));
}

float between_laminae(const SpineData& spine, float s_mm) {
  // The window lies a little below the disc.
  constexpr float kBelowDisc = 6.0F, kHalfMm = 11.0F;
  float share = 0.0F;
  for (int above = kT8; above <= kL5; ++above)
    share = std::max(share, bump(s_mm, disc_position(spine, above) - kBelowDisc, kHalfMm));
  return share;
}

void add_discs(Anatomy& anatomy) {
  const SpineData& spine = anatomy.data.spine;
  // Discs lose height with age [assumed: a tenth each 20 years from 40 on]: the end plates thicken instead.
  const float age = static_cast<float>(anatomy.body.age_years);
  const float half_height = spine.disc_half_height_mm * (1.0F - 0.005F * std::max(age - 40.0F, 0.0F));
  const auto disc_distance = [&spine, half_height](const Vec3f& u, int above) {
    const float body = elliptic_cylinder(u.x(), u.y(), spine.body_half_width_mm, spine.body_half_depth_mm);
    return smooth_max(body, std::abs(u.z() - disc_position(spine, above)) - half_height, 2.0F);
  };
  Box box = whole_box();
  box.high.z() = 160.0F;
  anatomy.add_plain(
      "intervertebral_discs", box,
      [=](const Place& place) {
        const Vec3f& u = place.spine;
        if (std::abs(u.x()) > 45.0F || std::abs(u.y()) > 45.0F) return 15.0F;
        float d = 1e6F;
        for (int above = kT8 - 1; above <= kL5; ++above) d = std::min(d, disc_distance(u, above));
        return d;
      },
      88.0F, 8.0F, 8.0F);
}

void add_vertebrae(Anatomy& anatomy) {
  for (int level = kT8 - 1; level <= kL5; ++level)
    if (anatomy.torso.spine().bend(Vec3f(0.0F, 0.0F, anatomy.data.spine.height(level))).z() - 30.0F <
        anatomy.torso.box().high.z())
      add_vertebra(anatomy, level);
}

void add_sacrum(Anatomy& anatomy) {
  if (anatomy.torso.box().low.z() > kSacrumTop + 20.0F) return;
  const Sacrum sacrum(anatomy.data.spine);
  const auto& noise = anatomy.noise;
  const std::uint8_t label = anatomy.label("sacrum");
  const float density = marrow_share(anatomy.body);
  anatomy.add({"sacrum", bounds_along(anatomy.torso.spine(), Vec3f(0.0F, 8.0F, -212.0F), Vec3f(62.0F, 36.0F, 76.0F)),
               [=](const Place& place) { return sacrum.distance(place.spine); },
               [=, &noise](const Place& place, float distance, const Brush& brush) {
                 const float marrow = density * 165.0F + 55.0F * noise(place.p / 4.0F) + 30.0F * noise(place.p / 11.0F);
                 return bone(distance, 1.4F, 640.0F, marrow, label, brush);
               }});
}

void add_spine(Anatomy& anatomy) {
  add_discs(anatomy);
  add_spinal_canal(anatomy);
  add_vertebrae(anatomy);
  add_sacrum(anatomy);
}

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

}  // namespace trocar::phantom
