#include "learning/progress.h"

#include <algorithm>
#include <utility>

#include "cohort/learning_curve.h"

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
    const bool is_pass = attempt.score && attempt.is_passed;
    const bool is_success = is_pass && *attempt.score >= rules_.mastery_score;
    points_.emplace_back(attempt.score.value_or(0.0));
    in_a_row_ = is_success ? in_a_row_ + 1 : 0;
    others_since_ = 0;
    is_exam_passed_ = is_exam_passed_ || (is_pass && *attempt.score >= rules_.exam_score);
    if (repetition_) {
      repeat(is_success, day);
    } else if (in_a_row_ >= rules_.passes_in_a_row) {
      plan(0, day, false);
    } else if (points_.size() == 1 && is_pass && *attempt.score >= rules_.first_score) {
      is_tested_out_ = true;
      plan(0, day, false);
    }
  }
  void pass_over() { ++others_since_; }  ///< An attempt at another exercise.

  int attempts() const { return static_cast<int>(points_.size()); }
  int in_a_row() const { return in_a_row_; }
  bool is_exam_passed() const { return is_exam_passed_; }
  bool is_tested_out() const { return is_tested_out_; }
  const std::optional<Repetition>& repetition() const { return repetition_; }

  std::optional<Plateau> find_plateau() const {
    const auto window = static_cast<std::size_t>(rules_.plateau_attempts);
    if (points_.size() < window) return std::nullopt;
    const std::span<const std::optional<double>> last = std::span(points_).last(window);
    const std::optional<double> slope = cohort::trend_per_attempt(last);
    if (!slope || *slope >= rules_.plateau_slope) return std::nullopt;
    return Plateau{*slope, cohort::person_mean(last).value_or(0.0), others_since_ >= rules_.plateau_rest};
  }

 private:
  /// A success before the day is massed practice: it does not lengthen the interval. Who was tested out by one attempt
  /// and fails then has not mastered it.
  void repeat(bool is_success, sys_days day) {
    if (!is_success && std::exchange(is_tested_out_, false)) return repetition_.reset();
    if (in_a_row_ >= rules_.passes_in_a_row) is_tested_out_ = false;
    if (!is_success) return plan(0, day, true);
    if (day >= repetition_->due) plan(stage_ + 1, day, false);
  }

  void plan(std::size_t stage, sys_days day, bool has_failed) {
    stage_ = std::min(stage, rules_.intervals_days.size() - 1);
    repetition_ = Repetition{day, day + days(rules_.intervals_days[stage_]), has_failed};
  }

  const LearningRules& rules_;
  std::vector<std::optional<double>> points_;
  int in_a_row_ = 0, others_since_ = 0;
  bool is_tested_out_ = false, is_exam_passed_ = false;
  std::size_t stage_ = 0;  ///< Index of the interval.
  std::optional<Repetition> repetition_;
};

bool is_attempt_at(const PastAttempt& attempt, const Exercise& exercise) {
  return attempt.level == exercise.level && attempt.task == exercise.task && attempt.patient == exercise.patient;
}

/// A step with what its attempts say of others.
struct FollowedStep {
  StepProgress progress;
  bool is_exam_passed = false;
};

FollowedStep follow(std::span<const PastAttempt> history, const Exercise& exercise, const LearningRules& rules,
                    std::chrono::sys_seconds now) {
  StepFollower follower(rules);
  for (const PastAttempt& attempt : history) {
    if (!attempt.is_practice()) continue;
    if (is_attempt_at(attempt, exercise)) {
      follower.add(attempt, floor<days>(std::min(attempt.when, now)));
    } else {
      follower.pass_over();
    }
  }
  FollowedStep step{{exercise}, exercise.level == TrainingMode::kExam && follower.is_exam_passed()};
  step.progress.attempts = follower.attempts();
  step.progress.passes_in_a_row = follower.in_a_row();
  step.progress.repetition = follower.repetition();
  step.progress.is_tested_out = follower.is_tested_out();
  step.progress.plateau = follower.find_plateau();
  return step;
}

/// Mastery of a step by itself or by another one.
void find_mastery(StepProgress& step, const std::vector<FollowedStep>& all) {
  bool is_practised = false, is_tested = false;
  for (const auto& [other, is_exam_passed] : all) {
    if (other.exercise.difficulty < step.exercise.difficulty) continue;
    const bool is_covered = other.repetition && other.exercise.level >= step.exercise.level;
    is_practised = is_practised || (is_covered && !other.is_tested_out);
    is_tested = is_tested || is_covered || (is_exam_passed && step.exercise.level < TrainingMode::kExam);
  }
  step.is_mastered = is_practised || is_tested;
  step.is_tested_out = is_tested && !is_practised;
  if (step.is_mastered) step.plateau.reset();
}

/// Points of each judged part, of 100 together: parts that were not judged leave theirs to the others.
std::map<std::string, double, std::less<>> points_of(const PastAttempt& attempt, const Course& course) {
  std::map<std::string, double, std::less<>> points;
  double sum = 0.0;
  for (const auto& [part, share] : attempt.part_shares)
    if (const auto weight = course.part_weights.find(part); weight != course.part_weights.end())
      sum += points[part] = weight->second;
  for (auto& [part, most] : points) most *= sum > 0.0 ? 100.0 / sum : 0.0;
  return points;
}

}  // namespace

std::vector<StepProgress> progress_of(std::span<const PastAttempt> history, const Course& course,
                                      const LearningRules& rules, std::chrono::sys_seconds now) {
  std::vector<FollowedStep> followed;
  for (const CourseCase& the_case : course.cases)
    for (const TrainingMode level : kTrainingModes)
      followed.push_back(follow(history, {course.task, the_case.patient, the_case.difficulty, level}, rules, now));
  std::vector<StepProgress> steps;
  for (const FollowedStep& one : followed) {
    steps.push_back(one.progress);
    find_mastery(steps.back(), followed);
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

std::optional<PartLoss> find_weakest_part(std::span<const PastAttempt> history, const Curriculum& curriculum,
                                          std::string_view task) {
  std::map<std::string, PartLoss> sums;
  int seen = 0;
  for (auto attempt = history.rbegin(); attempt != history.rend() && seen < curriculum.rules.recent_attempts;
       ++attempt) {
    const Course* const course = curriculum.find(attempt->task);
    const bool is_asked = course != nullptr && (task.empty() || attempt->task == task);
    if (!attempt->score || !attempt->is_practice() || !is_asked) continue;
    ++seen;
    const std::map<std::string, double, std::less<>> points = points_of(*attempt, *course);
    for (const auto& [part, most] : points) {
      PartLoss& sum = sums.try_emplace(part, PartLoss{part}).first->second;
      sum.lost_points += most * (1.0 - attempt->part_shares.find(part)->second);
      sum.most_points += most;
      ++sum.attempts;
    }
  }
  std::optional<PartLoss> weakest;
  for (auto& [part, sum] : sums) {
    sum.lost_points /= sum.attempts;
    sum.most_points /= sum.attempts;
    if (sum.attempts >= curriculum.rules.least_attempts && (!weakest || sum.lost_points > weakest->lost_points))
      weakest = sum;
  }
  return weakest;
}

}  // namespace trocar::learning
