#pragma once

#include <cstddef>
#include <span>

#include "core/result.h"

namespace trocar::cohort {

/// Rank sum test of two independent groups (Wilcoxon 1945, Mann and Whitney 1947).
struct RankSumTest {
  double u = 0.0;  ///< Pairs in which the value of the first group is larger; ties count half. 0..n1·n2.
  double p = 1.0;  ///< Two-sided: probability of a U at least as far from n1·n2 / 2 if both groups are alike.
  bool is_exact = false;
};

/// The smallest exact two-sided p that groups of these sizes (≥ 1) can give: 2 / C(n1 + n2, n1), at most 1. Without
/// ties; values with ties may give a smaller one.
double smallest_rank_sum_p(std::size_t n1, std::size_t n2);

/// Groups of at most so many people together are tested exactly.
inline constexpr std::size_t kMostExactPeople = 50;

/// Exact: all assignments of the observed values (ties included) to the groups. Otherwise the normal approximation with
/// corrections for continuity and ties. Errors: a group without values, a value that is not finite.
Result<RankSumTest> rank_sum_test(std::span<const double> first, std::span<const double> second,
                                  std::size_t most_exact = kMostExactPeople);

}  // namespace trocar::cohort
