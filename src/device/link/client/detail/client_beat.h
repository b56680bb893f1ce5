#pragma once

#include <cstdint>

namespace trocar::link::detail {

/// What a client does at a beat of its own time, 100 times per second.
enum class BeatAction : std::uint8_t {
  kNothing,
  kHello,      ///< Introduce itself, then call said_hello().
  kHeartbeat,  ///< Send a heartbeat.
  kReconnect,  ///< The session is lost: connect again, so that nothing old waits in the connection, then reset().
};

/// Rules of a client's beats. Knows neither sockets nor clocks.
class ClientBeat {
 public:
  /// `is_welcomed`: there is a session.
  BeatAction next(bool is_welcomed, double now_s) noexcept {
    if (!is_welcomed) return now_s - hello_s_ >= kHelloAgain_s ? BeatAction::kHello : BeatAction::kNothing;
    return ++silent_beats_ <= kSilentBeats ? BeatAction::kHeartbeat : BeatAction::kReconnect;
  }
  void said_hello(double now_s) noexcept { hello_s_ = now_s; }
  void heard() noexcept { silent_beats_ = 0; }
  /// On a new connection.
  void reset() noexcept { *this = {}; }

 private:
  static constexpr double kHelloAgain_s = 0.2;
  /// Beats without a message until the server counts as gone, 2 s: one that fills memory for a scene may be silent for
  /// some. Beats, not time: a client that was suspended reads waiting messages before it gives up its server.
  static constexpr int kSilentBeats = 200;

  double hello_s_ = 0.0;  ///< When the last Hello was sent; 0: none on this connection.
  int silent_beats_ = 0;  ///< Since the server was last heard.
};

}  // namespace trocar::link::detail
