#pragma once

#include <cstdint>

#include "link/messages.h"

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

}  // namespace trocar::server
