#include "learning/progress.h"

#include <algorithm>
#include <cstdint>

namespace trocar::learning {
namespace {

using std::chrono::days;
using std::chrono::floor;
using std::chrono::sys_days;

/// Follows the attempts at one exercise in the order of time.
class StepFollower {
 public:
  explicit StepFollower(const LearningRules& rules) : rules_(rules) {}

  void add(const PastAttempt& attempt, sys_days day) {
    const bool is_success = attempt.is_passed && *attempt.score >= rules_.mastery_score;
    ++attempts_;
    in_a_row_ = is_success ? in_a_row_ + 1 : 0;
    if (repetition_) {
      repeat(is_success, day);
    } else if (in_a_row_ >= rules_.passes_in_a_row) {
      plan(0, day, false);
    }
  }

  int attempts() const { return attempts_; }
  int in_a_row() const { return in_a_row_; }
  const std::optional<Repetition>& repetition() const { return repetition_; }

 private:
  /// A success before the day is massed practice: it does not lengthen the interval.
  void repeat(bool is_success, sys_days day) {
    if (!is_success) return plan(0, day, true);
    if (day >= repetition_->due) plan(stage_ + 1, day, false);
  }

  void plan(std::size_t stage, sys_days day, bool has_failed) {
    stage_ = std::min(stage, rules_.intervals_days.size() - 1);
    repetition_ = Repetition{day, day + days(rules_.intervals_days[stage_]), has_failed};
  }

  const LearningRules& rules_;
  int attempts_ = 0, in_a_row_ = 0;
  std::size_t stage_ = 0;  ///< Index of the interval.
  std::optional<Repetition> repetition_;
};

bool is_attempt_at(const PastAttempt& attempt, const Exercise& exercise) {
  return attempt.score && attempt.level == exercise.level && attempt.task == exercise.task &&
         attempt.patient == exercise.patient;
}

}  // namespace

std::vector<StepProgress> progress_of(std::span<const PastAttempt> history, const Course& course,
                                      const LearningRules& rules, std::chrono::sys_seconds now) {
  std::vector<StepProgress> steps;
  for (const CourseCase& the_case : course.cases) {
    for (const Level level : kLevels) {
      StepProgress step{{course.task, the_case.patient, the_case.difficulty, level}};
      StepFollower follower(rules);
      for (const PastAttempt& attempt : history)
        if (is_attempt_at(attempt, step.exercise)) follower.add(attempt, floor<days>(std::min(attempt.when, now)));
      step.attempts = follower.attempts();
      step.passes_in_a_row = follower.in_a_row();
      step.repetition = follower.repetition();
      steps.push_back(std::move(step));
    }
  }
  for (StepProgress& step : steps) {
    step.is_mastered = std::any_of(steps.begin(), steps.end(), [&](const StepProgress& other) {
      return other.repetition && other.exercise.difficulty >= step.exercise.difficulty &&
             other.exercise.level >= step.exercise.level;
    });
  }
  // Only the level with the least help comes back.
  for (StepProgress& step : steps) {
    const bool is_surpassed = std::any_of(steps.begin(), steps.end(), [&](const StepProgress& other) {
      return other.repetition && other.exercise.patient == step.exercise.patient &&
             other.exercise.level > step.exercise.level;
    });
    if (is_surpassed) step.repetition.reset();
  }
  return steps;
}

std::optional<PartShare> find_weakest_part(std::span<const PastAttempt> history, const Curriculum& curriculum,
                                           std::string_view task) {
  struct Sum {
    double share = 0.0;
    int attempts = 0;
  };
  std::map<std::string, Sum> sums;
  int seen = 0;
  for (auto attempt = history.rbegin(); attempt != history.rend() && seen < curriculum.rules.recent_attempts;
       ++attempt) {
    const bool is_asked = task.empty() ? curriculum.find(attempt->task) != nullptr : attempt->task == task;
    if (!attempt->score || !attempt->level || !is_asked) continue;
    ++seen;
    for (const auto& [part, share] : attempt->part_shares) {
      sums[part].share += share;
      ++sums[part].attempts;
    }
  }
  std::optional<PartShare> weakest;
  for (const auto& [part, sum] : sums) {
    const double mean = sum.share / sum.attempts;
    if (sum.attempts >= curriculum.rules.least_attempts && (!weakest || mean < weakest->share))
      weakest = PartShare{part, mean, sum.attempts};
  }
  return weakest;
}

}  // namespace trocar::learning
