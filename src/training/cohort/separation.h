#pragma once

#include <span>
#include <vector>

#include "cohort/rank_sum.h"
#include "cohort/summary.h"
#include "core/result.h"

namespace trocar::cohort {

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

}  // namespace trocar::cohort
