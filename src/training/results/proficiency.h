#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cohort/learning_curve.h"
#include "results/attempts.h"

namespace trocar::results {

/// When a person is called proficient: so many passes in a row with at least so many points. The defaults are those of
/// mastery in data/learning.toml [assumed].
struct ProficiencyRules {
  double score = 80.0;      ///< Range 0..100.
  int passes_in_a_row = 3;  ///< Range 1..20.
};

/// Whose attempts; empty members do not restrict.
struct ProficiencyFilter {
  std::string task;
  std::string course = {}, patient = {}, level = {};
};

/// One person with attempts of the filter that count.
struct PersonProficiency {
  Person person;
  learning::AttemptCounts counts;
  std::optional<std::size_t> trials;       ///< Attempts up to proficiency; empty: not yet, after counts.counted().
  double practice_s = 0.0;                 ///< Recorded time of all attempts, those that do not count included.
  std::optional<double> first_pass_share;  ///< Mean of the metric first_pass_success; empty: not measured.
  std::optional<double> time_to_target_s;  ///< Median of the metric time_to_target; empty: never reached.
  std::optional<double> instructor_min;    ///< Entered for the task (notes.h); empty: nothing was entered.
};

/// People of a kind: trainees or experts, real or simulated.
struct GroupProficiency {
  Group group = Group::kTrainee;
  bool is_simulated = false;
  std::vector<PersonProficiency> people;  ///< By name.
  learning::AttemptCounts counts;
  cohort::Survival trials;                 ///< Of the people; who is not proficient yet is censored.
  double practice_s = 0.0;                 ///< Sum of all people.
  std::optional<double> first_pass_share;  ///< Mean of the people's shares: each counts once.
  std::optional<double> time_to_target_s;  ///< Median of the people's medians.
  std::optional<double> instructor_min;    ///< Sum of those for whom minutes were entered.
  std::size_t taught = 0;                  ///< Number of these people.
};

/// Groups with at least one person, trainees before experts, real before simulated. Errors: rules outside of their
/// ranges (exit status 2), those of the database.
Result<std::vector<GroupProficiency>> proficiency_of(Repository& repository, const ProficiencyFilter& filter,
                                                     const ProficiencyRules& rules = {});

/// The number of the attempt with which a person became proficient, from 1; empty: not yet. `attempts` in order: those
/// that count.
std::optional<std::size_t> trials_to_proficiency(const std::vector<Attempt>& attempts, const ProficiencyRules& rules);

/// What is known of the instructors' time: the minutes that they entered, or that they entered none. For people.
std::string instructor_time_text(const GroupProficiency& group);

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
