#include "attempt/live/live_attempt.h"

#include <thread>
#include <utility>

#include "attempt/live/attempt_loop.h"

namespace trocar::attempt {
namespace {

LocalServerOptions server_options(const AttemptOptions& options, const char* tool) {
  LocalServerOptions of_tool;
  of_tool.tool = tool;
  of_tool.device = of_tool.tool == "needle" ? options.device_needle : options.device_probe;
  of_tool.rate_hz = options.rate_hz;
  of_tool.priority = options.priority;
  of_tool.flight_folder = options.session.parent_path();
  return of_tool;
}

bool fits_one(const LocalServer& server, const LocalServerOptions& wanted) {
  const LocalServerOptions& is = server.options();
  return is.device == wanted.device && is.rate_hz == wanted.rate_hz && is.priority == wanted.priority;
}

}  // namespace

bool is_moved_by_hand_targets(const std::string& device) {
  return device_hold(device) == DeviceHold::kOurHand;
}

Result<std::shared_ptr<SeatServers>> SeatServers::start(const AttemptOptions& options) {
  std::shared_ptr<SeatServers> servers(new SeatServers);
  TROCAR_TRY(servers->needle, LocalServer::start(server_options(options, "needle")));
  if (options.has_probe) {
    TROCAR_TRY(servers->probe, LocalServer::start(server_options(options, "probe")));
  }
  return servers;
}

bool SeatServers::fits(const AttemptOptions& options) const {
  if ((probe != nullptr) != options.has_probe || !fits_one(*needle, server_options(options, "needle"))) return false;
  return !probe || fits_one(*probe, server_options(options, "probe"));
}

struct LiveAttempt::Impl {
  AttemptDesk desk;
  std::jthread thread;
};

LiveAttempt::LiveAttempt(std::shared_ptr<const cases::OpenCase> open_case, AttemptOptions options,
                         std::shared_ptr<SeatServers> servers)
    : options_(std::move(options)), impl_(std::make_unique<Impl>()) {
  impl_->thread = std::jthread([desk = &impl_->desk, open_case = std::move(open_case), servers = std::move(servers),
                                chosen = options_](const std::stop_token& stop) mutable {
    AttemptLoop loop(std::move(open_case), chosen, std::move(servers), *desk);
    loop.run(stop);
  });
}

LiveAttempt::~LiveAttempt() = default;

AttemptView LiveAttempt::view() const {
  const std::lock_guard lock(impl_->desk.mutex);
  const AttemptNews& news = impl_->desk.news;
  AttemptView view = aged(news.view, seconds_between(news.told, options_.clock->now()));
  // A second press acts against the first, even where the thread has not taken that one yet.
  view.are_forces_stopped = impl_->desk.wishes.stopped.value_or(view.are_forces_stopped);
  return view;
}

std::vector<ForcePoint> LiveAttempt::take_forces() {
  const std::lock_guard lock(impl_->desk.mutex);
  return std::exchange(impl_->desk.news.forces, {});
}

std::vector<AttemptEvent> LiveAttempt::take_events() {
  const std::lock_guard lock(impl_->desk.mutex);
  return std::exchange(impl_->desk.news.events, {});
}

std::optional<Result<RunResult>> LiveAttempt::take_result() {
  const std::lock_guard lock(impl_->desk.mutex);
  return std::exchange(impl_->desk.news.result, std::nullopt);
}

std::shared_ptr<SeatServers> LiveAttempt::servers() const {
  const std::lock_guard lock(impl_->desk.mutex);
  return impl_->desk.news.servers;
}

void LiveAttempt::frame_drawn() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.has_drawn = true;
}

void LiveAttempt::set_hand(HandTool tool, const Pose& X_PTool, const Vec3& v_P, const Vec3& w_P) {
  const std::lock_guard lock(impl_->desk.mutex);
  AttemptWishes& wishes = impl_->desk.wishes;
  (tool == HandTool::kNeedle ? wishes.needle : wishes.probe) = AttemptWishes::Lead{X_PTool, v_P, w_P};
}

void LiveAttempt::hold(HandTool tool, bool is_clamped) {
  const std::lock_guard lock(impl_->desk.mutex);
  AttemptWishes& wishes = impl_->desk.wishes;
  (tool == HandTool::kNeedle ? wishes.needle_clamped : wishes.probe_clamped) = is_clamped;
}

void LiveAttempt::begin() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.begins = true;
}

void LiveAttempt::fire() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.fires = true;
}

void LiveAttempt::stop_forces() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.stopped = true;
}

void LiveAttempt::resume_forces() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.stopped = false;
}

void LiveAttempt::set_parameters(std::vector<std::string> settings) {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.settings.push_back(std::move(settings));
}

void LiveAttempt::perform(std::unique_ptr<tasks::Operator> the_operator) {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.news.view.is_performing = impl_->desk.news.view.is_performing || the_operator != nullptr;
  impl_->desk.wishes.performer = std::move(the_operator);
}

void LiveAttempt::finish() {
  const std::lock_guard lock(impl_->desk.mutex);
  impl_->desk.wishes.finishes = true;
}

}  // namespace trocar::attempt
