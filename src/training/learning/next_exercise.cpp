#include "learning/next_exercise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

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
  const StepProgress* find(const std::string& patient, TrainingMode level) const {
    const auto found = std::find_if(steps.begin(), steps.end(), [&](const StepProgress& s) {
      return s.exercise.patient == patient && s.exercise.level == level;
    });
    return found == steps.end() ? nullptr : &*found;
  }
};

/// What a course offers next.
struct Proposal {
  const CourseProgress* course;
  const StepProgress* step;  ///< The first that is not mastered.
  Purpose purpose = Purpose::kNextStep;
  Exercise exercise;
};

bool is_stuck(const StepProgress& step) {
  return step.plateau && !step.plateau->is_rested;
}

class Advisor {
 public:
  Advisor(std::span<const PastAttempt> history, const Curriculum& curriculum, std::chrono::sys_seconds now,
          std::string_view task)
      : history_(history),
        curriculum_(curriculum),
        rules_(curriculum.rules),
        now_(now),
        today_(std::chrono::floor<days>(now)) {
    for (const Course& course : curriculum.courses)
      if (task.empty() || course.task == task)
        courses_.push_back({&course, progress_of(history, course, curriculum.rules, now)});
    weakest_ = find_weakest_part(history, curriculum, task);
    find_row();
  }

  Recommendation advise() {
    note_clock();
    choose();
    if (result_.purpose != Purpose::kNothing) remind_of_plateaus();
    return result_;
  }

 private:
  void choose() {
    const std::vector<Proposal> proposals = make_proposals();
    const bool is_first_stuck = !proposals.empty() && is_stuck(*proposals.front().step);
    if (is_first_stuck) add_plateau(*proposals.front().step);
    if (const StepProgress* due = find_due()) {
      repeat(*due);
    } else if (const Proposal* fit = find_fit(proposals)) {
      practise(*fit, fit == &proposals.front() ? nullptr : &proposals.front());
    } else if (const StepProgress* other = find_other(proposals)) {
      result_.exercise = other->exercise;
      result_.purpose = Purpose::kInterleave;
      add_row_reason();
    } else if (!proposals.empty() && !is_first_stuck) {  // there is nothing else
      practise(proposals.front(), nullptr);
    } else if (proposals.empty()) {
      nothing();
    }
    if (is_first_stuck) result_.purpose = Purpose::kSeeInstructor;
  }

  void note_clock() {
    const auto later =
        std::count_if(history_.begin(), history_.end(), [&](const PastAttempt& a) { return a.when > now_; });
    if (later == 0) return;
    result_.notes.push_back(fmt::format("{} dated after today ({}): check the date of this computer.",
                                        later == 1 ? "1 attempt is" : fmt::format("{} attempts are", later),
                                        date_text(today_)));
  }

  bool is_known(const PastAttempt& attempt) const {
    return attempt.is_practice() && curriculum_.find(attempt.task) != nullptr;
  }
  static bool is_at(const PastAttempt& attempt, const Exercise& exercise) {
    return attempt.task == exercise.task && attempt.patient == exercise.patient && attempt.level == exercise.level;
  }

  /// The last attempts that were all at one exercise.
  void find_row() {
    for (auto attempt = history_.rbegin(); attempt != history_.rend(); ++attempt) {
      if (!is_known(*attempt)) continue;
      if (row_ > 0 && !is_at(*attempt, row_at_)) return;
      row_at_ = {attempt->task, attempt->patient, 0, *attempt->level};
      ++row_;
    }
  }
  /// Practised often enough in a row.
  bool is_worn(const Exercise& exercise) const {
    return row_ >= rules_.most_in_a_row && row_at_.task == exercise.task && row_at_.patient == exercise.patient &&
           row_at_.level == exercise.level;
  }

  template <class Fit>
  const StepProgress* find_first_repetition(Fit is_fit) const {
    const StepProgress* best = nullptr;
    for (const CourseProgress& course : courses_)
      for (const StepProgress& step : course.steps)
        if (step.repetition && is_fit(step) && (best == nullptr || step.repetition->due < best->repetition->due))
          best = &step;
    return best;
  }
  const StepProgress* find_due() const {
    return find_first_repetition(
        [&](const StepProgress& step) { return step.repetition->due <= today_ && !is_worn(step.exercise); });
  }

  void repeat(const StepProgress& step) {
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
  }

  bool is_weak() const { return weakest_ && weakest_->lost_points >= rules_.lost_points; }
  /// True if a part is weak and the course judges it.
  bool is_weak_in(const Course& course) const {
    if (!is_weak()) return false;
    const auto weight = course.part_weights.find(weakest_->part);
    return weight != course.part_weights.end() && weight->second > 0.0;
  }

