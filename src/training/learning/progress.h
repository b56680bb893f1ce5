#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learning/curriculum.h"
#include "learning/past_attempt.h"

namespace trocar::learning {

/// When a mastered exercise is to be practised again. Days are those of UTC.
struct Repetition {
  std::chrono::sys_days last;  ///< Day from which the interval counts.
  std::chrono::sys_days due;
  bool has_failed = false;  ///< The last repetition was not passed: the intervals began anew.

  int interval_days() const noexcept { return static_cast<int>((due - last).count()); }
};

/// Where a trainee stands at one exercise.
struct StepProgress {
  Exercise exercise;
  int attempts = 0;          ///< Scored ones.
  int passes_in_a_row = 0;   ///< The last so many attempts were passes with the mastery score.
  bool is_mastered = false;  ///< Itself once, or a case at least as difficult with at most as much help.
  /// Set for the level with the least help that was itself mastered on this case.
  std::optional<Repetition> repetition = {};
};

/// Progress at all exercises of a course: case by case, each from guided to exam. Attempts dated after `now` count as
/// of now. `history` by time.
std::vector<StepProgress> progress_of(std::span<const PastAttempt> history, const Course& course,
                                      const LearningRules& rules, std::chrono::sys_seconds now);

/// A part of the score, over the last attempts that judged it.
struct PartShare {
  std::string part;    ///< One of tasks::kScoreParts.
  double share = 0.0;  ///< Mean of points over most points, 0..1.
  int attempts = 0;
};
/// The part with the lowest share over the last rules.recent_attempts scored attempts at a level; of equal ones the
/// first by name. Empty: no part was judged rules.least_attempts times. `task`: only its attempts; empty: all of the
/// curriculum.
std::optional<PartShare> find_weakest_part(std::span<const PastAttempt> history, const Curriculum& curriculum,
                                           std::string_view task = {});

}  // namespace trocar::learning
