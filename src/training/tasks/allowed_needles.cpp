#include "tasks/allowed_needles.h"

namespace trocar::tasks {

std::vector<std::string> allowed_needles(const Task& task, const std::vector<Needle>& all) {
  std::vector<std::string> allowed{task.needle};
  const auto add = [&](const std::string& name) {
    if (name != task.needle) allowed.push_back(name);
  };
  for (const std::string& name : task.needles) add(name);
  if (!task.needles.empty()) return allowed;
  for (const Needle& needle : needles_like(all, task.needle)) add(needle.name);
  return allowed;
}

}  // namespace trocar::tasks
