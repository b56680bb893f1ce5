#include "learning/curriculum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/toml.h"

namespace trocar::learning {
namespace {

constexpr config::Range kScore{0.0, 100.0}, kRow{1.0, 20.0}, kDays{1.0, 3650.0}, kAttempts{1.0, 100.0},
    kSlope{0.0, 10.0}, kWindow{3.0, 100.0}, kRest{1.0, 1000.0};

Result<int> read_count(const config::TomlTable& table, std::string_view key, config::Range range) {
  TROCAR_TRY(const std::int64_t count, table.integer(key, range));
  return static_cast<int>(count);
}

Result<std::vector<int>> read_intervals(const config::TomlTable& table) {
  constexpr std::string_view kKey = "intervals_days";
  TROCAR_TRY(const std::vector<double> days, table.numbers(kKey, kDays));
  std::vector<int> intervals;
  for (const double day : days) {
    if (day != std::floor(day) || (!intervals.empty() && day <= intervals.back()))
      return fail("the intervals must be whole days that rise", table.where() + fmt::format(": {}", kKey),
                  "write for example [1, 3, 7, 16, 35]");
    intervals.push_back(static_cast<int>(day));
  }
  if (intervals.empty())
    return fail("there is no interval", table.where() + fmt::format(": {}", kKey), "write at least one number of days");
  return intervals;
}

/// Position in the order; tasks that it does not name are last.
std::size_t place_of(const std::vector<std::string>& order, const std::string& task) {
  return static_cast<std::size_t>(std::find(order.begin(), order.end(), task) - order.begin());
}

}  // namespace

const Course* Curriculum::find(std::string_view task) const noexcept {
  const auto found =
      std::find_if(courses.begin(), courses.end(), [&](const Course& course) { return course.task == task; });
  return found == courses.end() ? nullptr : &*found;
}

std::string exercise_text(const Exercise& exercise, const Curriculum& curriculum) {
  const Course* course = curriculum.find(exercise.task);
  return fmt::format("{}, case {}, {}", course != nullptr ? course->title : exercise.task, exercise.difficulty,
                     to_string(exercise.level));
}

Result<LearningRules> load_rules(const std::filesystem::path& file) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  TROCAR_TRY_STATUS(
      document.check_keys({"order", "mastery", "test_out", "interleaving", "repetition", "plateau", "weakness"}));
  LearningRules rules;
  TROCAR_TRY(rules.order, document.strings("order"));
  TROCAR_TRY(const config::TomlTable mastery, document.table("mastery"));
  TROCAR_TRY_STATUS(mastery.check_keys({"score", "passes_in_a_row"}));
  TROCAR_TRY(rules.mastery_score, mastery.number("score", kScore));
  TROCAR_TRY(rules.passes_in_a_row, read_count(mastery, "passes_in_a_row", kRow));
  TROCAR_TRY(const config::TomlTable test_out, document.table("test_out"));
  TROCAR_TRY_STATUS(test_out.check_keys({"first_score", "exam_score"}));
  TROCAR_TRY(rules.first_score, test_out.number("first_score", kScore));
  TROCAR_TRY(rules.exam_score, test_out.number("exam_score", kScore));
  TROCAR_TRY(const config::TomlTable interleaving, document.table("interleaving"));
  TROCAR_TRY_STATUS(interleaving.check_keys({"most_in_a_row"}));
  TROCAR_TRY(rules.most_in_a_row, read_count(interleaving, "most_in_a_row", kAttempts));
  TROCAR_TRY(const config::TomlTable repetition, document.table("repetition"));
  TROCAR_TRY_STATUS(repetition.check_keys({"intervals_days"}));
  TROCAR_TRY(rules.intervals_days, read_intervals(repetition));
  TROCAR_TRY(const config::TomlTable plateau, document.table("plateau"));
  TROCAR_TRY_STATUS(plateau.check_keys({"attempts", "least_slope", "rest_attempts"}));
  TROCAR_TRY(rules.plateau_attempts, read_count(plateau, "attempts", kWindow));
  TROCAR_TRY(rules.plateau_slope, plateau.number("least_slope", kSlope));
  TROCAR_TRY(rules.plateau_rest, read_count(plateau, "rest_attempts", kRest));
  TROCAR_TRY(const config::TomlTable weakness, document.table("weakness"));
  TROCAR_TRY_STATUS(weakness.check_keys({"recent_attempts", "least_attempts", "lost_points", "more_help_attempts"}));
  TROCAR_TRY(rules.recent_attempts, read_count(weakness, "recent_attempts", kAttempts));
  TROCAR_TRY(rules.least_attempts,
             read_count(weakness, "least_attempts", {1.0, static_cast<double>(rules.recent_attempts)}));
  TROCAR_TRY(rules.lost_points, weakness.number("lost_points", kScore));
  TROCAR_TRY(rules.more_help_attempts, read_count(weakness, "more_help_attempts", kRow));
  return rules;
}

Curriculum make_curriculum(LearningRules rules, std::span<const tasks::Task> tasks,
                           std::span<const phantom::PhantomInfo> patients) {
  Curriculum curriculum{std::move(rules), {}};
  for (const tasks::Task& task : tasks) {
    Course course{task.name, task.title, {}, task.weights};
    for (const phantom::PhantomInfo& patient : patients)
      if (patient.difficulty > 0 &&
          std::find(patient.tasks.begin(), patient.tasks.end(), task.name) != patient.tasks.end())
        course.cases.push_back({patient.name, patient.difficulty});
    std::stable_sort(course.cases.begin(), course.cases.end(),
                     [](const CourseCase& a, const CourseCase& b) { return a.difficulty < b.difficulty; });
    curriculum.courses.push_back(std::move(course));
  }
  const std::vector<std::string>& order = curriculum.rules.order;
  std::stable_sort(curriculum.courses.begin(), curriculum.courses.end(),
                   [&](const Course& a, const Course& b) { return place_of(order, a.task) < place_of(order, b.task); });
  return curriculum;
}

Result<Curriculum> load_curriculum(const std::filesystem::path& data_folder) {
  const std::filesystem::path file = data_folder / kRulesFile;
  TROCAR_TRY(LearningRules rules, load_rules(file));
  TROCAR_TRY(const std::vector<tasks::Task> tasks, tasks::load_tasks(data_folder / "tasks"));
  for (const std::string& name : rules.order)
    if (std::none_of(tasks.begin(), tasks.end(), [&](const tasks::Task& task) { return task.name == name; }))
      return fail(fmt::format("there is no task \"{}\"", name), file.string() + ": order",
                  "name tasks of trocar task list");
  return make_curriculum(std::move(rules), tasks, phantom::embedded_patients());
}

}  // namespace trocar::learning
