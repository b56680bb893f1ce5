// trocar learn: what a trainee has mastered and practises next.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "cli/commands.h"
#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "cli/session/past_sessions.h"
#include "config/json.h"
#include "learning/next_exercise.h"
#include "learning/progress.h"
#include "results/attempts.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {

struct LearnArguments {
  std::string sessions;
  std::string person, database;
  std::string task;
  bool is_json = false;
};

/// All that the command prints.
struct Learned {
  learning::Curriculum curriculum;
  learning::History history;
  std::vector<std::vector<learning::StepProgress>> progress;  ///< By course of the curriculum.
  learning::Recommendation advice;
};

std::string date_text(std::chrono::sys_days day) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                     static_cast<unsigned>(date.day()));
}

/// Attempts of a person in the database of results.
Result<learning::History> history_of(const LearnArguments& arguments) {
  TROCAR_TRY(results::Repository repository, open_results(arguments.database, database::Missing::kRefuse));
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.person));
  learning::History history;
  TROCAR_TRY(history.attempts, results::past_attempts(repository, person.id));
  return history;
}

Result<Learned> learn(const LearnArguments& arguments) {
  Learned learned;
  TROCAR_TRY(const std::filesystem::path tasks_folder, find_data("tasks"));
  TROCAR_TRY(learned.curriculum, learning::load_curriculum(tasks_folder.parent_path()));
  if (!arguments.task.empty()) TROCAR_TRY_STATUS(tasks::load_task(tasks_folder, arguments.task));
  TROCAR_TRY(learned.history,
             arguments.person.empty() ? read_past_sessions(arguments.sessions) : history_of(arguments));
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  for (const learning::Course& course : learned.curriculum.courses)
    learned.progress.push_back(learning::progress_of(learned.history.attempts, course, learned.curriculum.rules, now));
  learned.advice = learning::next_exercise(learned.history.attempts, learned.curriculum, now, arguments.task);
  return learned;
}

config::Json step_json(const learning::StepProgress& step) {
  return {{"patient", step.exercise.patient},
          {"case", step.exercise.difficulty},
          {"level", learning::to_string(step.exercise.level)},
          {"attempts", step.attempts},
          {"passes_in_a_row", step.passes_in_a_row},
          {"mastered", step.is_mastered},
          {"tested_out", step.is_tested_out},
          {"no_progress", step.plateau.has_value()},
          {"repeat_on", step.repetition ? config::Json(date_text(step.repetition->due)) : config::Json(nullptr)}};
}

/// Of the task, or of all; attempts without a level of help have no place in a learning path.
learning::AttemptCounts counts_of(const Learned& learned, const LearnArguments& arguments) {
  learning::AttemptCounts counts;
  for (const learning::PastAttempt& attempt : learned.history.attempts) {
    if (!arguments.task.empty() && attempt.task != arguments.task) continue;
    if (learning::counts(attempt.ending) && !attempt.level) {
      ++counts.without_level;
    } else {
      counts.add(attempt.ending, attempt.is_passed);
    }
  }
  return counts;
}

config::Json learned_json(const Learned& learned, const LearnArguments& arguments) {
  config::Json courses = config::Json::array();
  for (std::size_t n = 0; n < learned.progress.size(); ++n) {
    const std::string& task = learned.curriculum.courses[n].task;
    if (!arguments.task.empty() && task != arguments.task) continue;
    config::Json steps = config::Json::array();
    for (const learning::StepProgress& step : learned.progress[n]) steps.push_back(step_json(step));
    courses.push_back({{"task", task}, {"steps", std::move(steps)}});
  }
  const learning::Recommendation& advice = learned.advice;
  config::Json next{{"purpose", learning::to_string(advice.purpose)}};
  if (advice.exercise) {
    next["task"] = advice.exercise->task;
    next["patient"] = advice.exercise->patient;
    next["case"] = advice.exercise->difficulty;
    next["level"] = learning::to_string(advice.exercise->level);
  }
  next["reasons"] = advice.reasons;
  const learning::AttemptCounts counts = counts_of(learned, arguments);
  return {{"attempts", counts.counted()}, {"counts", counts_json(counts)},     {"courses", courses}, {"next", next},
          {"notes", advice.notes},        {"damaged", learned.history.damaged}};
}

