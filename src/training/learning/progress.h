#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learning/curriculum.h"
#include "learning/history.h"

namespace trocar::learning {

/// When a mastered exercise is to be practised again. Days are those of UTC.
struct Repetition {
  std::chrono::sys_days last;  ///< Day from which the interval counts.
  std::chrono::sys_days due;
  bool has_failed = false;  ///< The last repetition was not passed: the intervals began anew.

  int interval_days() const noexcept { return static_cast<int>((due - last).count()); }
};

/// No progress over the last rules.plateau_attempts attempts at an exercise that is not mastered.
struct Plateau {
  double slope = 0.0;  ///< Points an attempt: cohort::trend_per_attempt; an attempt without a result counts 0 points.
  double mean = 0.0;   ///< Mean points.
  bool is_rested = false;  ///< Other exercises were practised so often since that it may be tried again.
};

/// Where a trainee stands at one exercise.
struct StepProgress {
  Exercise exercise;
  int attempts = 0;         ///< Those that count (PastAttempt::is_practice).
  int passes_in_a_row = 0;  ///< The last so many attempts were passes with the mastery score.
  /// Mastered itself (passes in a row, or a very good first attempt); or a case at least as difficult was, with at most
  /// as much help; or such a case was passed at the exam once, which covers all that has more help.
  bool is_mastered = false;
  bool is_tested_out = false;  ///< Mastered without the passes in a row: a first attempt or an exam was good enough.
  std::optional<Plateau> plateau = {};
  /// Set for the level with the least help that was itself mastered on this case.
  std::optional<Repetition> repetition = {};
};

/// Progress at all exercises of a course: case by case, each from guided to exam. Attempts dated after `now` count as
/// of now. `history` by time.
std::vector<StepProgress> progress_of(std::span<const PastAttempt> history, const Course& course,
                                      const LearningRules& rules, std::chrono::sys_seconds now);

/// A part of the score, over the last attempts that judged it. Points of 100, as the course weighs its parts.
struct PartLoss {
  std::string part;          ///< One of tasks::kScoreParts.
  double lost_points = 0.0;  ///< Mean.
  double most_points = 0.0;  ///< Mean.
  int attempts = 0;
};
/// The part that costs the most points over the last rules.recent_attempts scored attempts at a level; of equal ones
/// the first by name. Empty: no part was judged rules.least_attempts times. `task`: only its attempts; empty: all of
/// the curriculum.
std::optional<PartLoss> find_weakest_part(std::span<const PastAttempt> history, const Curriculum& curriculum,
                                          std::string_view task = {});

}  // namespace trocar::learning
