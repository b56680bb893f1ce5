#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "phantom/biopsy.h"
#include "phantom/liver.h"
#include "phantom/shapes.h"
#include "phantom/structure.h"

namespace trocar::phantom {

/// Growth parameters of a vessel tree.
struct GrowthRule {
  float root_radius_mm = 7.0F;
  float root_share = 0.5F;       ///< Fraction of the distance to the territory's centre at which the root forks.
  float least_radius_mm = 1.2F;  ///< Thinner branches are not grown.
  /// True if a vessel of this radius may run through a point of P.
  std::function<bool(const Vec3f& p, float radius_mm)> allowed;
};

struct VesselRoot {
  Vec3f p;
  Vec3f direction;
};

/// Grows a tree by halving the territory it supplies: a vessel grows towards the centre of its territory and forks
/// there; each daughter supplies one half. Radii follow Murray's law, r^3 = r1^3 + r2^3 (C. D. Murray, PNAS 12:207,
/// 1926), with each daughter's r^3 proportional to its share of the territory. A vessel that violates a constraint
/// tries other bends and lengths, and forks at once if none fits.
std::vector<Cone> grow_tree(const VesselRoot& root, std::vector<Vec3f> territory, const GrowthRule& rule,
                            Random& random);

namespace {

constexpr float kArteryHu = 152.0F;
constexpr float kVeinHu = 160.0F;
constexpr float kPortalHu = 168.0F;

void add_vessel(Anatomy& anatomy, const std::string& label, std::vector<Cone> cones, float hu) {
  const Tube tube(std::move(cones));
  anatomy.add_plain(
      label, warped(tube.bounds()), [=](const Place& place) { return tube.distance(place.q); }, hu, 3.0F, 5.0F);
}

/// The main course of a vessel and its branches.
std::vector<Cone> with_branches(const Course& course, const std::vector<Course>& branches) {
  std::vector<Cone> all = chain(course);
  for (const Course& branch : branches) {
    const std::vector<Cone> cones = chain(branch);
    all.insert(all.end(), cones.begin(), cones.end());
  }
  return all;
}

Course aorta_course(const AortaData& aorta, const SpineCurve& spine) {
  Course course = aorta.chest;
  for (Knot knot : aorta.before_spine) {
    knot.p.y() = spine.y_at(knot.p.z()) - aorta.spine_front_mm - knot.p.y();
    course.push_back(knot);
  }
  return course;
}

/// The angle at which the cavity's surface is this far from the midline, in front.
float front_angle(const TorsoContours& contours, float x, float z) {
  float low = 0.5F * kPi, high = kPi;
  for (int n = 0; n < 24; ++n) {
    const float middle = 0.5F * (low + high);
    (contours.cavity_radius(middle, z) * std::sin(middle) > x ? low : high) = middle;
  }
  return low;
}

void add_epigastric_vessels(Anatomy& anatomy) {
  if (anatomy.torso.box().low.z() > anatomy.data.epigastric.course.front()[1]) return;
  const EpigastricData& data = anatomy.data.epigastric;
  const TorsoContours& contours = anatomy.torso.contours();
  for (const float sign : {-1.0F, 1.0F}) {
    Course course;
    for (const auto& [x, z] : data.course)
      course.push_back({contours.on_cavity(sign * front_angle(contours, x, z), z, data.outward_mm), data.radius_mm});
    const Tube tube(chain(course));
    anatomy.add_plain(
        "epigastric_vessels", tube.bounds(), [=](const Place& place) { return tube.distance(place.p); }, kVeinHu, 3.0F,
        5.0F);
  }
}

/// Points distributed evenly in the liver: the territory of a vessel tree.
std::vector<Vec3f> liver_territory(const Anatomy& anatomy, float depth_mm) {
  const Structure& liver = anatomy.find("liver");
  constexpr float kStepMm = 6.0F;
  std::vector<Vec3f> territory;
  for (float z = liver.bounds.low.z(); z < liver.bounds.high.z(); z += kStepMm)
    for (float y = liver.bounds.low.y(); y < liver.bounds.high.y(); y += kStepMm)
      for (float x = liver.bounds.low.x(); x < liver.bounds.high.x(); x += kStepMm)
        if (const Vec3f p(x, y, z); liver.distance(anatomy.torso.at(p)) < -depth_mm) territory.push_back(p);
  return territory;
}

GrowthRule growth_rule(const TreeData& tree, std::function<bool(const Vec3f&, float)> allowed) {
  return {tree.root_radius_mm, tree.root_share, tree.least_radius_mm, std::move(allowed)};
}

void add_tree(Anatomy& anatomy, const std::string& name, const Tube& tree, float hu) {
  const std::uint8_t label = anatomy.label(name);
  const Structure& liver = anatomy.find("liver");
  anatomy.add({name, tree.bounds(),
               [tree, outside = liver.distance](const Place& place) {
                 return std::max(tree.distance(place.p), outside(place) + 0.8F);
               },
               [=](const Place&, float, const Brush&) {
                 return Paint{hu, label};
               }});
}

}  // namespace

void add_great_vessels(Anatomy& anatomy) {
  const AbdomenData& data = anatomy.data;
  add_vessel(anatomy, "aorta", with_branches(aorta_course(data.aorta, anatomy.torso.spine()), data.aorta.branches),
             kArteryHu);
  add_vessel(anatomy, "inferior_vena_cava", with_branches(data.vena_cava.course, data.vena_cava.branches), kVeinHu);
  add_vessel(anatomy, "portal_vein_and_splenic_vein", with_branches(data.portal_vein.course, data.portal_vein.branches),
             kPortalHu);
  add_epigastric_vessels(anatomy);
}

DuctTree add_liver_vessels(Anatomy& anatomy, const BiopsyPlan& plan) {
  const Structure& liver = anatomy.find("liver");
  const Structure& gallbladder = anatomy.find("gallbladder");
  const auto is_free = [&](const Vec3f& p, float radius) {
    const Place place = anatomy.torso.at(p);
    return liver.distance(place) < -(radius + 2.0F) && gallbladder.distance(place) > radius + 2.0F &&
           !plan.is_in_the_way(p, radius);
  };
  const std::vector<Vec3f> territory = liver_territory(anatomy, 5.0F);

  Random portal_random = anatomy.random("portal_vein");
  const LiverData& gates = anatomy.data.liver;
  const TreeData& portal_data = anatomy.data.portal_tree;
  const Tube portal(grow_tree({anatomy.unwarped(gates.hilum), portal_data.direction.normalized()}, territory,
                              growth_rule(portal_data, is_free), portal_random));
  add_tree(anatomy, "portal_vein", portal, kPortalHu);
  const DuctTree ducts = add_bile_ducts(anatomy, portal.cones());

  Random hepatic_random = anatomy.random("hepatic_veins");
  const TreeData& hepatic_data = anatomy.data.hepatic_tree;
  const auto is_beside_portal = [&](const Vec3f& p, float radius) {
    return is_free(p, radius) && portal.distance(p) > radius + 0.8F && ducts.inside.distance(p) > radius + 0.8F;
  };
  const Tube hepatic(grow_tree({anatomy.unwarped(gates.venous_confluence), hepatic_data.direction.normalized()},
                               territory, growth_rule(hepatic_data, is_beside_portal), hepatic_random));
  add_tree(anatomy, "hepatic_veins", hepatic, kVeinHu);
  return ducts;
}

namespace {

constexpr float kRunShare = 0.55F;  ///< As root_share of the rule, for the daughters.
constexpr int kPieces = 4;
constexpr int kBranchTries = 24;
constexpr std::size_t kLeastPlaces = 4;

class Grower {
 public:
  Grower(const GrowthRule& rule, Random& random) : rule_(rule), random_(random) {}

