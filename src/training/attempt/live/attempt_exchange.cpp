#include "attempt/live/attempt_exchange.h"

#include <utility>

namespace trocar::attempt {

AttemptView AttemptExchange::view() const {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const AttemptView> newest = states_.value();
  AttemptView view = newest ? aged(*newest, seconds_between(newest->made, clock_->now())) : AttemptView{};
  // A second key press acts against the first one, even before the loop has answered that one.
  view.are_forces_stopped = stopped_.value_or(view.are_forces_stopped);
  view.is_performing = view.is_performing || performs_;
  return view;
}

std::vector<ForcePoint> AttemptExchange::take_forces() {
  const std::lock_guard lock(mutex_);
  return std::exchange(untaken_.forces, {});
}

std::vector<AttemptEvent> AttemptExchange::take_events() {
  const std::lock_guard lock(mutex_);
  return std::exchange(untaken_.events, {});
}

std::optional<Result<RunResult>> AttemptExchange::take_result() {
  const std::lock_guard lock(mutex_);
  return std::exchange(untaken_.result, std::nullopt);
}

std::shared_ptr<HapticServers> AttemptExchange::servers() const {
  const std::lock_guard lock(mutex_);
  return untaken_.servers;
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
  requests_.stopped = stopped_ = true;
}

void AttemptExchange::resume_forces() {
  const std::lock_guard lock(mutex_);
  requests_.stopped = stopped_ = false;
}

void AttemptExchange::set_parameters(link::SetParameters parameters) {
  const std::lock_guard lock(mutex_);
  requests_.parameters.push_back(std::move(parameters));
}

void AttemptExchange::perform(std::unique_ptr<tasks::Operator> the_operator) {
  const std::lock_guard lock(mutex_);
  performs_ = performs_ || the_operator != nullptr;
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
  update.view.made = clock_->now();
  const std::lock_guard lock(mutex_);
  states_.publish(std::move(update.view));
  stopped_ = requests_.stopped;
  performs_ = requests_.performer != nullptr;
  untaken_.servers = std::move(update.servers);
  if (untaken_.forces.size() < kMostKept)
    untaken_.forces.insert(untaken_.forces.end(), update.forces.begin(), update.forces.end());
  if (untaken_.events.size() < kMostKept)
    untaken_.events.insert(untaken_.events.end(), update.events.begin(), update.events.end());
  if (update.result) untaken_.result = std::move(update.result);
}

}  // namespace trocar::attempt
