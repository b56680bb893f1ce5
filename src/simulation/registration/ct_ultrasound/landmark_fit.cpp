#include "registration/ct_ultrasound/landmark_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace trocar::registration {
namespace {

/// Picking errors of landmarks are 1 to 3 mm. Limits assumed.
constexpr double kDoubtful_mm = 2.5, kRefused_mm = 6.0;
constexpr double kDoubtfulScale = 0.02, kRefusedScale = 0.05;

Result<std::map<std::string, Vec3>> by_name(std::span<const NamedPoint> points, const char* side) {
  std::map<std::string, Vec3> named;
  for (const NamedPoint& point : points)
    if (!named.emplace(point.name, point.p).second)
      return fail(fmt::format("the label \"{}\" occurs twice", point.name), fmt::format("landmarks of the {}", side),
                  "give each landmark a label of its own");
  return named;
}

struct Pairs {
  std::vector<Vec3> ct, us;
  std::vector<std::string> names, unmatched;
};

Pairs pair_by_name(const std::map<std::string, Vec3>& ct, const std::map<std::string, Vec3>& us) {
  Pairs pairs;
  for (const auto& [name, p] : ct) {
    const auto other = us.find(name);
    if (other == us.end()) {
      pairs.unmatched.push_back(name);
      continue;
    }
    pairs.names.push_back(name);
    pairs.ct.push_back(p);
    pairs.us.push_back(other->second);
  }
  for (const auto& [name, p] : us)
    if (!ct.contains(name)) pairs.unmatched.push_back(name);
  return pairs;
}

/// The pair without which the others fit best; with three pairs, the one of the largest residual.
std::size_t find_worst(const Pairs& pairs, const RigidFit& fit) {
  std::size_t worst = worst_pair(fit);
  if (pairs.ct.size() <= 3) return worst;
  double least_mm = fit.rms_mm;
  for (std::size_t n = 0; n < pairs.ct.size(); ++n) {
    std::vector<double> weights(pairs.ct.size(), 1.0);
    weights[n] = 0.0;
    const auto others = fit_rigid(pairs.ct, pairs.us, weights);
    if (!others || others->rms_mm >= least_mm) continue;
    least_mm = others->rms_mm;
    worst = n;
  }
  return worst;
}

}  // namespace

Result<LandmarkFit> fit_landmarks(std::span<const NamedPoint> ct, std::span<const NamedPoint> us) {
  TROCAR_TRY(const auto ct_by_name, by_name(ct, "CT"));
  TROCAR_TRY(const auto us_by_name, by_name(us, "ultrasound"));
  const Pairs pairs = pair_by_name(ct_by_name, us_by_name);
  if (pairs.names.size() < 3)
    return fail(
        fmt::format("{} landmark{} with the same label in CT and ultrasound: at least 3 are needed{}",
                    pairs.names.size(), pairs.names.size() == 1 ? "" : "s",
                    pairs.unmatched.empty() ? "" : fmt::format(" (unmatched: {})", fmt::join(pairs.unmatched, ", "))),
        "landmarks", "give the same labels on both sides");
  TROCAR_TRY(RigidFit fit, fit_rigid(pairs.ct, pairs.us));
  LandmarkFit result;
  const std::size_t worst = find_worst(pairs, fit);
  result.worst = pairs.names[worst];
  result.worst_mm = fit.residual_mm[worst];
  result.names = pairs.names;
  result.unmatched = pairs.unmatched;
  const double scale_error = std::abs(fit.scale - 1.0);
  if (fit.rms_mm > kDoubtful_mm || scale_error > kDoubtfulScale)
    result.warning =
        fmt::format("the landmarks do not fit rigidly: rms {:.1f} mm, scale {:.3f}, worst pair \"{}\" {:.1f} mm",
                    fit.rms_mm, fit.scale, result.worst, result.worst_mm);
  if (fit.rms_mm > kRefused_mm || scale_error > kRefusedScale)
    return fail(result.warning, "landmarks", "correct or remove that pair, or check the spacing of both volumes");
  result.fit = std::move(fit);
  return result;
}

}  // namespace trocar::registration