  void grow(const Vec3f& start, const Vec3f& direction, std::span<Vec3f> territory, float radius, bool is_root) {
    if (radius < rule_.least_radius_mm || territory.size() < kLeastPlaces) return;
    const Vec3f middle = mean(territory);
    // If no run fits, the vessel forks at once: smaller daughters are tried.
    Vec3f fork = start;
    Vec3f heading = direction;
    if (const auto run = find_run(start, direction, middle, radius, is_root)) {
      add_cones(*run, radius);
      fork = run->end;
      heading = (run->end - run->control).normalized();
      is_root = false;
    }
    const auto half = split(territory, heading);
    const auto child_radius = [&](std::size_t places) {
      return radius * std::cbrt(static_cast<float>(places) / static_cast<float>(territory.size()));
    };
    const auto first = territory.first(half);
    const auto second = territory.subspan(half);
    grow(fork, heading, first, child_radius(first.size()), is_root);
    grow(fork, heading, second, child_radius(second.size()), is_root);
  }

  std::vector<Cone> take() { return std::move(cones_); }

 private:
  /// A curved run: a quadratic curve.
  struct Run {
    Vec3f start, control, end;
    Vec3f at(float t) const { return (1 - t) * (1 - t) * start + 2 * t * (1 - t) * control + t * t * end; }
  };

