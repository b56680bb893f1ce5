#pragma once

#include <optional>
#include <utility>

#include "tasks/operator.h"

namespace trocar::tasks {

/// The actions that a scripted operator has still to do, each once.
class PendingActions {
 public:
  explicit PendingActions(const OperatorActions& actions) noexcept : left_(actions) {}

  void forget_anaesthetic() noexcept { left_.gives_anaesthetic = false; }
  void forget_confirmation() noexcept { left_.confirms.reset(); }
  void look_again(ActionKind confirms) noexcept { left_.confirms = confirms; }

  /// The action that is due: anaesthetic at the skin, the others at the target, the guide wire `kBeforeWire_s` after
  /// the arrival. `tip_mm`: along the path from its entry. `at_target_s`: time since the arrival; empty: not there.
  std::optional<ActionRequest> next(double tip_mm, std::optional<double> at_target_s) noexcept {
    if (left_.gives_anaesthetic && tip_mm > -kAtSkin_mm) {
      left_.gives_anaesthetic = false;
      return ActionRequest{ActionKind::kAnaesthetise, kAnaesthetic_ml};
    }
    if (!at_target_s) return std::nullopt;
    if (left_.confirms) return ActionRequest{*std::exchange(left_.confirms, std::nullopt), 0.0};
    if (left_.wire_mm > 0.0 && *at_target_s > kBeforeWire_s)
      return ActionRequest{ActionKind::kAdvanceWire, std::exchange(left_.wire_mm, 0.0)};
    return std::nullopt;
  }

 private:
  static constexpr double kAnaesthetic_ml = 5.0;
  static constexpr double kAtSkin_mm = 4.0;
  static constexpr double kBeforeWire_s = 0.25;
  OperatorActions left_;
};

}  // namespace trocar::tasks
