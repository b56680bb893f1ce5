#include <algorithm>
#include <utility>

#include "tasks/operator.h"
#include "telemetry/tick_pose.h"

namespace trocar::tasks {
namespace {

class Replay final : public Operator {
 public:
  Replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions) noexcept
      : samples_(std::move(samples)), actions_(std::move(actions)) {}

  HandCommand next(const OperatorView& view) noexcept override {
    HandCommand command;
    command.is_rigid = true;
    if (samples_.empty()) {
      command.X_PN = view.X_PN_device;
      command.is_done = true;
      return command;
    }
    command.is_done = next_ >= samples_.size();
    const std::size_t now = std::min(next_, samples_.size() - 1);
    command.action = next_action(samples_[now].time_s);
    command.X_PN = telemetry::device_pose(samples_[now]);
    if (!command.is_done && now > 0) {
      const double dt_s = samples_[now].time_s - samples_[now - 1].time_s;
      if (dt_s > 0.0) command.v_P = (samples_[now].device_mm - samples_[now - 1].device_mm) / dt_s;
    }
    if (!command.is_done) ++next_;
    return command;
  }

 private:
  /// The next action that is due; two of one tick follow each other.
  std::optional<ActionRequest> next_action(double time_s) noexcept {
    constexpr double kLater_s = 1e-5;  // actions of one tick are recorded a little after each other
    if (next_action_ >= actions_.size() || actions_[next_action_].time_s > time_s + kLater_s) return std::nullopt;
    const Action& action = actions_[next_action_++];
    return ActionRequest{action.kind, action.amount};
  }

  std::vector<telemetry::TickSample> samples_;
  std::vector<Action> actions_;
  std::size_t next_ = 0, next_action_ = 0;
};

}  // namespace

std::unique_ptr<Operator> make_replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions) {
  return std::make_unique<Replay>(std::move(samples), std::move(actions));
}

}  // namespace trocar::tasks
