// trocar results proficiency, taught: how many attempts and minutes of instructors people need.
#include <fmt/format.h>

#include <algorithm>

#include "cli/json_parts.h"
#include "cli/results/commands.h"
#include "config/json.h"
#include "learning/curriculum.h"
#include "results/notes.h"
#include "results/people.h"
#include "results/proficiency.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {

using results::GroupProficiency;

constexpr double kMinute_s = 60.0;

struct ProficiencyArguments {
  results::ProficiencyFilter filter;
  results::ProficiencyRules rules;
  std::int64_t in_a_row = 0;
  bool is_json = false;
};

config::Json person_json(const results::PersonProficiency& one) {
  return {{"name", one.person.name},
          {"attempts", one.counts.counted()},
          {"counts", counts_json(one.counts)},
          {"trials_to_proficiency", or_null(one.trials)},
          {"practice_s", one.practice_s},
          {"first_pass_share", or_null(one.first_pass_share)},
          {"time_to_target_s", or_null(one.time_to_target_s)},
          {"instructor_minutes", or_null(one.instructor_min)}};
}

config::Json group_json(const GroupProficiency& group) {
  config::Json people = config::Json::array();
  for (const results::PersonProficiency& one : group.people) people.push_back(person_json(one));
  return {{"group", to_string(group.group)},
          {"simulated", group.is_simulated},
          {"attempts", group.counts.counted()},
          {"counts", counts_json(group.counts)},
          {"trials_to_proficiency",
           {{"people", group.trials.people},
            {"proficient", group.trials.reached},
            {"not_yet", group.trials.censored()},
            {"median", or_null(group.trials.median)},
            {"low", or_null(group.trials.low)},
            {"high", or_null(group.trials.high)}}},
          {"practice_s", group.practice_s},
          {"instructor_minutes", or_null(group.instructor_min)},
          {"people_with_instructor_minutes", group.taught},
          {"first_pass_share", or_null(group.first_pass_share)},
          {"time_to_target_s", or_null(group.time_to_target_s)},
          {"people", std::move(people)}};
}

std::string or_dash(const std::optional<double>& value, double factor, int decimals, const char* unit) {
  return value ? fmt::format("{:.{}f} {}", factor * *value, decimals, unit) : std::string("-");
}

std::string trials_text(const cohort::Survival& trials) {
  const std::string open =
      fmt::format("{} of {} people are proficient, {} not yet", trials.reached, trials.people, trials.censored());
  if (!trials.median) return fmt::format("no median: {}", open);
  const auto limit = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.0f}", *value) : std::string("open");
  };
  return fmt::format("median {:.0f} (95 % {} to {}; Kaplan-Meier); {}", *trials.median, limit(trials.low),
                     limit(trials.high), open);
}

void print_group(const GroupProficiency& group) {
  fmt::print("{}s{}: {} {}, {}\n", to_string(group.group), group.is_simulated ? ", simulated" : "", group.people.size(),
             group.people.size() == 1 ? "person" : "people", learning::counts_text(group.counts));
  std::size_t width = 4;
  for (const results::PersonProficiency& one : group.people) width = std::max(width, one.person.name.size());
  fmt::print("  {:<{}}  {:>8} {:>7}  {:>10}  {:>12}  {:>10}  {:>14}  {:>10}\n", "name", width, "attempts", "passed",
             "trials", "practice", "first pass", "time to target", "instructor");
  for (const results::PersonProficiency& one : group.people)
    fmt::print("  {:<{}}  {:>8} {:>7}  {:>10}  {:>12}  {:>10}  {:>14}  {:>10}\n", one.person.name, width,
               one.counts.counted(), one.counts.passed,
               one.trials ? fmt::format("{}", *one.trials) : fmt::format("not yet"),
               fmt::format("{:.1f} min", one.practice_s / kMinute_s), or_dash(one.first_pass_share, 100.0, 0, "%"),
               or_dash(one.time_to_target_s, 1.0, 1, "s"), or_dash(one.instructor_min, 1.0, 0, "min"));
  fmt::print("  trials to proficiency: {}\n", trials_text(group.trials));
  fmt::print("  first-pass success: {} (mean of the people's shares); time to target: {} (median of their medians)\n",
             or_dash(group.first_pass_share, 100.0, 0, "%"), or_dash(group.time_to_target_s, 1.0, 1, "s"));
  fmt::print("  instructor's minutes: {}\n", results::instructor_time_text(group));
}

/// The rules of data/learning.toml where the command line has none.
Status complete_rules(ProficiencyArguments& arguments, bool has_score) {
  TROCAR_TRY(const std::filesystem::path file, find_data(learning::kRulesFile));
  TROCAR_TRY(const learning::LearningRules rules, learning::load_rules(file));
  if (!has_score) arguments.rules.score = rules.mastery_score;
  arguments.rules.passes_in_a_row =
      arguments.in_a_row > 0 ? static_cast<int>(arguments.in_a_row) : rules.passes_in_a_row;
  return {};
}