  /// Position of the last attempt in the history, from 1; 0: none.
  template <class Fit>
  std::size_t find_last(Fit is_fit) const {
    for (std::size_t n = history_.size(); n > 0; --n)
      if (history_[n - 1].is_practice() && is_fit(history_[n - 1])) return n;
    return 0;
  }
  std::size_t last_practised(const Course& course) const {
    return find_last([&](const PastAttempt& attempt) { return attempt.task == course.task; });
  }
  std::size_t last_practised(const Exercise& exercise) const {
    return find_last([&](const PastAttempt& attempt) { return is_at(attempt, exercise); });
  }

  /// Of each course that is not mastered: those that judge the weak part first, then the one practised last.
  std::vector<Proposal> make_proposals() const {
    std::vector<Proposal> proposals;
    for (const CourseProgress& course : courses_)
      if (const StepProgress* step = course.find_open_step()) proposals.push_back(propose(course, *step));
    std::stable_sort(proposals.begin(), proposals.end(), [&](const Proposal& a, const Proposal& b) {
      const bool is_a_weak = is_weak_in(*a.course->course), is_b_weak = is_weak_in(*b.course->course);
      if (is_a_weak != is_b_weak) return is_a_weak;
      return last_practised(*a.course->course) > last_practised(*b.course->course);
    });
    return proposals;
  }

  Proposal propose(const CourseProgress& course, const StepProgress& step) const {
    Proposal proposal{&course, &step, Purpose::kNextStep, step.exercise};
    if (can_test_out(course, step)) {
      proposal.purpose = Purpose::kTestOut;
      proposal.exercise.level = TrainingMode::kExam;
    } else if (needs_help(course, step)) {
      proposal.purpose = Purpose::kMoreHelp;
      proposal.exercise.level = static_cast<TrainingMode>(static_cast<int>(step.exercise.level) - 1);
    }
    return proposal;
  }

  /// A new case, and the case before it was mastered at the exam without a failure.
  bool can_test_out(const CourseProgress& course, const StepProgress& step) const {
    const auto at = static_cast<std::size_t>(&step - course.steps.data());
    if (at == 0 || step.exercise.level != TrainingMode::kGuided) return false;
    for (const TrainingMode level : kTrainingModes)
      if (course.find(step.exercise.patient, level)->attempts > 0) return false;
    const StepProgress& before = course.steps[at - 1];
    return before.is_mastered && before.attempts > 0 && before.passes_in_a_row == before.attempts;
  }

  /// A weak part, the last attempt at the step failed, and there were not yet enough attempts with more help since.
  bool needs_help(const CourseProgress& course, const StepProgress& step) const {
    if (!is_weak_in(*course.course) || step.exercise.level == TrainingMode::kGuided || step.attempts == 0) return false;
    if (step.passes_in_a_row > 0) return false;
    Exercise helped = step.exercise;
    helped.level = static_cast<TrainingMode>(static_cast<int>(helped.level) - 1);
    int count = 0;
    for (auto attempt = history_.rbegin(); attempt != history_.rend(); ++attempt) {
      if (!attempt->is_practice()) continue;
      if (is_at(*attempt, step.exercise)) break;
      if (is_at(*attempt, helped)) ++count;
    }
    return count < rules_.more_help_attempts;
  }

  const Proposal* find_fit(const std::vector<Proposal>& proposals) const {
    const auto found = std::find_if(proposals.begin(), proposals.end(), [&](const Proposal& one) {
      return !is_stuck(*one.step) && !is_worn(one.exercise);
    });
    return found == proposals.end() ? nullptr : &*found;
  }

  /// Something else in between, if no course has a fitting next step: of the mastered exercises that come back the one
  /// practised longest ago; but before one of the last attempts comes again, an exercise with much help that is not
  /// mastered.
  const StepProgress* find_other(const std::vector<Proposal>& proposals) const {
    if (proposals.empty()) return nullptr;
    const StepProgress* best = nullptr;
    const auto rank = [this](const StepProgress& step) {
      const std::size_t last = last_practised(step.exercise);
      const bool is_recent = last > 0 && history_.size() - last < static_cast<std::size_t>(rules_.plateau_rest);
      const std::size_t order = !step.repetition ? 1 + static_cast<std::size_t>(step.exercise.level)
                                : is_recent      ? 1 + kTrainingModes.size()
                                                 : 0;
      return std::tuple(order, last, step.exercise.difficulty);
    };
    for (const CourseProgress& course : courses_)
      for (const StepProgress& step : course.steps) {
        const bool is_fit = step.repetition || (!step.is_mastered && !is_stuck(step));
        if (is_fit && !is_worn(step.exercise) && (best == nullptr || rank(step) < rank(*best))) best = &step;
      }
    return best;
  }

  /// `wanted`: the course that comes first but has no fitting step; null: it is this one.
  void practise(const Proposal& fit, const Proposal* wanted) {
    result_.exercise = fit.exercise;
    result_.purpose = fit.purpose;
    if (wanted != nullptr && !is_stuck(*wanted->step)) {
      result_.purpose = Purpose::kInterleave;
      add_row_reason();
    }
    if (fit.purpose == Purpose::kMoreHelp) {
      add_weakest();
      result_.reasons.push_back(fmt::format("Practise it with one level more help before you go on with case {}, {}.",
                                            fit.step->exercise.difficulty, to_string(fit.step->exercise.level)));
      return;
    }
    add_step_reason(*fit.course, *fit.step, fit.purpose);
    add_weakest();
  }

