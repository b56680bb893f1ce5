#include "registration/matching/ransac.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/random.h"
#include "registration/rigid_fit.h"

namespace trocar::registration {
namespace {

constexpr int kMotionRefinements = 6;
constexpr int kTrialsForEachCandidate = 200;  ///< At least so many per candidate kept.
constexpr double kSameMotion_mm = 6.0;        ///< Motions that move the pairs less apart are the same.

Status check(const RansacOptions& options) {
  const auto refuse = [](const char* what, double value, const char* advice) {
    return fail_usage(fmt::format("{} is out of range", what), fmt::format("{:g}", value), advice);
  };
  if (!(options.inlier_mm >= 0.01 && options.inlier_mm <= 100.0))
    return refuse("the distance of pairs that agree", options.inlier_mm, "give 0.01 to 100 mm");
  if (!(options.certainty >= 0.5 && options.certainty <= 0.999999))
    return refuse("the certainty", options.certainty, "give 0.5 to 0.999999");
  if (options.most_trials < 1 || options.most_trials > 10000000)
    return refuse("the number of trials", options.most_trials, "give 1 to 10000000");
  if (!(options.least_triangle_mm >= 0.0 && options.least_triangle_mm <= 1000.0))
    return refuse("the height of a sample's triangle", options.least_triangle_mm, "give 0 to 1000 mm");
  return {};
}

double least_height_mm(const Vec3& p, const Vec3& q, const Vec3& r) {
  const double longest = std::max({(q - p).norm(), (r - q).norm(), (p - r).norm()});
  return longest > 0.0 ? (q - p).cross(r - p).norm() / longest : 0.0;
}

/// Frame of a triangle: rotation with x along pq and z along the normal.
Mat3 triangle_axes(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 x = (q - p).normalized(), z = x.cross(r - p).normalized();
  Mat3 R;
  R << x, z.cross(x), z;
  return R;
}

class MotionSearch {
 public:
  MotionSearch(std::span<const PointPair> pairs, const RansacOptions& options)
      : pairs_(pairs), options_(options), random_(options.seed) {}

  struct Candidate {
    Pose X_AB;
    std::size_t support = 0;
  };

  /// Candidates of the most support, the best first.
  std::vector<Candidate> run(std::size_t most) {
    double needed = options_.most_trials;
    for (trials_ = 0; trials_ < options_.most_trials && trials_ < needed; ++trials_) {
      const std::optional<Pose> X_AB = draw();
      if (!X_AB) continue;
      const std::size_t support = count(*X_AB);
      if (support < 4 || (candidates_.size() >= most && support <= candidates_.back().support)) continue;
      keep({*X_AB, support}, most);
      needed = std::max<double>(needed_trials(candidates_.front().support),
                                most > 1 ? static_cast<double>(kTrialsForEachCandidate * most) : 0.0);
    }
    return candidates_;
  }
  int trials() const noexcept { return trials_; }

 private:
  /// Motion of three random pairs; empty where their triangles are flat or differ.
  std::optional<Pose> draw() {
    std::array<std::size_t, 3> n;
    for (auto& index : n) index = static_cast<std::size_t>(random_.uniform() * static_cast<double>(pairs_.size()));
    if (n[0] == n[1] || n[1] == n[2] || n[0] == n[2]) return std::nullopt;
    const PointPair &p = pairs_[n[0]], &q = pairs_[n[1]], &r = pairs_[n[2]];
    const double slack = 2.0 * options_.inlier_mm;
    const auto differs = [&](const PointPair& x, const PointPair& y) {
      return std::abs((x.a - y.a).norm() - (x.b - y.b).norm()) > slack;
    };
    if (differs(p, q) || differs(q, r) || differs(r, p)) return std::nullopt;
    if (least_height_mm(p.a, q.a, r.a) < options_.least_triangle_mm ||
        least_height_mm(p.b, q.b, r.b) < options_.least_triangle_mm)
      return std::nullopt;
    const Mat3 R_AB = triangle_axes(p.a, q.a, r.a) * triangle_axes(p.b, q.b, r.b).transpose();
    return Pose(R_AB, (p.a + q.a + r.a) / 3.0 - R_AB * (p.b + q.b + r.b) / 3.0);
  }

  std::size_t count(const Pose& X_AB) const {
    const double limit = options_.inlier_mm * options_.inlier_mm;
    std::size_t support = 0;
    for (const PointPair& pair : pairs_) support += (X_AB * pair.b - pair.a).squaredNorm() <= limit ? 1U : 0U;
    return support;
  }

