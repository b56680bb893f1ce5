#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "link/messages.h"
#include "realtime/lock_free.h"
#include "realtime/loop_statistics.h"

namespace trocar::server {

/// A command, and the number of stops that were received before it.
struct OrderedCommand {
  link::ServerCommand command = link::ServerCommand::kStop;
  std::uint64_t stops = 0;
};

/// Switches of the real-time thread that commands have set.
struct ServoSwitches {
  bool is_wanted = false;  ///< Forces are requested.
  bool is_stylet_in = true;
  bool is_reset = false;             ///< A fault reset was requested in this period.
  bool restarts_statistics = false;  ///< Requested in this period.
  std::uint64_t stops = 0;           ///< Stops that have been applied.

  /// Call it at the beginning of each period.
  void begin_period() noexcept { is_reset = restarts_statistics = false; }
  /// Applies the stops, of which `received` have come so far: forces are off until a later kStart. Returns true if one
  /// was new. Real-time safe.
  bool apply_stops(std::uint64_t received) noexcept {
    if (received <= stops) return false;
    stops = received;
    is_wanted = false;
    return true;
  }
  /// Applies a command, after the stops before it. A kStart with a later stop has no effect. Real-time safe. kReconnect
  /// is for the control thread and changes nothing here; kStop is counted, see apply_stops().
  void apply(const OrderedCommand& ordered) noexcept {
    apply_stops(ordered.stops);
    switch (ordered.command) {
      case link::ServerCommand::kStart:
        is_wanted = is_wanted || ordered.stops == stops;
        break;
      case link::ServerCommand::kStop:
        is_wanted = false;
        break;
      case link::ServerCommand::kResetFault:
        is_reset = true;
        break;
      case link::ServerCommand::kStyletOut:
        is_stylet_in = false;
        break;
      case link::ServerCommand::kStyletIn:
        is_stylet_in = true;
        break;
      case link::ServerCommand::kRestartStatistics:
        restarts_statistics = true;
        break;
      case link::ServerCommand::kReconnect:
        break;
    }
  }
};

/// Commands from the link thread to the real-time thread. A stop is a count beside the queue: it is never queued and
/// never refused, and takes effect in the first period that looks. Every queued command carries the number of stops
/// before it, so that a kStart that was queued before a stop has no effect after it. Memory order: see the bodies.
class CommandQueue {
 public:
  static constexpr std::size_t kCapacity = 64;
  static constexpr int kMostAPeriod = 8;

  // Link thread.
  /// Returns false, and does not take the command, if the queue is full. kStop is always taken. `now_ns`: time of
  /// receipt, steady clock.
  bool push(link::ServerCommand command, std::int64_t now_ns) noexcept {
    if (command != link::ServerCommand::kStop) return queue_.push({command, stops_.load(std::memory_order_relaxed)});
    stop(now_ns);
    return true;
  }
  void stop(std::int64_t now_ns) noexcept {
    // Of several stops that no period has seen, the time of the oldest one is kept.
    if (have_stops_taken_effect()) stopped_ns_.store(now_ns, std::memory_order_relaxed);
    // Release: the period that sees this stop sees its time, too. Only the link thread writes, so the counts of the
    // commands pushed after it are not lower.
    stops_.fetch_add(1, std::memory_order_release);
  }
  /// True if the real-time thread has applied every stop so far. Acquire: what it published before is then visible.
  bool have_stops_taken_effect() const noexcept {
    return applied_.load(std::memory_order_acquire) == stops_.load(std::memory_order_relaxed);
  }

  // Real-time thread. Call apply_stops() in every period, also while the device is leased.
  /// Applies the stops received so far. Returns true if there was one since the last call.
  bool apply_stops(ServoSwitches& switches) const noexcept {
    return switches.apply_stops(stops_.load(std::memory_order_acquire));
  }
  /// Applies the next commands, at most kMostAPeriod.
  void apply_commands(ServoSwitches& switches) noexcept {
    OrderedCommand command;
    for (int i = 0; i < kMostAPeriod && queue_.pop(command); ++i) switches.apply(command);
  }
  /// Call it after the switches were published. Release: see have_stops_taken_effect().
  void confirm(const ServoSwitches& switches) noexcept { applied_.store(switches.stops, std::memory_order_release); }
  /// Time of receipt of the oldest stop that apply_stops() has just applied.
  std::int64_t stopped_ns() const noexcept { return stopped_ns_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> stops_{0};    ///< Stops received.
  std::atomic<std::uint64_t> applied_{0};  ///< Stops that the real-time thread has applied.
  std::atomic<std::int64_t> stopped_ns_{0};
  realtime::SpscRing<OrderedCommand> queue_{kCapacity};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

/// Times from the receipt of a stop by the link thread to the tick that sees it. Fixed size, real-time safe.
struct StopStatistics {
  realtime::LatencyHistogram waits;
  /// Largest wait minus the lateness of the tick that saw the stop: at most one period if only the machine delays it.
  std::int64_t longest_on_time_ns = 0;

  /// `late_ns`: how long after the first due time since the last tick this tick began.
  void add(std::int64_t wait_ns, std::int64_t late_ns) noexcept {
    waits.add(wait_ns);
    longest_on_time_ns = std::max(longest_on_time_ns, wait_ns - late_ns);
  }
};

}  // namespace trocar::server