  void add_row_reason() {
    if (row_ < rules_.most_in_a_row) return;
    result_.reasons.push_back(
        fmt::format("You have practised one exercise {} in a row: another one in between makes it last longer.",
                    count_text(row_, "time")));
  }

  std::string goal_text() const {
    return fmt::format(
        "{} with at least {:.0f} points",
        rules_.passes_in_a_row == 1 ? "a pass" : fmt::format("{} passes in a row", rules_.passes_in_a_row),
        rules_.mastery_score);
  }

  void add_step_reason(const CourseProgress& chosen, const StepProgress& step, Purpose purpose) {
    if (purpose == Purpose::kTestOut) {
      result_.reasons.push_back(
          fmt::format("You have mastered the exam of the case before without a failure: a pass of this one with at "
                      "least {:.0f} points skips its steps with help.",
                      rules_.exam_score));
      return;
    }
    if (step.attempts > 0) {
      result_.reasons.push_back(fmt::format("It is mastered with {}; you have {}.", goal_text(), step.passes_in_a_row));
      return;
    }
    const auto at = static_cast<std::size_t>(&step - chosen.steps.data());
    if (at == 0) {
      result_.reasons.push_back(
          fmt::format("Begin with the easiest case and full help; it is mastered with {}, or with a pass of at least "
                      "{:.0f} points at the first attempt.",
                      goal_text(), rules_.first_score));
    } else if (step.exercise.level != TrainingMode::kGuided) {
      result_.reasons.push_back(fmt::format("You have mastered case {} {}: take the next step with less help.",
                                            step.exercise.difficulty, to_string(chosen.steps[at - 1].exercise.level)));
    } else {
      result_.reasons.push_back(fmt::format("You have mastered case {} at all levels of help: go on to the next case.",
                                            chosen.steps[at - 1].exercise.difficulty));
    }
  }

  void add_weakest() {
    if (!is_weak()) return;
    const std::string_view title = scoring::part_title(weakest_->part);
    result_.reasons.push_back(
        fmt::format("Your weakest part is '{}': it cost {:.0f} of {:.0f} points on average over your last {}.",
                    title.empty() ? weakest_->part : title, weakest_->lost_points, weakest_->most_points,
                    count_text(weakest_->attempts, "attempt")));
  }

  void add_plateau(const StepProgress& step) {
    result_.reasons.push_back(
        fmt::format("See your instructor about {}: over your last {} attempts at it the score did not rise ({:.0f} "
                    "points on average, {:+.1f} an attempt), and it is not mastered.",
                    exercise_text(step.exercise, curriculum_), rules_.plateau_attempts, step.plateau->mean,
                    step.plateau->slope + 0.0));
    result_.reasons.emplace_back("Meanwhile go on with another exercise.");
  }

  /// One line for other exercises that wait for the instructor.
  void remind_of_plateaus() {
    if (result_.purpose == Purpose::kSeeInstructor) return;
    for (const CourseProgress& course : courses_)
      if (const StepProgress* step = course.find_open_step(); step != nullptr && is_stuck(*step))
        result_.reasons.push_back(fmt::format("{} waits for your instructor: no progress over your last {} attempts.",
                                              exercise_text(step->exercise, curriculum_), rules_.plateau_attempts));
  }

  void nothing() {
    if (courses_.empty() ||
        std::all_of(courses_.begin(), courses_.end(), [](const CourseProgress& c) { return c.steps.empty(); })) {
      result_.reasons.emplace_back("There is no case to practise for this task.");
      return;
    }
    const StepProgress* next = find_first_repetition([](const StepProgress&) { return true; });
    result_.reasons.emplace_back("You have mastered all exercises.");
    if (next != nullptr)
      result_.reasons.push_back(fmt::format("The next repetition is {} on {}.",
                                            exercise_text(next->exercise, curriculum_),
                                            date_text(next->repetition->due)));
  }

  std::span<const PastAttempt> history_;
  const Curriculum& curriculum_;
  const LearningRules& rules_;
  std::chrono::sys_seconds now_;
  sys_days today_;
  std::vector<CourseProgress> courses_;
  std::optional<PartLoss> weakest_;
  Exercise row_at_;  ///< Without its difficulty.
  int row_ = 0;
  Recommendation result_;
};

}  // namespace

const char* to_string(Purpose purpose) noexcept {
  constexpr std::array kNames{"repetition", "more-help",      "next-step", "test-out",
                              "interleave", "see-instructor", "nothing"};
  return kNames[static_cast<std::size_t>(purpose)];
}

Recommendation next_exercise(std::span<const PastAttempt> history, const Curriculum& curriculum,
                             std::chrono::sys_seconds now, std::string_view task) {
  return Advisor(history, curriculum, now, task).advise();
}

}  // namespace trocar::learning
