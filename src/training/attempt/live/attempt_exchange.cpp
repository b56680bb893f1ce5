#include "attempt/live/attempt_exchange.h"

#include <utility>

namespace trocar::attempt {

AttemptView AttemptExchange::view() const {
  const std::lock_guard lock(mutex_);
  AttemptView view = aged(update_.view, seconds_between(published_, clock_->now()));
  // A second key press acts against the first one, even before the loop has taken that one.
  view.are_forces_stopped = requests_.stopped.value_or(view.are_forces_stopped);
  return view;
}

std::vector<ForcePoint> AttemptExchange::take_forces() {
  const std::lock_guard lock(mutex_);
  return std::exchange(update_.forces, {});
}

std::vector<AttemptEvent> AttemptExchange::take_events() {
  const std::lock_guard lock(mutex_);
  return std::exchange(update_.events, {});
}

std::optional<Result<RunResult>> AttemptExchange::take_result() {
  const std::lock_guard lock(mutex_);
  return std::exchange(update_.result, std::nullopt);
}

std::shared_ptr<HapticServers> AttemptExchange::servers() const {
  const std::lock_guard lock(mutex_);
  return update_.servers;
}

void AttemptExchange::frame_drawn() {
  const std::lock_guard lock(mutex_);
  requests_.has_drawn = true;
}

void AttemptExchange::set_goal(Tool tool, const Pose& X_PTool, const Vec3& v_P, const Vec3& w_P) {
  const std::lock_guard lock(mutex_);
  (tool == Tool::kNeedle ? requests_.needle : requests_.probe) = AttemptRequests::Goal{X_PTool, v_P, w_P};
}

void AttemptExchange::clamp(Tool tool, bool is_clamped) {
  const std::lock_guard lock(mutex_);
  (tool == Tool::kNeedle ? requests_.needle_clamped : requests_.probe_clamped) = is_clamped;
}

void AttemptExchange::note_xray(const tasks::XrayUse& use) {
  const std::lock_guard lock(mutex_);
  requests_.xray.push_back(use);
}

void AttemptExchange::act(const tasks::ActionRequest& request) {
  const std::lock_guard lock(mutex_);
  requests_.actions.push_back(request);
}

void AttemptExchange::repeat_phase(std::size_t phase) {
  const std::lock_guard lock(mutex_);
  requests_.repeated_phase = phase;
}

void AttemptExchange::stop_forces() {
  const std::lock_guard lock(mutex_);
  requests_.stopped = true;
}

void AttemptExchange::resume_forces() {
  const std::lock_guard lock(mutex_);
  requests_.stopped = false;
}

void AttemptExchange::set_parameters(link::SetParameters parameters) {
  const std::lock_guard lock(mutex_);
  requests_.parameters.push_back(std::move(parameters));
}

void AttemptExchange::perform(std::unique_ptr<tasks::Operator> the_operator) {
  const std::lock_guard lock(mutex_);
  update_.view.is_performing = update_.view.is_performing || the_operator != nullptr;
  requests_.performer = std::move(the_operator);
}

void AttemptExchange::finish() {
  const std::lock_guard lock(mutex_);
  requests_.finishes = true;
}

AttemptRequests AttemptExchange::take_requests() {
  const std::lock_guard lock(mutex_);
  return std::exchange(requests_, {});
}

void AttemptExchange::publish(AttemptUpdate update) {
  constexpr std::size_t kMostKept = 100'000;  // if the client takes none
  const std::lock_guard lock(mutex_);
  update.view.is_performing = update.view.is_performing || requests_.performer != nullptr;
  update_.view = std::move(update.view);
  published_ = clock_->now();
  update_.servers = std::move(update.servers);
  if (update_.forces.size() < kMostKept)
    update_.forces.insert(update_.forces.end(), update.forces.begin(), update.forces.end());
  if (update_.events.size() < kMostKept)
    update_.events.insert(update_.events.end(), update.events.begin(), update.events.end());
  if (update.result) update_.result = std::move(update.result);
}

}  // namespace trocar::attempt
