#include "tasks/action.h"

#include <algorithm>
#include <array>

namespace trocar::tasks {
namespace {

constexpr std::array kNames{"anaesthetise", "draw_stylet", "replace_stylet", "aspirate",
                            "advance_wire", "hold_breath", "breathe"};
static_assert(kNames.size() == static_cast<std::size_t>(kLastAction) + 1);

}  // namespace

const char* to_string(ActionKind kind) noexcept {
  return kNames[static_cast<std::size_t>(kind)];
}

std::optional<ActionKind> find_action(std::string_view name) noexcept {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<ActionKind>(found - kNames.begin());
}

}  // namespace trocar::tasks
