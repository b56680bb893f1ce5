#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "link/client/detail/client_mailbox.h"
#include "link/messages.h"

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

/// Offset between two clocks, measured with round trips. The fastest round trip of the last seconds is used, because
/// its two directions can differ least (like NTP's clock filter, RFC 5905).
class ClockOffset {
 public:
  struct Estimate {
    double offset_s = 0.0;      ///< Remote clock minus own clock; the error is at most half the round trip.
    double round_trip_s = 0.0;  ///< Never negative.
  };
  /// Adds a round trip: request sent at `sent_s`, answer with `their_s` received at `received_s` (sent and received:
  /// own clock). Returns false, and does not add it, if the answer came before the request.
  bool add(double sent_s, double their_s, double received_s);
  std::optional<Estimate> best() const;
  void clear() { pings_.clear(); }

 private:
  struct Ping {
    double received_s;
    Estimate estimate;
  };
  std::deque<Ping> pings_;  ///< A faster round trip removes the slower ones before it: the first is the best.
};

/// State of a client's session with its server. Uses neither sockets nor clocks. Results for the caller go to the
/// mailbox.
class ClientSession {
 public:
  explicit ClientSession(ClientMailbox& mailbox) : mailbox_(mailbox) {}

  bool is_welcomed() const { return session_ != 0; }
  std::uint64_t ticks_received() const { return ticks_received_; }
  /// Handles a message of the server. Returns false if the message was refused: it is not of this session, old, or a
  /// refusal without a session.
  bool take(ServerMessage message, double now_s);
  /// Counts a received message that is invalid.
  void refuse();
  /// Makes the next message of this session, with this body.
  ClientMessage message(ClientBody body);
  /// Call it after a command was sent. The command gets a reply from the server, or one from lose().
  void expect_reply(std::uint32_t request) { waiting_.push_back(request); }
  /// Ends the session: commands without a reply get an error reply.
  void lose();

 private:
  bool take_body(const Welcome& welcome, double now_s);
  bool take_body(StateBatch& batch, double now_s);
  bool take_body(Reply& reply, double now_s);
  bool take_body(const Pong& pong, double now_s);
  bool take_body(const Refusal& refusal, double now_s);

  ClientMailbox& mailbox_;
  std::uint64_t session_ = 0;
  std::uint64_t last_sent_ = 0, last_received_ = 0;
  std::uint64_t next_tick_ = 0;
  bool knows_next_tick_ = false;
  std::uint64_t ticks_received_ = 0;
  std::uint64_t refused_ = 0;
  ClockOffset clock_;
  std::vector<std::uint32_t> waiting_;  ///< Commands without reply.
};

}  // namespace trocar::link::detail
