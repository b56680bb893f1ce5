#pragma once

#include "link/messages.h"

namespace trocar::server {

/// Switches of the real-time thread that commands have set.
struct ServoSwitches {
  bool is_wanted = false;  ///< Forces are requested.
  bool is_stylet_in = true;
  bool is_reset = false;             ///< A fault reset was requested in this period.
  bool restarts_statistics = false;  ///< Requested in this period.

  /// Call it at the beginning of each period.
  void begin_period() noexcept { is_reset = restarts_statistics = false; }
  /// Applies a command. Real-time safe. kReconnect is for the control thread and changes nothing here.
  void obey(link::ServerCommand command) noexcept {
    switch (command) {
      case link::ServerCommand::kStart:
        is_wanted = true;
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
