#include "web/api/titles.h"

#include "learning/curriculum.h"
#include "tasks/task.h"

namespace trocar::web {

Result<Titles> Titles::load(const std::filesystem::path& data_folder) {
  Titles titles;
  TROCAR_TRY(const std::vector<tasks::Task> tasks, tasks::load_tasks(data_folder / "tasks"));
  for (const tasks::Task& task : tasks) titles.tasks_.push_back({task.name, task.title});
  for (const metrics::MetricDescription& metric : metrics::metric_catalogue()) {
    titles.position_.emplace(metric.name, titles.metrics_.size());
    titles.metrics_.push_back({metric.name, metric.title, metric.unit, metric.better});
  }
  TROCAR_TRY(const learning::LearningRules rules, learning::load_rules(data_folder / learning::kRulesFile));
  titles.proficiency_ = {rules.mastery_score, rules.passes_in_a_row};
  return titles;
}

std::string Titles::task_title(std::string_view id) const {
  for (const Task& task : tasks_)
    if (task.id == id) return task.title;
  return std::string(id);
}

Titles::Metric Titles::metric(std::string_view name, std::string_view unit) const {
  if (name == score_.name) return score_;
  const auto found = position_.find(name);
  if (found != position_.end()) return metrics_[found->second];
  return {std::string(name), std::string(name), std::string(unit), metrics::Better::kNeither};
}

std::size_t Titles::order_of(std::string_view name) const {
  const auto found = position_.find(name);
  return found == position_.end() ? metrics_.size() : found->second;
}

const char* to_string(metrics::Better better) noexcept {
  switch (better) {
    case metrics::Better::kLower:
      return "lower";
    case metrics::Better::kHigher:
      return "higher";
    case metrics::Better::kNeither:
      break;
  }
  return "neither";
}

}  // namespace trocar::web
