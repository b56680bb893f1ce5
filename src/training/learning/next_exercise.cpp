#include "learning/next_exercise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "learning/progress.h"
#include "scoring/score.h"

namespace trocar::learning {
namespace {

using std::chrono::days;
using std::chrono::sys_days;

std::string date_text(sys_days day) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

std::string count_text(int count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

/// Progress at all exercises of one course.
struct CourseProgress {
  const Course* course;
  std::vector<StepProgress> steps;

  const StepProgress* find_open_step() const {
    const auto found = std::find_if(steps.begin(), steps.end(), [](const StepProgress& s) { return !s.is_mastered; });
    return found == steps.end() ? nullptr : &*found;
  }
};

class Advisor {
 public:
  Advisor(std::span<const PastAttempt> history, const Curriculum& curriculum, std::chrono::sys_seconds now,
          std::string_view task)
      : history_(history), curriculum_(curriculum), now_(now), today_(std::chrono::floor<days>(now)) {
    for (const Course& course : curriculum.courses)
      if (task.empty() || course.task == task)
        courses_.push_back({&course, progress_of(history, course, curriculum.rules, now)});
    weakest_ = find_weakest_part(history, curriculum, task);
  }

  Recommendation advise() {
    note_clock();
    if (const StepProgress* due = find_due()) return repeat(*due);
    const CourseProgress* course = choose_course();
    if (course == nullptr) return nothing();
    return practise(*course);
  }

 private:
  void note_clock() {
    const auto later =
        std::count_if(history_.begin(), history_.end(), [&](const PastAttempt& a) { return a.when > now_; });
    if (later == 0) return;
    result_.notes.push_back(fmt::format("{} dated after today ({}): check the date of this computer.",
                                        later == 1 ? "1 attempt is" : fmt::format("{} attempts are", later),
                                        date_text(today_)));
  }

  template <class Better>
  const StepProgress* find_repetition(Better is_better) const {
    const StepProgress* best = nullptr;
    for (const CourseProgress& course : courses_)
      for (const StepProgress& step : course.steps)
        if (step.repetition && (best == nullptr || is_better(*step.repetition, *best->repetition))) best = &step;
    return best;
  }
  const StepProgress* find_first_repetition() const {
    return find_repetition([](const Repetition& a, const Repetition& b) { return a.due < b.due; });
  }
  const StepProgress* find_due() const {
    const StepProgress* first = find_first_repetition();
    return first != nullptr && first->repetition->due <= today_ ? first : nullptr;
  }

  Recommendation repeat(const StepProgress& step) {
    const Repetition& repetition = *step.repetition;
    const int late = static_cast<int>((today_ - repetition.due).count());
    result_.purpose = Purpose::kRepetition;
    result_.exercise = step.exercise;
    result_.reasons.push_back(fmt::format(
        "You have mastered this exercise; its repetition after {} is due {}.",
        count_text(repetition.interval_days(), "day"),
        late == 0 ? "today" : fmt::format("since {} ({})", date_text(repetition.due), count_text(late, "day"))));
    if (repetition.has_failed)
      result_.reasons.emplace_back("The last repetition was not passed, so that its intervals begin anew.");
    add_weakest();
    return result_;
  }

  /// True if the weakest part has a low share and the course judges it.
  bool is_weak_in(const Course& course) const {
    if (!weakest_ || weakest_->share >= curriculum_.rules.weak_share) return false;
    const auto weight = course.part_weights.find(weakest_->part);
    return weight != course.part_weights.end() && weight->second > 0.0;
  }

  /// The course that was practised last of those that fulfil `is_fit`; without a history the first one.
  template <class Fit>
  const CourseProgress* find_last_practised(Fit is_fit) const {
    for (auto attempt = history_.rbegin(); attempt != history_.rend(); ++attempt)
      for (const CourseProgress& course : courses_)
        if (attempt->score && attempt->level && course.course->task == attempt->task && is_fit(course)) return &course;
    const auto first = std::find_if(courses_.begin(), courses_.end(), is_fit);
    return first == courses_.end() ? nullptr : &*first;
  }

  const CourseProgress* choose_course() const {
    const auto is_open = [](const CourseProgress& course) { return course.find_open_step() != nullptr; };
    const CourseProgress* weak = find_last_practised(
        [&](const CourseProgress& course) { return is_open(course) && is_weak_in(*course.course); });
    return weak != nullptr ? weak : find_last_practised(is_open);
  }

  Recommendation practise(const CourseProgress& chosen) {
    const StepProgress& step = *chosen.find_open_step();
    result_.exercise = step.exercise;
    const bool is_weak = is_weak_in(*chosen.course);
    if (is_weak && step.exercise.level != Level::kGuided && step.attempts > 0) {
      result_.purpose = Purpose::kMoreHelp;
      result_.exercise->level = static_cast<Level>(static_cast<int>(step.exercise.level) - 1);
      add_weakest();
      result_.reasons.push_back(fmt::format("Practise it with one level more help before you go on with case {}, {}.",
                                            step.exercise.difficulty, to_string(step.exercise.level)));
      return result_;
    }
    result_.purpose = Purpose::kNextStep;
    add_step_reason(chosen, step);
    add_weakest();
    return result_;
  }

  void add_step_reason(const CourseProgress& chosen, const StepProgress& step) {
    const LearningRules& rules = curriculum_.rules;
    const std::string goal =
        fmt::format("{} with at least {:.0f} points",
                    rules.passes_in_a_row == 1 ? "a pass" : fmt::format("{} passes in a row", rules.passes_in_a_row),
                    rules.mastery_score);
    if (step.attempts > 0) {
      result_.reasons.push_back(fmt::format("It is mastered with {}; you have {}.", goal, step.passes_in_a_row));
      return;
    }
    const auto at = static_cast<std::size_t>(&step - chosen.steps.data());
    if (at == 0) {
      result_.reasons.push_back(
          fmt::format("Begin with the easiest case and full help; it is mastered with {}.", goal));
    } else if (step.exercise.level != Level::kGuided) {
      result_.reasons.push_back(fmt::format("You have mastered case {} {}: take the next step with less help.",
                                            step.exercise.difficulty, to_string(chosen.steps[at - 1].exercise.level)));
    } else {
      result_.reasons.push_back(fmt::format("You have mastered case {} at all levels of help: go on to the next case.",
                                            chosen.steps[at - 1].exercise.difficulty));
    }
  }

  void add_weakest() {
    if (!weakest_ || weakest_->share >= curriculum_.rules.weak_share) return;
    const std::string_view title = scoring::part_title(weakest_->part);
    result_.reasons.push_back(fmt::format(
        "Your weakest part is '{}': {:.0f} % of its points on average over your last {}.",
        title.empty() ? weakest_->part : title, 100.0 * weakest_->share, count_text(weakest_->attempts, "attempt")));
  }

  Recommendation nothing() {
    if (courses_.empty() ||
        std::all_of(courses_.begin(), courses_.end(), [](const CourseProgress& c) { return c.steps.empty(); })) {
      result_.reasons.emplace_back("There is no case to practise for this task.");
      return result_;
    }
    const StepProgress* next = find_first_repetition();
    result_.reasons.emplace_back("You have mastered all exercises.");
    if (next != nullptr)
      result_.reasons.push_back(fmt::format("The next repetition is {} on {}.",
                                            exercise_text(next->exercise, curriculum_),
                                            date_text(next->repetition->due)));
    return result_;
  }

  std::span<const PastAttempt> history_;
  const Curriculum& curriculum_;
  std::chrono::sys_seconds now_;
  sys_days today_;
  std::vector<CourseProgress> courses_;
  std::optional<PartShare> weakest_;
  Recommendation result_;
};

}  // namespace

const char* to_string(Purpose purpose) noexcept {
  constexpr std::array kNames{"repetition", "more-help", "next-step", "nothing"};
  return kNames[static_cast<std::size_t>(purpose)];
}

Recommendation next_exercise(std::span<const PastAttempt> history, const Curriculum& curriculum,
                             std::chrono::sys_seconds now, std::string_view task) {
  return Advisor(history, curriculum, now, task).advise();
}

}  // namespace trocar::learning
