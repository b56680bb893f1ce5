#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/result.h"
#include "metrics/metric.h"
#include "results/proficiency.h"

namespace trocar::web {

/// What the data folder says: titles of tasks and metrics, their order, and when a person is called proficient.
class Titles {
 public:
  /// From the data folder. Errors: those of tasks::load_tasks and learning::load_rules.
  static Result<Titles> load(const std::filesystem::path& data_folder);

  struct Task {
    std::string id, title;
  };
  const std::vector<Task>& tasks() const noexcept { return tasks_; }
  /// The title of a task; its id if it is another department's own task.
  std::string task_title(std::string_view id) const;

  struct Metric {
    std::string name, title, unit;
    metrics::Better better = metrics::Better::kNeither;
  };
  const Metric& score() const noexcept { return score_; }
  /// A metric of the catalogue; another one with this unit and its name as title if there is none.
  Metric metric(std::string_view name, std::string_view unit) const;
  const results::ProficiencyRules& proficiency() const noexcept { return proficiency_; }
  /// Position in reports; those that are not in the catalogue come last.
  std::size_t order_of(std::string_view name) const;

 private:
  std::vector<Task> tasks_;
  std::vector<Metric> metrics_;
  std::map<std::string, std::size_t, std::less<>> position_;
  results::ProficiencyRules proficiency_;
  Metric score_{"score", "Score", "points", metrics::Better::kHigher};
};

/// "lower", "higher", "neither".
const char* to_string(metrics::Better better) noexcept;

}  // namespace trocar::web
