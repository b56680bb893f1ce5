#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cohort/learning_curve.h"
#include "results/attempts.h"

namespace trocar::results {

struct CurveRules {
  std::size_t window = 5;  ///< Scores of the moving mean. Range 1..1000.
  cohort::CusumRates cusum = {};
};

/// An attempt of a person at a task that counts; without a score it is not passed.
struct CurveAttempt {
  Attempt attempt;
  std::optional<double> moving_mean;  ///< Of the scores up to this attempt; empty: there is none.
  double cusum = 0.0;                 ///< After this attempt.
};

/// Experts at the same task. Real ones; simulated ones only if there are no others.
struct ExpertLevel {
  std::size_t people = 0;
  bool is_simulated = false;
  double mean = 0.0;             ///< Of the experts' own mean scores.
  double low = 0.0, high = 0.0;  ///< The lowest and the highest of them.
};

/// How a person learns a task.
struct LearningCurve {
  std::vector<CurveAttempt> attempts;                         ///< Those that count, by sequence.
  learning::AttemptCounts counts;                             ///< Of all attempts at the task.
  cohort::Cusum cusum;                                        ///< Step, limits, and the signals by attempt.
  std::optional<double> trend;                                ///< Points an attempt, see cohort::trend_per_attempt.
  std::optional<ExpertLevel> experts;                         ///< Without the person.
  std::size_t peers = 0;                                      ///< Other trainees, simulated as the person is or not.
  std::vector<std::optional<cohort::CurvePoint>> peer_curve;  ///< By number of the attempt; each person counts once.
};
/// Errors: those of the database; rules outside of their ranges (exit status 2).
Result<LearningCurve> learning_curve(Repository& repository, const Person& person, std::string_view task,
                                     const CurveRules& rules = {});
/// The same with the scores of all people at the task (metric_samples of "score"), for many curves in a row.
Result<LearningCurve> learning_curve_of(Repository& repository, const Person& person, std::string_view task,
                                        const std::vector<MetricSample>& scores, const CurveRules& rules = {});

}  // namespace trocar::results
