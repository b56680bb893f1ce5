#include "anatomy/phantom/vessel_tree.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace trocar::anatomy::phantom {
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

}  // namespace trocar::anatomy::phantom
