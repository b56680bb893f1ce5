#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "link/curve_keys.h"
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
  /// A client with a window promises to call frame_drawn(); without that the server takes it as having none.
  bool has_window = false;
};

/// What a client knows of its server. Silence is counted in beats of the client's own thread: where that thread gets
/// no processor nothing can be heard, and the server is not to blame.
struct ClientView {
  bool is_connected = false;  ///< Heard within the last 250 ms.
  double silent_s = 0.0;      ///< Since it was last heard; since the start when never.
  Welcome welcome;
  ServerStatus status;          ///< Empty until this session's first one came.
  double clock_offset_s = 0.0;  ///< Server's clock minus ours, from the fastest round trip of the last seconds.
  double round_trip_s = 0.0;    ///< Of that one.
  std::uint64_t ticks_received = 0;
  std::uint64_t ticks_missing = 0;  ///< Gaps in the numbers: dropped on the way, or by the server.
  std::uint64_t messages_refused = 0;
  std::string refusal;         ///< The newest reason why the server does not talk to us; empty: none in this session.
  std::uint64_t welcomes = 0;  ///< Sessions so far: above 1 the server was lost and found again.
};

/// A tick and its number: rises by one with every tick the server makes, begins at 0 again with a new server.
struct NumberedSample {
  std::uint64_t tick = 0;
  telemetry::TickSample sample;
  std::uint64_t scene = 0;  ///< Number of the scene that made it, see Reply::scene; 0: none.
};

/// The client's side of the link, in a thread of its own that beats at 100 Hz whatever the caller does. Connects by
/// itself, and again when a server comes back: any start order. All members may be called from any one thread; none
/// waits for the server but ask().
class HapticClient {
 public:
  static Result<HapticClient> connect(const ClientOptions& options);
  HapticClient(HapticClient&&) noexcept;
  HapticClient& operator=(HapticClient&&) noexcept;
  ~HapticClient();  ///< Says goodbye.

  ClientView view() const;
  /// All ticks since the last call, in order. At most a minute is kept; older ones are counted as missing.
  std::vector<NumberedSample> take_samples();
  /// The newest tick, if there was one.
  std::optional<telemetry::TickSample> newest() const;

  /// Sends a command and gives its number; its reply comes by take_replies(), in any case: where there is no server, or
  /// it goes away, it says so. A command is never kept for a server that comes later.
  std::uint32_t send(decltype(Command::what) what);
  std::vector<Reply> take_replies();
  /// Sends a command and waits for its reply. Errors: the reply's own, no server, no answer in time.
  Result<std::string> ask(decltype(Command::what) what, std::chrono::milliseconds patience);
  void set_hand(const HandTarget& target);
  /// The window has drawn a picture.
  void frame_drawn();
  /// Waits until the server was heard. Error: not within that time.
  Status wait_connected(std::chrono::milliseconds patience);

 private:
  struct Impl;
  explicit HapticClient(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::link
