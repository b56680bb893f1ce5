#pragma once

#include <cstdint>

namespace trocar::link::detail {

/// Action of a client at a heartbeat of its own clock, 100 times per second.
enum class BeatAction : std::uint8_t {
  kNothing,
  kHello,      ///< Send Hello, then call said_hello().
  kHeartbeat,  ///< Send a heartbeat.
  kReconnect,  ///< The session is lost: reconnect, so that no old message is in the connection, then call reset().
};

/// Selects the action at each heartbeat of a client. Uses neither sockets nor clocks.
class ClientBeat {
 public:
  /// `is_welcomed`: the client has a session.
  BeatAction next(bool is_welcomed, double now_s) noexcept {
    if (!is_welcomed) return now_s - hello_s_ >= kHelloAgain_s ? BeatAction::kHello : BeatAction::kNothing;
    return ++silent_beats_ <= kSilentBeats ? BeatAction::kHeartbeat : BeatAction::kReconnect;
  }
  void said_hello(double now_s) noexcept { hello_s_ = now_s; }
  void heard() noexcept { silent_beats_ = 0; }
  /// Call it for a new connection.
  void reset() noexcept { *this = {}; }

 private:
  static constexpr double kHelloAgain_s = 0.2;
  /// Timeout of the server, counted in heartbeats of the client: 2 s, because a server that allocates memory for a
  /// scene may be silent for some of them. Heartbeats instead of time: after a suspension, the client reads queued
  /// messages before the timeout.
  static constexpr int kSilentBeats = 200;

  double hello_s_ = 0.0;  ///< Time of the last Hello; 0: none on this connection.
  int silent_beats_ = 0;  ///< Heartbeats since the last message of the server.
};

}  // namespace trocar::link::detail
