#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cohort/learning_curve.h"
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

/// How well one value (a metric, the score) separates experts from novices.
struct Separation {
  std::size_t experts = 0, novices = 0;  ///< People.
  double expert_median = 0.0, novice_median = 0.0;
  /// Area under the ROC curve: probability that an expert is better than a novice, equal values count half. 0.5: no
  /// separation, 1: every expert is better than every novice. If neither direction is better: that the expert's value
  /// is higher.
  double auc = 0.5;
  Interval auc_interval;  ///< Newcombe 2006 part 2, method 5: Hanley and McNeil's variance, as a score interval.
  RankSumTest test;       ///< Of experts against novices.
};

/// One value a person (person_mean): attempts of one person are not independent. Errors: a group without people, a
/// value that is not finite.
Result<Separation> separation_of(std::span<const double> experts, std::span<const double> novices, Better better);

/// Interval of 95 % of an area under the ROC curve `auc` (0..1) that n1 and n2 (≥ 1) people gave. It holds for small
/// groups and for areas of 0 and 1.
Interval auc_interval(double auc, std::size_t n1, std::size_t n2);

/// Correction for testing many metrics at once.
enum class Correction {
  kNone,               ///< Each metric at its own level, as published validity studies often do.
  kHolm,               ///< Risk of any false finding at most the level (Holm 1979).
  kBenjaminiHochberg,  ///< Expected share of false findings at most the level (Benjamini and Hochberg 1995).
};
const char* to_string(Correction correction) noexcept;

/// p values after the correction, in the same order, at most 1: a metric is found at a level if its corrected p is not
/// above it. Precondition: all p within 0 and 1.
std::vector<double> corrected_p(std::span<const double> p, Correction correction);

/// Normal distribution fitted to the scores of a group.
struct ScoreDistribution {
  std::size_t people = 0;
  double mean = 0.0;
  double sd = 0.0;  ///< Of a sample (n − 1).
};

/// Pass mark by contrasting groups (Jørgensen, Konge, Subhi 2018): the score between both means at which the fitted
/// densities are equal. From this score on, a person passes.
struct PassMark {
  double value = 0.0;
  ScoreDistribution experts, novices;
  double expected_false_pass = 0.0;  ///< Share of novices at or above the mark, by their fitted distribution.
  double expected_false_fail = 0.0;  ///< Share of experts below it.
  std::size_t false_passes = 0;      ///< Novices at or above the mark.
  std::size_t false_fails = 0;       ///< Experts below it.
};

/// One score a person, higher is better. Errors, each with the reason: fewer than two people in a group, a score that
/// is not finite, a group in which all scores are equal, experts who are not better, distributions that do not cross
/// between their means.
Result<PassMark> contrasting_groups(std::span<const double> experts, std::span<const double> novices);

}  // namespace trocar::cohort
