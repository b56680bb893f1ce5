#include "phantom/liver.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "phantom/structure.h"

namespace trocar::phantom {
namespace {

constexpr float kBileHu = 8.0F, kWallHu = 70.0F, kHepaticArteryHu = 150.0F, kTumourHu = 78.0F;
constexpr float kLeastRadius = 0.5F;
constexpr float kArteryShare = 0.24F;
constexpr float kBesideVeinMm = 0.4F;
constexpr float kCysticRadius = 1.6F;
constexpr double kNormalDiameter = 4.0;

struct Companion {
  Vec3f beside;                        ///< Direction from the vein.
  std::function<float(float)> radius;  ///< Of the vein's radius.
};

/// A tree that runs beside another one. Pieces whose radius differs are joined where the veins join.
std::vector<Cone> companions(const std::vector<Cone>& veins, const Companion& companion) {
  const auto moved_end = [&](const Vec3f& p, float vein) -> Vec3f {
    return p + companion.beside * (vein + companion.radius(vein) + kBesideVeinMm);
  };
  std::vector<Cone> tree;
  for (std::size_t n = 0; n < veins.size(); ++n) {
    const Cone& vein = veins[n];
    const float radius = companion.radius(vein.radius_b);
    if (radius < kLeastRadius) continue;
    const Cone piece{moved_end(vein.a, vein.radius_a), moved_end(vein.b, vein.radius_b), radius, radius};
    // The parent ends where this piece begins, at the distance of its own radius.
    for (std::size_t m = 0; m < n; ++m)
      if ((veins[m].b - vein.a).squaredNorm() < 1e-6F && veins[m].radius_b != vein.radius_a) {
        tree.push_back({moved_end(veins[m].b, veins[m].radius_b), piece.a, radius, radius});
        break;
      }
    tree.push_back(piece);
  }
  return tree;
}

float dilation(const BodyParameters& body) {
  return static_cast<float>(body.duct_diameter_mm / kNormalDiameter);
}

/// Share of the portal vein's radius; central ducts widen more than peripheral ones.
float duct_radius(float vein, float dilated) {
  const float share = 0.3F * (1.0F + 0.75F * (dilated - 1.0F));
  return std::min(share, 1.1F) * std::pow(vein, 0.95F);
}

struct OutsideDuct {
  std::vector<Cone> cones;
  Vec3f closed_at;
};

/// From the confluence to the papilla: wide above an obstruction, narrow below it.
OutsideDuct outside_duct(const Anatomy& anatomy) {
  const BileDuctData& data = anatomy.data.bile_duct;
  const BodyParameters& body = anatomy.body;
  const auto wide = static_cast<float>(0.5 * body.duct_diameter_mm);
  std::vector<Knot> knots;
  for (const Vec3f& p : data.course) knots.push_back({p, wide});
  std::vector<Cone> cones = chain(knots);
  OutsideDuct duct{{}, data.course.back()};
  for (std::size_t n = 0; n < cones.size(); ++n) {
    const float share = (static_cast<float>(n) + 0.5F) / static_cast<float>(cones.size());
    const bool is_below = body.has_obstruction && share > static_cast<float>(body.obstruction_share);
    if (is_below) cones[n].radius_a = cones[n].radius_b = data.narrow_radius_mm;
    if (!is_below) duct.closed_at = cones[n].b;
  }
  const auto joins = static_cast<std::size_t>(kCysticDuctShare * static_cast<float>(cones.size()));
  const Vec3f to = cones[joins].a;
  cones.push_back({gallbladder_neck(anatomy), to, kCysticRadius, kCysticRadius});
  duct.cones = std::move(cones);
  return duct;
}

void add_duct_structure(Anatomy& anatomy, const std::string& name, const Tube& tube,
                        std::function<float(const Place&)> distance) {
  const std::uint8_t label = anatomy.label("bile_ducts");
  anatomy.add({name, warped(tube.bounds()), std::move(distance), [=](const Place&, float d, const Brush& brush) {
                 return Paint{mix(kWallHu, kBileHu, brush.cover(d + 0.5F)), label};
               }});
}

void add_arteries(Anatomy& anatomy, const std::vector<Cone>& veins) {
  const Companion artery{anatomy.data.bile_duct.artery_beside, [](float vein) { return kArteryShare * vein; }};
  const Tube tree(companions(veins, artery));
  if (tree.empty()) return;
  const std::uint8_t label = anatomy.label("hepatic_artery");
  const Structure& liver = anatomy.find("liver");
  anatomy.add({"hepatic_artery", tree.bounds(),
               [tree, outside = liver.distance](const Place& place) {
                 return std::max(tree.distance(place.p), outside(place) + 0.8F);
               },
               [=](const Place&, float, const Brush&) {
                 return Paint{kHepaticArteryHu, label};
               }});
}

void add_tumour(Anatomy& anatomy, const Vec3f& centre_q) {
  const float radius = anatomy.data.bile_duct.tumour_radius_mm;
  const auto& noise = anatomy.noise;
  anatomy.add_plain(
      "tumor", warped(Box::around(centre_q, Vec3f::Constant(radius + 2.0F))),
      [=, &noise](const Place& place) { return (place.q - centre_q).norm() - radius + 1.6F * noise(place.p / 6.0F); },
      kTumourHu, 6.0F, 6.0F);
}

}  // namespace

DuctTree add_bile_ducts(Anatomy& anatomy, const std::vector<Cone>& portal_veins) {
  add_arteries(anatomy, portal_veins);
  const float dilated = dilation(anatomy.body);
  const Companion duct{anatomy.data.bile_duct.beside, [dilated](float vein) { return duct_radius(vein, dilated); }};
  std::vector<Cone> tree = companions(portal_veins, duct);
  OutsideDuct outside = outside_duct(anatomy);
  if (!tree.empty()) {
    // The confluence joins the two parts.
    const Vec3f confluence = anatomy.unwarped(outside.cones.front().a);
    tree.push_back({confluence, tree.front().a, outside.cones.front().radius_a, tree.front().radius_a});
  }
  DuctTree ducts{Tube(std::move(tree)), Tube(std::move(outside.cones))};
  if (anatomy.body.has_obstruction) add_tumour(anatomy, outside.closed_at);
  add_duct_structure(anatomy, "bile_duct_outside", ducts.outside,
                     [tube = ducts.outside](const Place& place) { return tube.distance(place.q); });
  add_duct_structure(anatomy, "bile_ducts", ducts.inside,
                     [tube = ducts.inside](const Place& place) { return tube.distance(place.p); });
  return ducts;
}

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

namespace {

/// Positive to the patient's left of the upright plane through two points.
float left_of(const Vec3f& p, const Vec3f& from, const Vec3f& to) {
  const Vec3f way = to - from;
  return (way.x() * (p.y() - from.y()) - way.y() * (p.x() - from.x())) / std::hypot(way.x(), way.y());
}

// Where the right hepatic vein points to, from the vena cava: forwards and to the right.
const Vec3f kRightVein(-85.0F, -38.0F, 0.0F);
constexpr float kCaudateMm = 24.0F;

}  // namespace

std::string_view liver_segment(const Anatomy& anatomy, const Place& place) {
  const LiverData& liver = anatomy.data.liver;
  const Vec3f cava = liver.venous_confluence;
  const Vec3f& q = place.q;
  const Vec3f gallbladder(
      0.5F * static_cast<float>(anatomy.data.gallbladder.x_mm.low + anatomy.data.gallbladder.x_mm.high),
      anatomy.data.gallbladder.course.back().p.y(), 0.0F);
  const Vec3f fissure(liver.fissure_x_mm, gallbladder.y(), 0.0F);
  const bool is_upper = q.z() > liver.hilum.z() + 0.25F * (liver.hilum.y() - q.y());
  if (std::hypot(q.x() - cava.x() - 14.0F, q.y() - cava.y()) < kCaudateMm && q.y() > liver.hilum.y()) return "I";
  if (left_of(q, cava, gallbladder) > 0.0F) {
    if (left_of(q, cava, fissure) < 0.0F) return "IV";
    return is_upper ? "II" : "III";
  }
  const bool is_in_front = left_of(q, cava, cava + kRightVein) > 0.0F;
  if (is_in_front) return is_upper ? "VIII" : "V";
  return is_upper ? "VII" : "VI";
}

}  // namespace trocar::phantom
