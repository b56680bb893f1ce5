#include <algorithm>
#include <utility>

#include "tasks/operator.h"
#include "telemetry/tick_pose.h"

namespace trocar::tasks {
namespace {

class Replay final : public Operator {
 public:
  Replay(std::vector<telemetry::TickSample> samples, std::optional<std::size_t> fired) noexcept
      : samples_(std::move(samples)), fired_(fired) {}

  HandCommand next(const OperatorView& view) noexcept override {
    HandCommand command;
    command.is_rigid = true;
    if (samples_.empty()) {
      command.X_PN = view.X_PN_device;
      command.is_done = true;
      return command;
    }
    command.is_done = next_ >= samples_.size();
    command.has_fired = fired_ == next_;
    const std::size_t now = std::min(next_, samples_.size() - 1);
    command.X_PN = telemetry::device_pose(samples_[now]);
    if (!command.is_done && now > 0) {
      const double dt_s = samples_[now].time_s - samples_[now - 1].time_s;
      if (dt_s > 0.0) command.v_P = (samples_[now].device_mm - samples_[now - 1].device_mm) / dt_s;
    }
    if (!command.is_done) ++next_;
    return command;
  }

 private:
  std::vector<telemetry::TickSample> samples_;
  std::optional<std::size_t> fired_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<Operator> make_replay(std::vector<telemetry::TickSample> samples, std::optional<std::size_t> fired) {
  return std::make_unique<Replay>(std::move(samples), fired);
}

}  // namespace trocar::tasks