/// "case 1 guided, assisted; case 2 guided", or "nothing yet".
std::string mastered_text(const std::vector<learning::StepProgress>& steps) {
  std::vector<std::string> cases;
  for (std::size_t n = 0; n < steps.size();) {
    const int the_case = steps[n].exercise.difficulty;
    std::vector<std::string> levels;
    for (; n < steps.size() && steps[n].exercise.difficulty == the_case; ++n)
      if (steps[n].is_mastered) levels.emplace_back(learning::to_string(steps[n].exercise.level));
    if (!levels.empty()) cases.push_back(fmt::format("case {} {}", the_case, fmt::join(levels, ", ")));
  }
  return cases.empty() ? "nothing yet" : fmt::format("{}", fmt::join(cases, "; "));
}

void print_course(const learning::Course& course, const std::vector<learning::StepProgress>& steps) {
  if (steps.empty()) return;
  fmt::print("{:<26} mastered: {}\n", course.title, mastered_text(steps));
  for (const learning::StepProgress& step : steps)
    if (step.plateau)
      fmt::print("{:<26} no progress at case {} {}: {:.0f} points on average\n", "", step.exercise.difficulty,
                 learning::to_string(step.exercise.level), step.plateau->mean);
  for (const learning::StepProgress& step : steps)
    if (step.repetition)
      fmt::print("{:<26} repeat case {} {} on {}\n", "", step.exercise.difficulty,
                 learning::to_string(step.exercise.level), date_text(step.repetition->due));
}

void print_learned(const Learned& learned, const LearnArguments& arguments) {
  const learning::AttemptCounts counts = counts_of(learned, arguments);
  fmt::print("{}\n", learning::counts_text(counts));
  if (counts.counted() > 0) fmt::print("{} of {} passed\n", counts.passed, counts.counted());
  for (std::size_t n = 0; n < learned.progress.size(); ++n) {
    const learning::Course& course = learned.curriculum.courses[n];
    if (arguments.task.empty() || course.task == arguments.task) print_course(course, learned.progress[n]);
  }
  const learning::Recommendation& advice = learned.advice;
  if (advice.purpose == learning::Purpose::kSeeInstructor) fmt::print("see your instructor\n");
  if (advice.exercise)
    fmt::print("next: {} (patient {})\n", learning::exercise_text(*advice.exercise, learned.curriculum),
               advice.exercise->patient);
  for (const std::string& reason : advice.reasons) fmt::print("  {}\n", reason);
}

Status print(const LearnArguments& arguments) {
  TROCAR_TRY(const Learned learned, learn(arguments));
  for (const std::string& note : learned.advice.notes) print_warning(note);
  if (arguments.is_json) {
    print_json(learned_json(learned, arguments));
  } else {
    print_learned(learned, arguments);
  }
  return {};
}

}  // namespace

void add_learn_command(Command& program, Action& action) {
  Command command = program.add_command("learn", "Print what a trainee has mastered and practises next, and why");
  const auto a = std::make_shared<LearnArguments>();
  Option sessions =
      command.add_option("--sessions", a->sessions,
                         "Folder of the trainee's sessions [those of the trainer: $XDG_STATE_HOME/trocar/sessions]");
  Option person =
      command
          .add_option("--person", a->person, "Attempts of this person in the database of results, in place of sessions")
          .excludes(sessions);
  command.add_option("--db", a->database, "Database of --person; see trocar results --help").needs(person);
  command.add_option("--task", a->task, "Only exercises of this task; see trocar task list");
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer(
      "Examples:\n  trocar learn\n  trocar learn --sessions sessions --task liver-biopsy\n  trocar learn --person "
      "\"Anna Meier\"\n");
  command.when_parsed([&action, a] { action = [a] { return print(*a); }; });
}

}  // namespace trocar::cli
