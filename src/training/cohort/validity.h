#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cohort/learning_curve.h"
#include "cohort/separation.h"
#include "core/result.h"

namespace trocar::cohort {

/// Internal consistency of a score that is the sum of items (Cronbach 1951).
struct Alpha {
  double value = 0.0;  ///< 1: all items order the people alike; about 0: they have nothing in common; may be negative.
  Interval interval;   ///< Feldt 1965: assumes normally distributed items with equal variances and covariances.
  std::size_t items = 0, people = 0;
};

/// `people`: the items of each person, in the same order and unit (the total is their sum). Errors: fewer than two
/// people or items, rows of different length, a value that is not finite, all people have the same total score.
Result<Alpha> cronbach_alpha(std::span<const std::vector<double>> people);

/// A metric of all people.
struct MetricOfPeople {
  std::string name;   ///< "path_length".
  std::string title;  ///< "Path length of the tip".
  std::string unit;   ///< "mm"; "1": a pure number.
  Better better = Better::kNeither;
  std::vector<std::optional<double>> values = {};  ///< One a person, see person_mean; empty: the person has none.
};

/// What the evidence of one task is computed from. All lists have one entry a person, in the same order.
struct CohortData {
  struct Person {
    bool is_expert = false;
    bool is_simulated = false;  ///< A scripted operator.
    std::size_t attempts = 0;   ///< That count, within the range that was chosen.
    std::size_t unscored = 0;   ///< Of them, without a score: not passed.
  };
  std::vector<Person> people;
  std::vector<MetricOfPeople> metrics;
  std::vector<std::optional<double>> scores;              ///< 0..100, higher is better; of the scored attempts.
  std::vector<std::optional<double>> pass_shares = {};    ///< Passed of all attempts, 0..1; empty list: not known.
  std::vector<std::vector<std::optional<double>>> items;  ///< Points of each part of the score, same parts for all.
};

struct ValidityRules {
  double level = 0.05;  ///< Of significance, in (0, 1).
  Correction correction = Correction::kBenjaminiHochberg;
};

/// A metric, and how well it separates experts from novices.
struct MetricValidity {
  std::string name, title, unit;
  Better better = Better::kNeither;
  Result<Separation> separation;  ///< Error: a group has no value.
  double corrected_p = 1.0;
  /// The corrected p is at most the level and experts are better (if either direction is).
  bool discriminates = false;
};

/// Evidence that the score of a task means something.
struct Validity {
  std::size_t experts = 0, novices = 0;  ///< People.
  std::size_t simulated = 0;             ///< Of them, scripted operators.
  /// Attempts of experts and novices, and those of them without a score.
  std::size_t expert_attempts = 0, novice_attempts = 0, expert_unscored = 0, novice_unscored = 0;
  MetricValidity score;   ///< Not corrected, not counted among the metrics.
  MetricValidity passes;  ///< Share of passed attempts; likewise.
  std::vector<MetricValidity> metrics;
  std::size_t tested = 0;          ///< Metrics that both groups have.
  std::size_t discriminating = 0;  ///< Of them, after the correction.
  std::size_t uncorrected = 0;     ///< Of them, each at its own level: many published shares are counted so.
  Result<Alpha> alpha;             ///< Of the parts of the score that all people have.
  Result<PassMark> pass_mark;      ///< On the score.
};
/// Precondition: the lists have the same length. Parts that cannot be computed have the reason as their error.
Validity validity_of(const CohortData& data, const ValidityRules& rules = {});

/// "with groups of 2 and 12 people whose values all differ no two-sided p can be below 0.022", or empty if the groups
/// are large enough that the smallest p, corrected by Holm's rule for `metrics` metrics, is below the level.
std::string smallest_p_text(std::size_t experts, std::size_t novices, std::size_t metrics, double level);

}  // namespace trocar::cohort
