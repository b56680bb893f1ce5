#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "link/client/detail/client_mailbox.h"
#include "link/client/detail/client_session.h"
#include "link/client/haptic_client.h"
#include "link/messages.h"
#include "link/server_socket.h"
#include "link/zmtp/detail/peer_table.h"

/// Both ends of a link in one thread and in simulated time: messages are passed as structs, without sockets. Sessions,
/// control, heartbeats and timeouts use the code of the real ends (PeerTable; ClientSession, ClientMailbox,
/// ClientBeat).
namespace trocar::testing {

class InProcessClient;

/// The server's end, see link/server_socket.h.
class InProcessServerEnd {
 public:
  InProcessServerEnd() = default;
  InProcessServerEnd(const InProcessServerEnd&) = delete;
  InProcessServerEnd& operator=(const InProcessServerEnd&) = delete;

  std::optional<link::Received> receive(const link::Welcome& welcome, double now_s);
  void send_batch(const link::StateBatch& batch);
  void send_reply(std::uint64_t session, const link::Reply& reply);
  void drop_lost(double now_s) {
    constexpr double kForgotten_s = 10.0;
    peers_.forget_lost(now_s, kForgotten_s);
  }
  std::optional<double> controller_heard_s() const {
    const link::detail::Peer* controller = peers_.controller();
    return controller == nullptr ? std::optional<double>() : controller->heard_s;
  }
  std::uint64_t controller() const {
    const link::detail::Peer* controller = peers_.controller();
    return controller == nullptr ? 0 : controller->session;
  }
  /// Simulates the end of the server process: messages are not accepted.
  void close() {
    is_open_ = false;
    waiting_.clear();
    peers_ = make_peers();
  }
  void open() { is_open_ = true; }

 private:
  friend class InProcessClient;
  static link::detail::PeerTable make_peers() { return {link::kMostControllers, link::kMostWatchers}; }
  std::string attach(InProcessClient& client) {
    const std::string id = std::to_string(++attached_);
    clients_[id] = &client;
    return id;
  }
  void detach(const std::string& id) { clients_.erase(id); }
  /// Returns false if the message was not accepted.
  bool post(const std::string& id, link::ClientMessage message) {
    constexpr std::size_t kMostWaiting = 200;  // like the socket of a client
    if (!is_open_ || waiting_.size() >= kMostWaiting) return false;
    waiting_.emplace_back(id, std::move(message));
    return true;
  }
  std::optional<link::Received> take(const std::string& id, link::ClientMessage message, const link::Welcome& welcome,
                                     double now_s);
  void send(link::detail::Peer& peer, link::ServerBody body);
  void refuse(const std::string& id, std::string text);

  bool is_open_ = true;
  int attached_ = 0;
  std::uint64_t last_session_ = 0;
  std::map<std::string, InProcessClient*> clients_;
  std::deque<std::pair<std::string, link::ClientMessage>> waiting_;
  link::detail::PeerTable peers_ = make_peers();
};

/// The client's end, see link/client/haptic_client.h. The server's end must outlive it.
class InProcessClient {
 public:
  InProcessClient(InProcessServerEnd& server, link::ClientOptions options)
      : server_(server), options_(std::move(options)), id_(server.attach(*this)) {}
  ~InProcessClient() {
    if (session_.is_welcomed()) server_.post(id_, session_.message(link::Goodbye{}));
    server_.detach(id_);
  }
  InProcessClient(const InProcessClient&) = delete;
  InProcessClient& operator=(const InProcessClient&) = delete;

  link::ClientView view() const { return mailbox_.view(); }
  std::vector<link::NumberedSample> take_samples() { return mailbox_.take_samples(); }
  std::optional<telemetry::TickSample> newest() const { return mailbox_.newest(); }
  std::uint32_t send(decltype(link::Command::what) what) {
    mailbox_.post(link::Command{++last_request_, std::move(what)});
    return last_request_;
  }
  std::vector<link::Reply> take_replies() { return mailbox_.take_replies(); }
  void set_hand(const link::HandTarget& target) { mailbox_.post(target); }
  void frame_drawn() { has_drawn_ = true; }

  /// Runs the work of the client thread until `now_s`. Call it every ms; a late call simulates a suspended client.
  void step(double now_s) {
    while (!inbox_.empty()) {
      link::ServerMessage message = std::move(inbox_.front());
      inbox_.pop_front();
      if (session_.take(std::move(message), now_s)) beat_.heard();
    }
    if (std::exchange(has_drawn_, false)) drawn_s_ = now_s;
    send_outgoing();
    constexpr double kBeat_s = 1e-9 * static_cast<double>(link::detail::kBeat_ns);
    if (now_s < next_beat_s_) return;
    next_beat_s_ = now_s + kBeat_s;
    beat(now_s);
  }

