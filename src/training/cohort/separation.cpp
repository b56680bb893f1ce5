#include "cohort/separation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "cohort/detail/distributions.h"
#include "cohort/learning_curve.h"
#include "core/result.h"

namespace trocar::cohort {
namespace {

/// Variance of the area that n1 and n2 people give if the true one is `area`, both groups exponential (Hanley and
/// McNeil 1982, with Newcombe's pooled size).
double area_variance(double area, double n1, double n2) {
  const double pooled = 0.5 * (n1 + n2) - 1.0;
  return area * (1.0 - area) / (n1 * n2) * (1.0 + pooled * ((1.0 - area) / (2.0 - area) + area / (1.0 + area)));
}

std::vector<std::size_t> by_size(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  return order;
}

}  // namespace

Interval auc_interval(double auc, std::size_t n1, std::size_t n2) {
  TROCAR_CHECK(auc >= 0.0 && auc <= 1.0 && n1 >= 1 && n2 >= 1);
  static const double z = normal_quantile(0.975);
  const auto reach = [&](double area) {
    return z * std::sqrt(area_variance(area, static_cast<double>(n1), static_cast<double>(n2)));
  };
  // The true areas from which the observed one is 1.96 of their own standard errors away.
  const auto from_below = [&](double area) { return area + reach(area) - auc; };
  const auto from_above = [&](double area) { return area - reach(area) - auc; };
  return {auc > 0.0 ? bisect(0.0, auc, from_below) : 0.0, auc < 1.0 ? bisect(auc, 1.0, from_above) : 1.0};
}

Result<Separation> separation_of(std::span<const double> experts, std::span<const double> novices, Better better) {
  Separation separation;
  TROCAR_TRY(separation.test, rank_sum_test(experts, novices));
  separation.experts = experts.size();
  separation.novices = novices.size();
  separation.expert_median = *quantile_of(experts, 0.5);
  separation.novice_median = *quantile_of(novices, 0.5);
  const double higher = separation.test.u / static_cast<double>(experts.size() * novices.size());
  separation.auc = better == Better::kLower ? 1.0 - higher : higher;
  separation.auc_interval = auc_interval(separation.auc, experts.size(), novices.size());
  return separation;
}

const char* to_string(Correction correction) noexcept {
  switch (correction) {
    case Correction::kNone:
      return "none";
    case Correction::kHolm:
      return "Holm";
    case Correction::kBenjaminiHochberg:
      return "Benjamini-Hochberg";
  }
  return "";
}

std::vector<double> corrected_p(std::span<const double> p, Correction correction) {
  std::vector<double> corrected(p.begin(), p.end());
  if (correction == Correction::kNone) return corrected;
  const std::vector<std::size_t> order = by_size(p);
  const std::size_t count = p.size();
  double so_far = correction == Correction::kHolm ? 0.0 : 1.0;
  for (std::size_t n = 0; n < count; ++n) {
    if (correction == Correction::kHolm) {  // from the smallest p, never falling
      const std::size_t at = order[n];
      so_far = std::max(so_far, p[at] * static_cast<double>(count - n));
      corrected[at] = std::min(1.0, so_far);
    } else {  // from the largest p, never rising
      const std::size_t rank = count - n, at = order[rank - 1];
      so_far = std::min(so_far, p[at] * static_cast<double>(count) / static_cast<double>(rank));
      corrected[at] = so_far;
    }
  }
  return corrected;
}

namespace {

/// Twice the mid-ranks of all values: whole numbers, also for ties. Those of the first group first.
struct DoubledRanks {
  std::vector<std::size_t> ranks;
  double tie_sum = 0.0;  ///< Σ t³ − t over the sets of t equal values.
};

DoubledRanks doubled_ranks(std::span<const double> first, std::span<const double> second) {
  std::vector<double> values(first.begin(), first.end());
  values.insert(values.end(), second.begin(), second.end());
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  DoubledRanks result{std::vector<std::size_t>(values.size()), 0.0};
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t n = begin; n < end; ++n) result.ranks[order[n]] = begin + 1 + end;
    const auto tied = static_cast<double>(end - begin);
    result.tie_sum += tied * (tied * tied - 1.0);
    begin = end;
  }
  return result;
}

/// Share of all choices of `chosen` ranks whose sum is at least as far from the mean as `observed`.
double exact_p(const std::vector<std::size_t>& ranks, std::size_t chosen, std::size_t observed) {
  const std::size_t total = std::accumulate(ranks.begin(), ranks.end(), std::size_t{0});
  // choices[k][sum]: ways to choose k of the ranks so far with this sum. Doubles count exactly up to 2^53.
  std::vector<std::vector<double>> choices(chosen + 1, std::vector<double>(total + 1, 0.0));
  choices[0][0] = 1.0;
  for (const std::size_t rank : ranks)
    for (std::size_t k = chosen; k > 0; --k)
      for (std::size_t sum = rank; sum <= total; ++sum) choices[k][sum] += choices[k - 1][sum - rank];
  // Compared without division: |n·sum − k·total| against the observed one.
  const auto distance = [&](std::size_t sum) {
    return std::abs(static_cast<long long>(ranks.size() * sum) - static_cast<long long>(chosen * total));
  };
  double as_far = 0.0, all = 0.0;
  for (std::size_t sum = 0; sum <= total; ++sum) {
    all += choices[chosen][sum];
    if (distance(sum) >= distance(observed)) as_far += choices[chosen][sum];
  }
  return as_far / all;
}

double normal_p(double u, double n1, double n2, double tie_sum) {
  const double n = n1 + n2;
  const double variance = n1 * n2 / 12.0 * (n + 1.0 - tie_sum / (n * (n - 1.0)));
  if (variance <= 0.0) return 1.0;
  const double z = (std::abs(u - 0.5 * n1 * n2) - 0.5) / std::sqrt(variance);
  return std::min(1.0, 2.0 * normal_below(-z));
}

}  // namespace

double smallest_rank_sum_p(std::size_t n1, std::size_t n2) {
  double choices = 1.0;
  for (std::size_t n = 1; n <= n1; ++n) choices *= static_cast<double>(n2 + n) / static_cast<double>(n);
  return std::min(1.0, 2.0 / choices);
}

Result<RankSumTest> rank_sum_test(std::span<const double> first, std::span<const double> second,
                                  std::size_t most_exact) {
  if (first.empty() || second.empty())
    return fail("one of the two groups has no values", "rank sum test", "record attempts of experts and novices");
  TROCAR_TRY_STATUS(check_finite(first, "the first group"));
  TROCAR_TRY_STATUS(check_finite(second, "the second group"));
  const auto n1 = static_cast<double>(first.size()), n2 = static_cast<double>(second.size());
  const DoubledRanks all = doubled_ranks(first, second);
  const auto end_of_first = all.ranks.begin() + static_cast<std::ptrdiff_t>(first.size());
  const std::size_t sum = std::accumulate(all.ranks.begin(), end_of_first, std::size_t{0});
  RankSumTest test;
  test.u = 0.5 * static_cast<double>(sum) - 0.5 * n1 * (n1 + 1.0);
  test.is_exact = all.ranks.size() <= most_exact;
  if (test.is_exact) {
    const std::size_t total = std::accumulate(all.ranks.begin(), all.ranks.end(), std::size_t{0});
    const bool is_first_smaller = first.size() <= second.size();
    test.p = exact_p(all.ranks, std::min(first.size(), second.size()), is_first_smaller ? sum : total - sum);
  } else {
    test.p = normal_p(test.u, n1, n2, all.tie_sum);
  }
  return test;
}

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
