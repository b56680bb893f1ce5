#include "cohort/pass_mark.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cohort/detail/bisect.h"
#include "cohort/detail/distributions.h"
#include "cohort/summary.h"

namespace trocar::cohort {
namespace {

constexpr const char* kPassMark = "pass mark";

Result<ScoreDistribution> fit(std::span<const double> scores, const std::string& group) {
  if (scores.size() < 2)
    return fail(fmt::format("it takes at least 2 {} with a score, not {}", group, scores.size()), kPassMark,
                "record more people");
  TROCAR_TRY_STATUS(check_finite(scores, fmt::format("scores of the {}", group)));
  const auto [least, most] = std::minmax_element(scores.begin(), scores.end());
  if (*least == *most)
    return fail(fmt::format("all {} have the same score ({:.1f}): their distribution has no width", group, *least),
                kPassMark, "record more people, or on harder cases");
  return ScoreDistribution{scores.size(), mean_of(scores), standard_deviation_of(scores)};
}

double log_density(const ScoreDistribution& distribution, double score) {
  const double z = (score - distribution.mean) / distribution.sd;
  return -0.5 * z * z - std::log(distribution.sd);
}

double share_below(const ScoreDistribution& distribution, double score) {
  return normal_below((score - distribution.mean) / distribution.sd);
}

}  // namespace

Result<PassMark> contrasting_groups(std::span<const double> experts, std::span<const double> novices) {
  PassMark mark;
  TROCAR_TRY(mark.experts, fit(experts, "experts"));
  TROCAR_TRY(mark.novices, fit(novices, "novices"));
  if (mark.experts.mean <= mark.novices.mean)
    return fail(fmt::format("the experts' mean score ({:.1f}) is not above the novices' ({:.1f})", mark.experts.mean,
                            mark.novices.mean),
                kPassMark, "check who belongs to which group");
  // Twice the log ratio is quadratic in the score: with a change of sign it has one root between the means.
  const auto experts_over_novices = [&](double score) {
    return log_density(mark.experts, score) - log_density(mark.novices, score);
  };
  if (experts_over_novices(mark.novices.mean) >= 0.0 || experts_over_novices(mark.experts.mean) <= 0.0)
    return fail("the scores of experts and novices overlap too much for a pass mark between their means", kPassMark,
                "record more people, or use a score that separates them");
  mark.value = bisect(mark.novices.mean, mark.experts.mean, experts_over_novices);
  mark.expected_false_pass = 1.0 - share_below(mark.novices, mark.value);
  mark.expected_false_fail = share_below(mark.experts, mark.value);
  const auto passes = [&](double score) { return score >= mark.value; };
  mark.false_passes = static_cast<std::size_t>(std::count_if(novices.begin(), novices.end(), passes));
  mark.false_fails = experts.size() - static_cast<std::size_t>(std::count_if(experts.begin(), experts.end(), passes));
  return mark;
}

}  // namespace trocar::cohort
