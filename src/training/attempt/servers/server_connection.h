#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// A client's side of the link to one haptic server, see link/client/haptic_client.h. Plug point: the link, or a
/// simulated server of a test. One thread.
class ServerConnection {
 public:
  virtual ~ServerConnection() = default;  ///< Sends Goodbye.
  virtual link::ClientView view() const = 0;
  /// All ticks since the last call, in order.
  virtual std::vector<link::NumberedSample> take_samples() = 0;
  virtual std::optional<telemetry::TickSample> newest() const = 0;
  /// Returns the number of the command; its reply comes with take_replies(), even if the server disconnects.
  virtual std::uint32_t send(decltype(link::Command::what) what) = 0;
  virtual std::vector<link::Reply> take_replies() = 0;
  /// Sends a command and waits for its reply; the only member that waits.
  virtual Result<std::string> ask(decltype(link::Command::what) what, std::chrono::milliseconds timeout) = 0;
  virtual void set_target(const link::HandTarget& target) = 0;
  virtual void frame_drawn() = 0;
};

}  // namespace trocar::attempt
