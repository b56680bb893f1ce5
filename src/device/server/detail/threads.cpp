#include "server/detail/threads.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <thread>
#include <utility>

#include "core/log.h"
#include "haptics/option_texts.h"
#include "realtime/periodic_loop.h"
#include "server/detail/shared.h"
#include "server/flight_recorder.h"
#include "server/servo_commands.h"

namespace trocar::server {
namespace {

constexpr std::chrono::milliseconds kPausePatience{2000};  // the forces fade first, for 0.2 s

/// While it exists, the real-time thread has faded the forces and does not access the device.
class DevicePause {
 public:
  explicit DevicePause(Shared& shared) : shared_(shared), ticket_(shared.lease.ask()) {
    const auto end = std::chrono::steady_clock::now() + kPausePatience;
    while (!is_granted() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~DevicePause() { shared_.lease.give_back(ticket_); }
  DevicePause(const DevicePause&) = delete;
  DevicePause& operator=(const DevicePause&) = delete;
  bool is_granted() const { return shared_.lease.is_leased(ticket_); }

 private:
  Shared& shared_;
  std::uint64_t ticket_;
};

}  // namespace

std::size_t text_bytes(const ControlJob& job) {
  if (const auto* scene = std::get_if<link::LoadScene>(&job.what)) {
    return scene->task.size() + scene->patient.size() + scene->patient_hash.size() + scene->motion_hash.size() +
           scene->tool.size() + scene->force_model.size() + scene->tissues_toml.size();
  }
  std::size_t bytes = 0;
  if (const auto* parameters = std::get_if<link::SetParameters>(&job.what)) {
    bytes += parameters->tissues_toml.size() + parameters->force_model.size();
    if (parameters->tissues) {
      for (const link::TissueSetting& setting : *parameters->tissues)
        bytes += setting.row.size() + setting.key.size() + sizeof setting;
    }
  }
  return bytes;
}

Control::Control(Shared& shared, devices::HapticDevice& device, SceneBuilder builder, std::string tool,
                 std::filesystem::path flight_folder)
    : shared_(shared),
      device_(device),
      builder_(std::move(builder)),
      tool_(std::move(tool)),
      flight_folder_(std::move(flight_folder)) {}

void Control::run() {
  const CrashStack stack;
  ControlJob job;
  while (shared_.control_queue.wait(job)) {
    std::optional<LimitedLog> limited;
    if (job.session != 0) limited.emplace(*shared_.log_limit);  // also for the lines of the job
    const Result<std::string> done = perform(job);
    if (done) {
      log_info("{}", *done);
    } else {
      log_warning("{}", done.error().text());
    }
    limited.reset();
    if (job.session != 0) shared_.control_queue.answer({job.session, make_reply(job, done)});
    shared_.scene.collect();
  }
}

link::Reply Control::make_reply(const ControlJob& job, const Result<std::string>& done) const {
  link::Reply reply{job.request, done.has_value(), done ? *done : done.error().text()};
  const bool makes_scene =
      std::holds_alternative<link::LoadScene>(job.what) || std::holds_alternative<link::SetParameters>(job.what);
  if (!done || !makes_scene || scene_ == nullptr) return reply;
  reply.scene = scene_->number;
  reply.options = haptics::option_texts(*scene_->scene);
  reply.tissues_toml = builder_.tissues().to_toml();
  return reply;
}

Result<std::string> Control::perform(const ControlJob& job) {
  return std::visit([this](const auto& what) { return perform(what); }, job.what);
}

void Control::publish(const ServoScene& scene) {
  scene_ = std::make_shared<const ServoScene>(scene);
  shared_.scene.publish(scene_);
  const link::LoadScene& request = builder_.request();
  shared_.control_queue.update([&](ControlStatus& status) {
    status.has_scene = true;
    status.patient = request.patient;
    status.patient_hash = builder_.patient()->content_hash;
    status.force_model = to_string(scene.scene->options.force_model);
    status.task = request.task;
  });
}

Result<std::string> Control::perform(const link::LoadScene& request) {
  if (request.tool != tool_)
    return fail(fmt::format("this server controls the {}, not the {}", tool_, request.tool), "tool",
                "send the scene to the other server");
  const auto tell = [this](double done) {
    shared_.control_queue.update([&](ControlStatus& status) { status.loading = done; });
  };
  constexpr double kBegun = 0.01;
  tell(kBegun);
  const Result<ServoScene> scene = builder_.load(
      request, [&](std::string_view, double fraction) { tell(std::max(kBegun, fraction)); },
      shared_.control_queue.stop_token());
  tell(0.0);
  if (!scene) return tl::unexpected(scene.error());
  publish(*scene);
  return fmt::format("scene {} is loaded: {}, {} model", scene->number, request.patient,
                     to_string(scene->scene->options.force_model));
}

Result<std::string> Control::perform(const link::SetParameters& request) {
  TROCAR_TRY(const ServoScene scene, builder_.change(request));
  publish(scene);
  return fmt::format("scene {} has changed parameters; the coupling is {:.3g} N/mm", scene.number,
                     scene.scene->options.coupling.stiffness_n_per_mm);
}

Result<std::string> Control::perform(link::ServerCommand) {
  const DevicePause pause(shared_);
  if (!pause.is_granted())
    return fail("the real-time thread does not release the device", device_.name(),
                "try again; restart trocar-hapticd if it stays so");
  TROCAR_TRY_STATUS(device_.reconnect());
  return fmt::format("{} is open again; reset the fault to continue", device_.name());
}

void Control::check_flights() {
  if (flight_folder_.empty()) return;
  const Status checked = check_flight_folder(flight_folder_);
  if (checked) return;
  const std::string text = fmt::format("flight records cannot be written: {}", checked.error().text());
  log_warning("{}", text);
  shared_.control_queue.update([&](ControlStatus& status) { status.warning = text; });
}

Result<std::string> Control::write(const Flight& flight) {
  if (flight_folder_.empty()) return std::string("no folder for flight records was given");
  const Result<std::filesystem::path> path =
      write_flight(flight_folder_, flight_time(std::chrono::system_clock::now()), flight);
  const std::string text =
      path ? fmt::format("fault: the last {} periods were saved to {}", flight.size(), path->string())
           : fmt::format("the flight record could not be written: {}", path.error().text());
  shared_.control_queue.update([&](ControlStatus& status) { status.warning = text; });
  if (!path) return tl::unexpected(path.error());
  return text;
}

namespace {

constexpr double kStatistics_s = 0.05;  // interval of copying the statistics

/// Applies the stops; called in every period, also while the device is leased.
void apply_stops(Shared& shared, ServoSwitches& switches, const realtime::Period& period,
                 StopStatistics& stops) noexcept {
  if (!shared.commands.apply_stops(switches)) return;
  const std::int64_t now_ns = realtime::now_ns();
  const auto since_last_ns = static_cast<std::int64_t>(std::llround(period.dt_s * 1e9));
  stops.add(now_ns - shared.commands.stopped_ns(), now_ns - period.begin_ns + since_last_ns - shared.period_ns);
}

/// Applies a bounded number of commands.
void apply_commands(Shared& shared, ServoSwitches& switches, realtime::LoopStatistics& statistics) noexcept {
  switches.begin_period();
  shared.commands.apply_commands(switches);
  if (switches.restarts_statistics) statistics = realtime::LoopStatistics(shared.period_ns);
}

void publish(Shared& shared, ServoSwitches& switches) noexcept {
  if (shared.is_fading.load(std::memory_order_relaxed)) switches.is_wanted = false;
  shared.is_wanted.store(switches.is_wanted, std::memory_order_relaxed);
  shared.commands.confirm(switches);
}

/// The newest hand, if there is a new one; placed if any target since the last period was.
std::optional<link::HandTarget> take_hand(Shared& shared, std::uint64_t& placements) noexcept {
  if (!shared.hand.update()) return {};
  const CountedHand& newest = shared.hand.value();
  link::HandTarget target = newest.target;
  target.is_placed = std::exchange(placements, newest.placements) != newest.placements;
  target.pressed_mm = newest.pressed_mm;
  return target;
}

}  // namespace

void run_servo_thread(Shared& shared, Servo& servo, int priority) noexcept {
  const CrashStack stack;
  if (shared.crash_handler != nullptr) shared.crash_handler->adopt_thread();
  shared.grant = realtime::request_real_time(priority);
  shared.has_grant.store(true, std::memory_order_release);
  realtime::LoopStatistics statistics(shared.period_ns);
  ServoSwitches switches;
  StopStatistics stops;
  std::uint64_t placements = 0;
  double told_s = 0.0;
  bool is_leased = false;
  std::int64_t busy_ns = 0;
  realtime::run_periodic(
      shared.period_ns, shared.is_stopping, statistics,
      [&](const realtime::Period& period, const realtime::LoopStatistics& so_far) {
        const DeviceLease::Request request = shared.lease.look();
        if (shared.crash_handler != nullptr && shared.crash_handler->takes_over(is_leased && request.is_open)) return;
        apply_stops(shared, switches, period, stops);
        if (request.is_open && (is_leased || !servo.gives_force())) {
          publish(shared, switches);
          is_leased = true;
          shared.lease.grant(request);
          return;  // commands are waiting: a reset must not be lost
        }
        if (std::exchange(is_leased, false)) {
          servo.resume();
          busy_ns = 0;
        }

        const std::int64_t begun_ns = realtime::now_ns();
        apply_commands(shared, switches, statistics);
        publish(shared, switches);

        ServoInput input;
        input.now_s = period.now_s;
        input.dt_s = period.dt_s;
        input.scene = shared.scene.acquire();
        input.hand = take_hand(shared, placements);
        const std::int64_t heard_ns = shared.heard_ns.load(std::memory_order_relaxed);
        input.silence_s = heard_ns == 0 ? kNeverHeard_s : realtime::seconds(period.begin_ns - heard_ns);
        input.is_wanted =
            switches.is_wanted && !request.is_open;  // on request: forces fade before the device is leased
        input.is_stylet_in = switches.is_stylet_in;
        input.is_reset = switches.is_reset;
        input.busy_s = realtime::seconds(busy_ns);
        if (!shared.records.push(servo.step(input))) shared.records_dropped.fetch_add(1, std::memory_order_relaxed);
        busy_ns = realtime::now_ns() - begun_ns;

        if (period.now_s - told_s < kStatistics_s) return;
        told_s = period.now_s;
        shared.statistics.write(so_far);
      });
  shared.statistics.write(statistics);
  shared.stops = stops;
}

}  // namespace trocar::server