  void add_cones(const Run& run, float radius) {
    Vec3f from = run.start;
    for (int piece = 1; piece <= kPieces; ++piece) {
      const Vec3f to = run.at(static_cast<float>(piece) / kPieces);
      cones_.push_back({from, to, radius, radius});
      from = to;
    }
  }

  static Vec3f mean(std::span<const Vec3f> places) {
    Vec3f sum = Vec3f::Zero();
    for (const Vec3f& p : places) sum += p;
    return sum / static_cast<float>(places.size());
  }

  Vec3f random_offset(float mm) {
    const auto one = [&] { return static_cast<float>(random_.uniform(-mm, mm)); };
    const float x = one();
    const float y = one();
    return {x, y, one()};
  }

  std::optional<Run> find_run(const Vec3f& start, const Vec3f& direction, const Vec3f& middle, float radius,
                              bool is_root) {
    const float share = is_root ? rule_.root_share : kRunShare;
    for (int attempt = 0; attempt < kBranchTries; ++attempt) {
      // Each try is shorter and may bend more.
      const float tried = static_cast<float>(attempt) / kBranchTries;
      const Vec3f way = share * (1.0F - 0.75F * tried) * (middle - start);
      const float length = way.norm();
      if (length < 2.0F) return std::nullopt;
      Run run{start, start + 0.45F * length * direction + random_offset(0.15F * length),
              start + way + random_offset((0.08F + 0.6F * tried) * length)};
      if (is_allowed(run, radius, is_root)) return run;
    }
    return std::nullopt;
  }

  bool is_allowed(const Run& run, float radius, bool is_root) const {
    const int first = is_root ? 11 : 3;  // a root enters from outside; a daughter starts inside its parent
    for (int n = first; n <= 12; ++n)
      if (!rule_.allowed(run.at(static_cast<float>(n) / 12.0F), radius)) return false;
    return true;
  }

  /// Sorts the points into two halves, cut through their centre along the direction of largest spread perpendicular to
  /// the heading; returns the size of the first.
  static std::size_t split(std::span<Vec3f> places, const Vec3f& heading) {
    const Vec3f middle = mean(places);
    Eigen::Matrix3f spread = Eigen::Matrix3f::Zero();
    const Eigen::Matrix3f across = Eigen::Matrix3f::Identity() - heading * heading.transpose();
    for (const Vec3f& p : places) {
      const Vec3f u = across * (p - middle);
      spread += u * u.transpose();
    }
    Vec3f axis = across * Vec3f(0.31F, 0.52F, 0.79F);
    for (int n = 0; n < 20; ++n) axis = (spread * axis).normalized();
    const auto second =
        std::partition(places.begin(), places.end(), [&](const Vec3f& p) { return (p - middle).dot(axis) < 0.0F; });
    return static_cast<std::size_t>(second - places.begin());
  }

  const GrowthRule& rule_;
  Random& random_;
  std::vector<Cone> cones_;
};

}  // namespace

std::vector<Cone> grow_tree(const VesselRoot& root, std::vector<Vec3f> territory, const GrowthRule& rule,
                            Random& random) {
  Grower grower(rule, random);
  grower.grow(root.p, root.direction, territory, rule.root_radius_mm, true);
  return grower.take();
}

}  // namespace trocar::phantom
