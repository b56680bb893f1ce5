#include "cohort/rank_sum.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "cohort/detail/distributions.h"
#include "cohort/summary.h"

namespace trocar::cohort {
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

}  // namespace trocar::cohort
