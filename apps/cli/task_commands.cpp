// trocar task list.
#include <fmt/format.h>

#include "cli/commands.h"
#include "config/json.h"
#include "tasks/task.h"

namespace trocar::cli {
namespace {

Status list_tasks(bool is_json) {
  TROCAR_TRY(const auto folder, find_data("tasks"));
  TROCAR_TRY(const auto tasks, tasks::load_tasks(folder));
  if (!is_json) {
    for (const tasks::Task& task : tasks) {
      fmt::print("{:<16} {} (needle: {})\n", task.name, task.title, task.needle);
      for (std::size_t n = 0; n < task.levels.size(); ++n)
        fmt::print("{:>18} {:<8} {}\n", fmt::format("level {}", n + 1), task.levels[n].name, task.levels[n].title);
    }
    return {};
  }
  config::Json list = config::Json::array();
  for (const tasks::Task& task : tasks) {
    config::Json levels = config::Json::array();
    for (const tasks::Tier& level : task.levels) levels.push_back({{"name", level.name}, {"title", level.title}});
    list.push_back({{"name", task.name},
                    {"title", task.title},
                    {"organ", task.organ},
                    {"target_tissues", task.target_tissues},
                    {"needle", task.needle},
                    {"levels", levels},
                    {"time_limit_s", task.time_limit_s}});
  }
  print_json({{"tasks", list}});
  return {};
}

}  // namespace

void add_task_commands(Command& program, Action& action) {
  Command task = program.add_command("task", "Training tasks");
  task.require_command();
  task.footer("Example:\n  trocar task list\n");
  Command list = task.add_command("list", "List the tasks and the needle of each");
  list.footer("Example:\n  trocar task list --json\n");
  const auto is_json = std::make_shared<bool>(false);
  list.add_flag("--json", *is_json, "Print one JSON object");
  list.when_parsed([&action, is_json] { action = [is_json] { return list_tasks(*is_json); }; });
}

}  // namespace trocar::cli
