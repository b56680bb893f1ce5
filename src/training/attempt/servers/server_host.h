#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "link/client/haptic_client.h"
#include "link/messages.h"

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

/// Process of a haptic server. Plug point: a process that this program started (LocalServer), a server that was
/// already running (RemoteServer), or a simulated server of a test.
class ServerHost {
 public:
  virtual ~ServerHost() = default;
  virtual const std::string& tool() const noexcept = 0;    ///< "needle", "probe"; empty: unknown before it replies.
  virtual const std::string& device() const noexcept = 0;  ///< In the form of trocar-hapticd --device; empty: unknown.
  virtual const std::string& endpoint() const noexcept = 0;
  virtual int pid() const = 0;    ///< 0: not a process of this program.
  virtual Status check() = 0;     ///< Error: the process has ended. Never for a remote server.
  virtual bool is_held_up() = 0;  ///< See link::ServerProcess. Always false for a remote server.
  virtual Status restart() = 0;   ///< Error for a remote server.
  /// Replaces `options.endpoint` and `options.security` by those of this server.
  virtual Result<std::unique_ptr<ServerConnection>> connect(link::ClientOptions options) = 0;
};

/// Method by which a device is moved to the start pose of an attempt.
enum class DeviceControl : std::uint8_t {
  kTargets,      ///< Follows hand targets: "virtual…", "mouse".
  kPlaced,       ///< Moves itself and can be put to a pose: "gamepad", "spacemouse".
  kPersonsHand,  ///< A person holds it: it begins where it is, and gets no forces again without a person's consent.
};
/// Control of a device; `device_spec` in the form of trocar-hapticd --device.
DeviceControl device_control(const std::string& device_spec);
/// True if hand targets move it.
bool follows_targets(const std::string& device_spec);
/// Display name for messages: "gamepad", "SpaceMouse", "Left Device (OpenHaptics)".
std::string device_words(const std::string& device_spec);

/// Parameters that a server's scene has in addition to its LoadScene: all messages since the scene was loaded, merged
/// as the server merges them (see link::SetParameters). They are sent again whenever the scene is loaded again.
class ParameterMemory {
 public:
  /// Numbers of tissues replace those of the last message that had any, each option replaces the one before, and a
  /// table replaces the loaded one.
  void apply(const link::SetParameters& message);
  /// All of them in one message; empty: the scene as it was loaded.
  const link::SetParameters& message() const noexcept { return all_; }

 private:
  link::SetParameters all_;
};

}  // namespace trocar::attempt
