#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "link/messages.h"

namespace trocar::link::detail {

/// Data of a server about one client.
struct Peer {
  std::string routing_id;  ///< Name of the connection in the socket.
  std::uint64_t session = 0;
  std::uint64_t last_received = 0;  ///< Sequence numbers; a session's first message has 1.
  std::uint64_t last_sent = 0;
  double heard_s = 0.0;
  bool wants_control = false;
  bool was_told_control = false;  ///< has_control of the last Welcome.
  bool has_missed_reply = false;  ///< The peer reads too slowly; forget_lost() removes it.
};

enum class Verdict { kGood, kUnknownSession, kReplayed };

/// The clients of a server: their sessions, the checks of their messages, and the client in control. Uses neither
/// sockets nor clocks. Pointers to a peer are valid until the next greet(), forget() or forget_lost().
class PeerTable {
 public:
  PeerTable(std::size_t most_controllers, std::size_t most_watchers)
      : most_controllers_(most_controllers), most_watchers_(most_watchers) {}

  /// Handles a Hello. The peer gets `new_session`; it keeps its session if the Hello is only a repetition, that is, if
  /// no other message of it has come yet. Returns null if there are too many peers of its kind (request control, or
  /// watch) and none of them has timed out. Watchers never take the place of a controller.
  Peer* greet(std::string_view routing_id, const Hello& hello, std::uint64_t new_session, double now_s);
  Peer* find(std::string_view routing_id);
  Peer* find_session(std::uint64_t session);
  /// Checks any other message; a valid one resets the timeout of the peer.
  static Verdict judge(Peer& peer, std::uint64_t session, std::uint64_t sequence, double now_s);
  /// Gives control to `peer` if it requests control and no peer has it, or the peer in control has sent nothing for
  /// kControlLost_s.
  void offer_control(const Peer& peer, double now_s);
  bool has_control(const Peer& peer) const { return peer.session == controller_; }
  const Peer* controller() const;
  void forget(std::uint64_t session);
  /// Removes the peers that have sent nothing for longer than `longest_s`, and those that missed a reply.
  void forget_lost(double now_s, double longest_s);
  std::vector<Peer>& all() { return peers_; }

 private:
  bool has_place(const Peer* peer, bool wants_control) const;

  std::size_t most_controllers_, most_watchers_;
  std::vector<Peer> peers_;
  std::uint64_t controller_ = 0;  ///< Session of the peer in control; 0: none.
};

/// A rate limit: `burst` at once, `per_s` on average. Time is an argument.
class TokenBucket {
 public:
  TokenBucket(double per_s, double burst) noexcept : per_s_(per_s), burst_(burst), tokens_(burst) {}

  void refill(double now_s) noexcept {
    if (has_time_) tokens_ = std::min(burst_, tokens_ + per_s_ * std::max(0.0, now_s - filled_s_));
    filled_s_ = now_s;
    has_time_ = true;
  }
  bool has_tokens() const noexcept { return tokens_ >= 1.0; }
  /// May take more tokens than there are; has_tokens() is then false until the deficit is refilled.
  void take(double amount) noexcept { tokens_ -= amount; }

 private:
  double per_s_, burst_, tokens_;
  double filled_s_ = 0.0;
  bool has_time_ = false;
};

}  // namespace trocar::link::detail
