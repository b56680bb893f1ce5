#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cohort/survival.h"
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
  std::optional<double> instructor_min;    ///< Entered for the task (teaching.h); empty: nothing was entered.
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

}  // namespace trocar::results