 private:
  friend class InProcessServerEnd;
  void receive(link::ServerMessage message) {
    constexpr std::size_t kMostWaiting = 1000;  // like the socket of a client
    if (inbox_.size() < kMostWaiting) inbox_.push_back(std::move(message));
  }
  void send_outgoing() {
    link::detail::Outgoing outgoing = mailbox_.take_outgoing();
    for (link::Command& command : outgoing.commands) {
      const std::uint32_t request = command.request;
      if (!session_.is_welcomed()) {
        mailbox_.put_reply({request, false, "there is no server"});
      } else if (!server_.post(id_, session_.message(std::move(command)))) {
        mailbox_.put_reply({request, false, "the server takes no messages"});
      } else {
        session_.expect_reply(request);
      }
    }
    if (outgoing.hand && session_.is_welcomed()) server_.post(id_, session_.message(*outgoing.hand));
  }
  void beat(double now_s) {
    using link::detail::BeatAction;
    mailbox_.put_beat();
    const BeatAction action = beat_.next(session_.is_welcomed(), now_s);
    if (action == BeatAction::kHello) {
      const bool is_sent = server_.post(id_, {0, 0, link::Hello{options_.name, options_.wants_control}});
      if (is_sent) beat_.said_hello(now_s);
    }
    if (action == BeatAction::kHeartbeat) {
      const double age_s = options_.has_window ? std::max(0.0, now_s - drawn_s_) : 0.0;
      server_.post(id_, session_.message(link::Heartbeat{now_s, age_s, session_.ticks_received()}));
    }
    if (action != BeatAction::kReconnect) return;
    session_.lose();
    inbox_.clear();
    beat_.reset();
  }

  InProcessServerEnd& server_;
  link::ClientOptions options_;
  std::string id_;
  std::deque<link::ServerMessage> inbox_;
  link::detail::ClientMailbox mailbox_;
  link::detail::ClientSession session_{mailbox_};
  link::detail::ClientBeat beat_;
  std::uint32_t last_request_ = 0;
  double next_beat_s_ = 0.0, drawn_s_ = 0.0;
  bool has_drawn_ = false;
};

inline std::optional<link::Received> InProcessServerEnd::receive(const link::Welcome& welcome, double now_s) {
  while (!waiting_.empty()) {
    auto [id, message] = std::move(waiting_.front());
    waiting_.pop_front();
    if (auto received = take(id, std::move(message), welcome, now_s)) return received;
  }
  return {};
}

inline std::optional<link::Received> InProcessServerEnd::take(const std::string& id, link::ClientMessage message,
                                                              const link::Welcome& welcome, double now_s) {
  using link::detail::Peer;
  const auto* hello = std::get_if<link::Hello>(&message.body);
  Peer* const peer = hello != nullptr ? peers_.greet(id, *hello, ++last_session_, now_s) : peers_.find(id);
  if (peer == nullptr) {
    refuse(id, "no session: send Hello first");
    return {};
  }
  using link::detail::PeerTable;
  const bool is_valid = hello != nullptr || PeerTable::judge(*peer, message.session, message.sequence, now_s) ==
                                                link::detail::Verdict::kGood;
  if (!is_valid) return {};
  const bool is_leaving = std::holds_alternative<link::Goodbye>(message.body);
  if (!is_leaving) peers_.offer_control(*peer, now_s);
  link::Received received{peer->session, peers_.has_control(*peer), std::move(message.body)};
  if (is_leaving) {
    received.has_control = false;
    peers_.forget(received.session);
    return received;
  }
  if (hello != nullptr || received.has_control != peer->was_told_control) {
    link::Welcome mine = welcome;
    mine.session = peer->session;
    mine.has_control = peer->was_told_control = received.has_control;
    send(*peer, std::move(mine));
  }
  const auto* command = std::get_if<link::Command>(&received.body);
  const bool is_moving = command != nullptr || std::holds_alternative<link::HandTarget>(received.body);
  if (is_moving && !received.has_control && !(command != nullptr && link::is_stop(*command))) {
    if (command != nullptr) send(*peer, link::Reply{command->request, false, "another client controls this server"});
    return {};
  }
  if (const auto* beat = std::get_if<link::Heartbeat>(&received.body))
    send(*peer, link::Pong{beat->client_time_s, now_s});
  return received;
}

inline void InProcessServerEnd::send(link::detail::Peer& peer, link::ServerBody body) {
  const auto client = clients_.find(peer.routing_id);
  if (client == clients_.end()) return;
  client->second->receive({peer.session, ++peer.last_sent, std::move(body)});
}

inline void InProcessServerEnd::refuse(const std::string& id, std::string text) {
  const auto client = clients_.find(id);
  if (client != clients_.end()) client->second->receive({0, 0, link::Refusal{std::move(text)}});
}

inline void InProcessServerEnd::send_batch(const link::StateBatch& batch) {
  for (link::detail::Peer& peer : peers_.all()) send(peer, batch);
}

inline void InProcessServerEnd::send_reply(std::uint64_t session, const link::Reply& reply) {
  if (link::detail::Peer* peer = peers_.find_session(session)) send(*peer, reply);
}

}  // namespace trocar::testing
