#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "learning/history.h"
#include "phantom/phantom.h"
#include "tasks/task.h"

namespace trocar::learning {

/// Rules of the learning path, data/learning.toml. All numbers there are assumed; the file names the literature.
struct LearningRules {
  std::vector<std::string> order;     ///< Tasks, in the order in which they are begun; others follow.
  double mastery_score = 80.0;        ///< Least score of a pass that counts towards mastery. Range 0..100.
  int passes_in_a_row = 3;            ///< Range 1..20.
  double first_score = 90.0;          ///< A first attempt at an exercise with so many points masters it. 0..100.
  double exam_score = 80.0;           ///< A pass of an exam with so many points masters the case with help. 0..100.
  int most_in_a_row = 3;              ///< Then another exercise comes in between. Range 1..100.
  std::vector<int> intervals_days{};  ///< Until the first, second … repetition; rising, 1..3650. The last one stays.
  int plateau_attempts = 10;          ///< Attempts at an exercise over which progress is looked for. Range 3..100.
  double plateau_slope = 0.25;        ///< Progress, points an attempt; less is a plateau. Range 0..10.
  int plateau_rest = 10;              ///< Other attempts, after which the exercise is offered again. Range 1..1000.
  int recent_attempts = 5;            ///< Attempts over which the weakest part is found. Range 1..100.
  int least_attempts = 3;             ///< Of them, so many must have judged a part. Range 1..recent_attempts.
  double lost_points = 10.0;          ///< A part is weak that costs at least so many points on average. Range 0..100.
  int more_help_attempts = 2;         ///< With more help, before the exercise itself comes again. Range 1..20.
};

/// An embedded patient that a task is practised on.
struct CourseCase {
  std::string patient;  ///< "biopsy-2".
  int difficulty = 1;   ///< 1 (easiest) to 5.
};

/// A task with its cases.
struct Course {
  std::string task, title;
  std::vector<CourseCase> cases;                            ///< By difficulty.
  std::map<std::string, double, std::less<>> part_weights;  ///< Points of the parts that the task judges.
};

/// Everything that can be practised.
struct Curriculum {
  LearningRules rules;
  std::vector<Course> courses;  ///< In the order in which they are begun.

  const Course* find(std::string_view task) const noexcept;
};

/// What to practise: a case of a task at a level of help.
struct Exercise {
  std::string task, patient;
  int difficulty = 1;
  TrainingMode level = TrainingMode::kGuided;

  bool operator==(const Exercise&) const = default;
};
/// "Liver biopsy, case 2, assisted".
std::string exercise_text(const Exercise& exercise, const Curriculum& curriculum);

/// Name of the rules in the data folder.
inline constexpr const char* kRulesFile = "learning.toml";
/// Errors name file and key: a missing or unknown key, a number out of its range, intervals that do not rise.
Result<LearningRules> load_rules(const std::filesystem::path& file);

/// The tasks with the embedded patients that were made for them. Patients without a difficulty are test scenes.
Curriculum make_curriculum(LearningRules rules, std::span<const tasks::Task> tasks,
                           std::span<const phantom::PhantomInfo> patients);
/// That of the data folder. Errors: those of load_rules and of tasks::load_tasks; `order` names an unknown task.
Result<Curriculum> load_curriculum(const std::filesystem::path& data_folder);

}  // namespace trocar::learning