  /// Mean distance between the places of the pairs after either motion.
  double difference_mm(const Pose& X, const Pose& Y) const {
    double sum = 0.0;
    for (const PointPair& pair : pairs_) sum += (X * pair.b - Y * pair.b).norm();
    return sum / static_cast<double>(pairs_.size());
  }

  void keep(const Candidate& candidate, std::size_t most) {
    const auto same = std::find_if(candidates_.begin(), candidates_.end(), [&](const Candidate& other) {
      return difference_mm(candidate.X_AB, other.X_AB) < kSameMotion_mm;
    });
    if (same != candidates_.end()) {
      if (same->support >= candidate.support) return;
      *same = candidate;
    } else {
      candidates_.push_back(candidate);
    }
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Candidate& x, const Candidate& y) { return x.support > y.support; });
    if (candidates_.size() > most) candidates_.resize(most);
  }

  double needed_trials(std::size_t support) const {
    const double share = static_cast<double>(support) / static_cast<double>(pairs_.size());
    const double clean = share * share * share;
    return clean >= 1.0 ? 1.0 : std::log(1.0 - options_.certainty) / std::log1p(-clean);
  }

  std::span<const PointPair> pairs_;
  const RansacOptions& options_;
  Random random_;
  int trials_ = 0;
  std::vector<Candidate> candidates_;
};

std::vector<std::size_t> agreeing(std::span<const PointPair> pairs, const Pose& X_AB, double limit_mm) {
  std::vector<std::size_t> indices;
  for (std::size_t n = 0; n < pairs.size(); ++n)
    if ((X_AB * pairs[n].b - pairs[n].a).norm() <= limit_mm) indices.push_back(n);
  return indices;
}

/// Least squares over the pairs that agree, until these stay the same.
RigidMotion refine_motion(std::span<const PointPair> pairs, const Pose& X_AB, double limit_mm) {
  RigidMotion motion;
  motion.X_AB = X_AB;
  motion.inliers = agreeing(pairs, X_AB, limit_mm);
  for (int n = 0; n < kMotionRefinements; ++n) {
    std::vector<Vec3> a, b;
    for (const std::size_t index : motion.inliers) {
      a.push_back(pairs[index].a);
      b.push_back(pairs[index].b);
    }
    const auto fit = fit_rigid(a, b);
    if (!fit) break;
    motion.X_AB = fit->X_AB;
    motion.rms_mm = fit->rms_mm;
    std::vector<std::size_t> next = agreeing(pairs, fit->X_AB, limit_mm);
    if (next == motion.inliers || next.size() < 3) break;
    motion.inliers = std::move(next);
  }
  return motion;
}

/// One less the expected number of motions, among all that three pairs define, that this many other pairs support by
/// chance (Moisan & Stival, IJCV 57:201, 2004): a pair agrees by chance with the share of the volume in its reach.
double confidence_of_support(std::size_t inliers, std::size_t pairs, double limit_mm, double extent_mm) {
  if (inliers < 4) return 0.0;
  const double reach = limit_mm / extent_mm;
  const double by_chance = std::min(0.5, 4.0 / 3.0 * std::numbers::pi * reach * reach * reach);
  const auto log_choose = [](double n, double k) {
    return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
  };
  const double n = static_cast<double>(pairs), k = static_cast<double>(inliers);
  const double log_expected = log_choose(n, 3.0) + log_choose(n - 3.0, k - 3.0) + (k - 3.0) * std::log(by_chance);
  return log_expected >= 0.0 ? 0.0 : 1.0 - std::exp(log_expected);
}

}  // namespace

Result<std::vector<RigidMotion>> find_motions(std::span<const PointPair> pairs, double extent_mm,
                                              const RansacOptions& options, std::size_t most) {
  TROCAR_TRY_STATUS(check(options));
  std::vector<RigidMotion> motions;
  if (pairs.size() < 4 || !(extent_mm > 0.0)) return motions;
  MotionSearch search(pairs, options);
  for (const MotionSearch::Candidate& candidate : search.run(most)) {
    RigidMotion motion = refine_motion(pairs, candidate.X_AB, options.inlier_mm);
    if (motion.inliers.size() < 4) continue;
    motion.trials = search.trials();
    motion.confidence = confidence_of_support(motion.inliers.size(), pairs.size(), options.inlier_mm, extent_mm);
    motions.push_back(std::move(motion));
  }
  std::stable_sort(motions.begin(), motions.end(),
                   [](const RigidMotion& x, const RigidMotion& y) { return x.inliers.size() > y.inliers.size(); });
  return motions;
}

}  // namespace trocar::registration
