#include "anatomy/phantom/bile_ducts.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace trocar::anatomy::phantom {
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

}  // namespace trocar::anatomy::phantom