Status show_proficiency(const std::string& url, ProficiencyArguments& arguments, bool has_score) {
  TROCAR_TRY_STATUS(complete_rules(arguments, has_score));
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  const results::ProficiencyFilter& filter = arguments.filter;
  TROCAR_TRY(const std::vector<GroupProficiency> groups, results::proficiency_of(repository, filter, arguments.rules));
  if (groups.empty()) {
    TROCAR_TRY(const learning::AttemptCounts counts,
               results::count_attempts(repository, {{}, filter.task, filter.course, filter.patient, filter.level}));
    return fail(fmt::format("no attempts that count ({})", learning::counts_text(counts)), filter.task,
                "see trocar results list");
  }
  if (arguments.is_json) {
    config::Json list = config::Json::array();
    for (const GroupProficiency& group : groups) list.push_back(group_json(group));
    print_json({{"task", filter.task},
                {"score", arguments.rules.score},
                {"passes_in_a_row", arguments.rules.passes_in_a_row},
                {"groups", std::move(list)}});
    return {};
  }
  std::string of = filter.task;
  for (const std::string& part : {filter.patient, filter.level})
    if (!part.empty()) of += ", " + part;
  fmt::print("proficiency at {}: {} passes in a row with at least {:g} points\n", of, arguments.rules.passes_in_a_row,
             arguments.rules.score);
  for (const GroupProficiency& group : groups) print_group(group);
  return {};
}

struct TeachingArguments {
  std::string person, task;
  double minutes = 0.0;
  bool is_undone = false;
};

/// A misspelt task would take minutes that nobody ever sees: it is shipped, or has attempts.
Status check_taught_task(results::Repository& repository, const std::string& task) {
  TROCAR_TRY(const std::filesystem::path folder, find_data("tasks"));
  const Result<tasks::Task> shipped = tasks::load_task(folder, task);
  if (shipped) return {};
  TROCAR_TRY(const std::vector<results::Attempt> attempts, results::list_attempts(repository, {{}, task}));
  return attempts.empty() ? Status(tl::unexpected(shipped.error())) : Status();
}

Status note_teaching(const std::string& url, const TeachingArguments& arguments, bool has_minutes) {
  if (has_minutes == arguments.is_undone)
    return fail_usage("nothing to do", "trocar results taught", "give either --minutes or --undo");
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  TROCAR_TRY(const results::Person person, results::get_person_named(repository, arguments.person));
  TROCAR_TRY_STATUS(check_taught_task(repository, arguments.task));
  double minutes = arguments.minutes;
  if (arguments.is_undone) {
    TROCAR_TRY(minutes, results::remove_last_teaching(repository, person.id, arguments.task));
  } else {
    TROCAR_TRY_STATUS(results::add_teaching(repository, person.id, arguments.task, minutes, now_s()));
  }
  TROCAR_TRY(const auto all, results::teaching_minutes(repository, arguments.task));
  const auto now = all.find(person.id);
  fmt::print("{} {:g} min of an instructor, {}: {:g} min in all\n", arguments.is_undone ? "took back" : "noted",
             minutes, arguments.task, now == all.end() ? 0.0 : now->second);
  return {};
}

void add_taught_command(Command& results, const DatabaseOption& url, Action& action) {
  Command command = results.add_command("taught", "Note the minutes that an instructor spent with a person on a task");
  const auto a = std::make_shared<TeachingArguments>();
  command.add_option("person", a->person, "Name of the person").required();
  command.add_option("--task", a->task, "Task; see trocar task list").required();
  Option minutes = command.add_option("--minutes", a->minutes, "Minutes, added to those noted before")
                       .number_within(results::kLeastTeaching_min, results::kMostTeaching_min, "min");
  command.add_flag("--undo", a->is_undone, "Take the newest entry of person and task back");
  command.footer(
      "Examples:\n  trocar results taught \"Anna Meier\" --task liver-biopsy --minutes 25\n"
      "  trocar results taught \"Anna Meier\" --task liver-biopsy --undo\n");
  command.when_parsed([&action, url, a, minutes] {
    action = [url, a, minutes] { return note_teaching(*url, *a, minutes.is_given()); };
  });
}

}  // namespace

void add_results_proficiency_command(Command& results, const DatabaseOption& url, Action& action) {
  Command command = results.add_command(
      "proficiency", "Show how many attempts people need to become proficient, first-pass success and time");
  const auto a = std::make_shared<ProficiencyArguments>();
  command.add_option("--task", a->filter.task, "Task; see trocar task list").required();
  command.add_option("--course", a->filter.course, "Only people of this course");
  command.add_option("--patient", a->filter.patient, "Only attempts at this case: biopsy-2");
  command.add_option("--level", a->filter.level, "Only attempts at this level of help")
      .one_of({"guided", "assisted", "exam"});
  Option score =
      command.add_option("--score", a->rules.score, "Least points of a pass that counts [data/learning.toml]")
          .number_within(0.0, 100.0, "");
  command.add_option("--in-a-row", a->in_a_row, "Passes in a row [data/learning.toml]").whole_number_within(1, 20);
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.footer("Example:\n  trocar results proficiency --task liver-biopsy --course \"Radiology 2026\"\n");
  command.when_parsed(
      [&action, url, a, score] { action = [url, a, score] { return show_proficiency(*url, *a, score.is_given()); }; });
  add_taught_command(results, url, action);
}

}  // namespace trocar::cli
