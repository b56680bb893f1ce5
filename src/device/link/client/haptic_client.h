#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "link/endpoint.h"
#include "link/messages.h"

namespace trocar::link {

struct ClientSecurity {
  CurveKeys keys;
  std::string server_key;  ///< The server's public key.
};

struct ClientOptions {
  std::string endpoint;
  std::string name = "trocar";
  bool wants_control = true;
  std::optional<ClientSecurity> security;
  /// true: the client has a window and must call frame_drawn(); false: the server assumes that it has none.
  bool has_window = false;
};

/// A client's view of its server. Timeouts are counted in heartbeats of the client thread: if that thread is not
/// scheduled, the server does not time out.
struct ClientView {
  bool is_connected = false;  ///< A message arrived within the last 250 ms.
  double silent_s = 0.0;      ///< Time since the last message; since the start if none arrived.
  Welcome welcome;
  ServerStatus status;          ///< Empty until the first status of this session came.
  double clock_offset_s = 0.0;  ///< Server's clock minus own clock, from the fastest round trip of the last seconds.
  double round_trip_s = 0.0;    ///< Time of that round trip.
  std::uint64_t ticks_received = 0;
  std::uint64_t ticks_missing = 0;  ///< Gaps in the tick numbers: ticks dropped in transit or by the server.
  std::uint64_t messages_refused = 0;
  std::string refusal;         ///< The newest reason for a refusal by the server; empty: none in this session.
  std::uint64_t welcomes = 0;  ///< Sessions so far; above 1: the client has reconnected.
};

/// A tick and its number, which increases by one with every tick of the server and starts at 0 with a new server.
struct NumberedSample {
  std::uint64_t tick = 0;
  telemetry::TickSample sample;
  std::uint64_t scene = 0;  ///< Number of the scene of this tick, see Reply::scene; 0: none.
  /// Shape of the needle at this tick, if it was sent (every 10 ms).
  std::shared_ptr<const telemetry::NeedleShape> shape = {};
};

/// The client's side of the link, in a thread that sends heartbeats at 100 Hz independent of the caller. Connects and
/// reconnects automatically, in any start order. Any one thread may call the members; only ask() waits for the server.
class HapticClient {
 public:
  static Result<HapticClient> connect(const ClientOptions& options);
  HapticClient(HapticClient&&) noexcept;
  HapticClient& operator=(HapticClient&&) noexcept;
  ~HapticClient();  ///< Sends Goodbye.

  ClientView view() const;
  /// All ticks since the last call, in order. At most a minute is kept; older ones are counted as missing.
  std::vector<NumberedSample> take_samples();
  /// The newest tick, if there was one.
  std::optional<telemetry::TickSample> newest() const;

  /// Sends a command and returns its number; take_replies() always returns a reply, also if there is no server or it
  /// disconnects. Commands are not queued for a later server.
  std::uint32_t send(decltype(Command::what) what);
  std::vector<Reply> take_replies();
  /// Sends a command and waits for its reply. Errors: the reply's own, no server, no answer in time.
  Result<std::string> ask(decltype(Command::what) what, std::chrono::milliseconds timeout);
  void set_hand(const HandTarget& target);
  /// Call after the window drew a frame.
  void frame_drawn();
  /// Waits for the first message of the server. Error: timeout.
  Status wait_connected(std::chrono::milliseconds timeout);

 private:
  struct Impl;
  explicit HapticClient(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::link
