#include <cmath>
#include <optional>
#include <utility>

#include "realtime/periodic_loop.h"
#include "server/detail/shared.h"
#include "server/servo_commands.h"

namespace trocar::server {
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
