#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "link/messages.h"

namespace trocar::link::detail {

/// What a server knows of one client.
struct Peer {
  std::string routing_id;  ///< The socket's own name for the connection.
  std::uint64_t session = 0;
  std::uint64_t last_received = 0;  ///< Sequence numbers; a session's first message has 1.
  std::uint64_t last_sent = 0;
  double heard_s = 0.0;
  bool wants_control = false;
  bool was_told_control = false;  ///< What its last Welcome said.
  bool has_missed_reply = false;  ///< It reads too slowly; forget_lost() removes it.
};

enum class Verdict { kGood, kUnknownSession, kReplayed };

/// The clients of a server: who they are, whose message is good, who has control. Knows neither sockets nor clocks.
/// Pointers to a peer hold until the next greet() or forget.
class PeerTable {
 public:
  PeerTable(std::size_t most_controllers, std::size_t most_watchers)
      : most_controllers_(most_controllers), most_watchers_(most_watchers) {}

  /// A Hello came. The peer has `new_session`, and keeps the one it has where the Hello is only a repetition: none of
  /// its messages has come yet. Nothing when there are too many peers of its kind (those that want control, those that
  /// watch) and none of them is silent: watchers never take a controller's place.
  Peer* greet(std::string_view routing_id, const Hello& hello, std::uint64_t new_session, double now_s);
  Peer* find(std::string_view routing_id);
  Peer* find_session(std::uint64_t session);
  /// Judges any other message; a good one counts as a sign of life.
  static Verdict judge(Peer& peer, std::uint64_t session, std::uint64_t sequence, double now_s);
  /// Gives `peer` control when it wants it and nobody has it, or who has it was silent for kControlLost_s.
  void offer_control(const Peer& peer, double now_s);
  bool has_control(const Peer& peer) const { return peer.session == controller_; }
  const Peer* controller() const;
  void forget(std::uint64_t session);
  /// Removes the peers that were silent for longer than `longest_s`, and those that missed a reply.
  void forget_lost(double now_s, double longest_s);
  std::vector<Peer>& all() { return peers_; }

 private:
  bool has_place(const Peer* peer, bool wants_control) const;

  std::size_t most_controllers_, most_watchers_;
  std::vector<Peer> peers_;
  std::uint64_t controller_ = 0;  ///< Session; 0: nobody.
};

}  // namespace trocar::link::detail
