#include "tasks/action.h"

#include <algorithm>
#include <array>

namespace trocar::tasks {
namespace {

constexpr std::array kActionNames{"anaesthetise", "draw_stylet", "replace_stylet", "aspirate", "advance_wire",
                                  "hold_breath",  "breathe",     "fire",           "load"};
static_assert(kActionNames.size() == static_cast<std::size_t>(kLastAction) + 1);

}  // namespace

const char* to_string(ActionKind kind) noexcept {
  return kActionNames[static_cast<std::size_t>(kind)];
}

std::optional<ActionKind> find_action(std::string_view name) noexcept {
  const auto found = std::find(kActionNames.begin(), kActionNames.end(), name);
  if (found == kActionNames.end()) return std::nullopt;
  return static_cast<ActionKind>(found - kActionNames.begin());
}

const Action* find_wire(std::span<const Action> actions, double time_s) noexcept {
  const Action* wire = nullptr;
  for (const Action& action : actions) {
    if (action.time_s > time_s) break;
    if (action.kind == ActionKind::kAdvanceWire) wire = &action;
    if (action.kind == ActionKind::kReplaceStylet) wire = nullptr;
  }
  return wire;
}

std::optional<Return> last_return(std::span<const Action> actions) noexcept {
  for (auto action = actions.rbegin(); action != actions.rend(); ++action)
    if (action->kind == ActionKind::kDrawStylet || action->kind == ActionKind::kAspirate) return action->result;
  return std::nullopt;
}

bool is_gun_loaded(std::span<const Action> actions) noexcept {
  bool is_loaded = true;
  for (const Action& action : actions) {
    if (action.kind == ActionKind::kFire) is_loaded = false;
    if (action.kind == ActionKind::kLoad) is_loaded = true;
  }
  return is_loaded;
}

}  // namespace trocar::tasks
