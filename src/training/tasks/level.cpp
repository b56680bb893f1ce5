#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>

#include "core/parse_number.h"
#include "tasks/task.h"

namespace trocar::tasks {

Result<Task> at_level(Task task, std::string_view name_or_number) {
  if (!task.level.empty())
    return fail_usage(fmt::format("the task {} has the level \"{}\" already", task.name, task.level),
                      std::string(name_or_number), "name a task without a level");
  auto found = std::ranges::find(task.levels, name_or_number, &Tier::name);
  const auto number = parse_number<int>(name_or_number);
  if (found == task.levels.end() && number && *number >= 1 && *number <= static_cast<int>(task.levels.size()))
    found = task.levels.begin() + (*number - 1);
  if (found == task.levels.end()) {
    std::vector<std::string> known;
    for (const Tier& level : task.levels) known.push_back(fmt::format("{} {}", known.size() + 1, level.name));
    return fail_usage(fmt::format("the task {} has no level \"{}\"", task.name, name_or_number), {},
                      known.empty() ? std::string("add [[levels]] to its file")
                                    : fmt::format("known are: {}", fmt::join(known, ", ")));
  }
  const Tier& level = *found;
  task.level = level.name;
  if (level.time_limit_s > 0.0) task.time_limit_s = level.time_limit_s;
  for (double* const tolerance :
       {&task.target_tolerance_mm, &task.entry_tolerance_mm, &task.angle_tolerance_deg, &task.margin_tolerance_mm})
    *tolerance *= level.tolerance_share;
  return task;
}

const Tier* level_of(const Task& task) noexcept {
  const auto found = std::ranges::find(task.levels, task.level, &Tier::name);
  return !task.level.empty() && found != task.levels.end() ? &*found : nullptr;
}

}  // namespace trocar::tasks
