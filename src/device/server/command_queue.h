#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "realtime/spsc_ring.h"
#include "server/servo_commands.h"

namespace trocar::server {

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

}  // namespace trocar::server
