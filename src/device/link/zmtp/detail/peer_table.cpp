#include "link/zmtp/detail/peer_table.h"

#include <algorithm>

namespace trocar::link::detail {

Peer* PeerTable::greet(std::string_view routing_id, const Hello& hello, std::uint64_t new_session, double now_s) {
  Peer* peer = find(routing_id);
  if (!has_place(peer, hello.wants_control)) {
    forget_lost(now_s, kControlLost_s);
    peer = find(routing_id);
    if (!has_place(peer, hello.wants_control)) return nullptr;
  }
  if (peer == nullptr) {
    peer = &peers_.emplace_back();
    peer->routing_id = routing_id;
    peer->session = new_session;
  } else if (peer->last_received > 0) {
    // The same client reconnects, and keeps control if it had it.
    if (has_control(*peer)) controller_ = new_session;
    peer->session = new_session;
    peer->last_received = 0;
    peer->last_sent = 0;
  }
  peer->heard_s = now_s;
  peer->wants_control = hello.wants_control;
  if (!peer->wants_control && has_control(*peer)) controller_ = 0;
  return peer;
}

/// True if there is a place for `peer`, or for a new client if null.
bool PeerTable::has_place(const Peer* peer, bool wants_control) const {
  const auto others = std::ranges::count_if(
      peers_, [&](const Peer& other) { return &other != peer && other.wants_control == wants_control; });
  return static_cast<std::size_t>(others) < (wants_control ? most_controllers_ : most_watchers_);
}

Peer* PeerTable::find(std::string_view routing_id) {
  const auto found = std::ranges::find(peers_, routing_id, &Peer::routing_id);
  return found == peers_.end() ? nullptr : &*found;
}

Peer* PeerTable::find_session(std::uint64_t session) {
  const auto found = std::ranges::find(peers_, session, &Peer::session);
  return found == peers_.end() ? nullptr : &*found;
}

Verdict PeerTable::judge(Peer& peer, std::uint64_t session, std::uint64_t sequence, double now_s) {
  if (session != peer.session) return Verdict::kUnknownSession;
  if (sequence <= peer.last_received) return Verdict::kReplayed;
  peer.last_received = sequence;
  peer.heard_s = now_s;
  return Verdict::kGood;
}

void PeerTable::offer_control(const Peer& peer, double now_s) {
  if (!peer.wants_control) return;
  const Peer* holder = controller();
  if (holder == nullptr || now_s - holder->heard_s > kControlLost_s) controller_ = peer.session;
}

const Peer* PeerTable::controller() const {
  if (controller_ == 0) return nullptr;
  const auto found = std::ranges::find(peers_, controller_, &Peer::session);
  return found == peers_.end() ? nullptr : &*found;
}

void PeerTable::forget(std::uint64_t session) {
  std::erase_if(peers_, [&](const Peer& peer) { return peer.session == session; });
  if (controller_ == session) controller_ = 0;
}

void PeerTable::forget_lost(double now_s, double longest_s) {
  std::erase_if(peers_, [&](const Peer& peer) { return peer.has_missed_reply || now_s - peer.heard_s > longest_s; });
  if (controller() == nullptr) controller_ = 0;
}

}  // namespace trocar::link::detail
