#include "link/server_socket.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <string_view>
#include <utility>

#include "link/codec.h"
#include "link/zmtp/detail/curve_handshake.h"
#include "link/zmtp/detail/peer_table.h"
#include "link/zmtp/detail/server_connections.h"
#include "realtime/periodic_loop.h"

namespace trocar::link {
namespace {

using detail::Peer;
using detail::ServerConnections;
using detail::Verdict;
using Event = detail::ZmtpConnection::Event;

/// A client is removed after this time without a message [assumed: far longer than a suspended client needs].
constexpr double kForgotten_s = 10.0;
/// Limit of invalid messages that one receive() drops before it returns [assumed].
constexpr int kMostDroppedAtOnce = 64;

/// Unpredictable, and never 0.
std::uint64_t make_session() {
  std::uint64_t session = 0;
  while (session == 0) {
    if (::getrandom(&session, sizeof session, 0) != sizeof session) session = 0;
  }
  return session;
}

}  // namespace

struct ServerSocket::Impl {
  explicit Impl(ServerConnections listening) : connections(std::move(listening)) {
    connections.set_known([this](std::string_view routing_id) { return peers.find(routing_id) != nullptr; });
  }

  ServerConnections connections;
  detail::PeerTable peers{kMostControllers, kMostWatchers};
  RefusedMessages refused;
  std::uint64_t batches_not_taken = 0;

  std::optional<Received> take(const ServerConnections::Incoming& incoming, const Welcome& welcome, double now_s);
  void explain(const ServerConnections::Incoming& incoming, const Error& error, double now_s);
  void refuse(std::string_view routing_id, std::string text, double now_s);
  void greet(Peer& peer, const Welcome& welcome);
  bool is_permitted(Peer& peer, const ClientBody& body);
  bool send(Peer& peer, ServerMessage& message, std::size_t most_waiting = kMostBytesOut);
  void send_reply(Peer& peer, Reply reply);
};

Result<ServerSocket> ServerSocket::bind(const Endpoint& endpoint, std::optional<ServerSecurity> security) {
  if (endpoint.needs_keys && !security) {
    return fail_usage("tcp:// needs keys: every user of this machine can connect to it", endpoint.url,
                      "make them with `trocar link keygen`, or use ipc://");
  }
  std::optional<detail::CurveIdentity> identity;
  if (security) {
    TROCAR_TRY(identity, detail::CurveIdentity::make(security->keys, security->allowed));
  }
  TROCAR_TRY(ServerConnections connections, ServerConnections::listen(endpoint, std::move(identity)));
  return ServerSocket(std::make_unique<Impl>(std::move(connections)));
}

ServerSocket::ServerSocket(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ServerSocket::ServerSocket(ServerSocket&&) noexcept = default;
ServerSocket& ServerSocket::operator=(ServerSocket&&) noexcept = default;
ServerSocket::~ServerSocket() = default;

std::optional<Received> ServerSocket::receive(int wait_ms, const Welcome& welcome, double now_s) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const std::int64_t begin_ns = realtime::now_ns();
  for (int dropped = 0; dropped < kMostDroppedAtOnce;) {
    // now_s is the time before the wait.
    const double heard_s = now_s + realtime::seconds(realtime::now_ns() - begin_ns);
    const auto incoming = impl_->connections.next(heard_s);
    if (!incoming) {
      const std::int64_t left_ms = wait_ms - (realtime::now_ns() - begin_ns) / kNsPerMs;
      if (left_ms <= 0 || !impl_->connections.wait(static_cast<int>(left_ms), heard_s)) return {};
      continue;
    }
    if (auto received = impl_->take(*incoming, welcome, heard_s)) return received;
    ++dropped;
  }
  return {};
}

std::optional<Received> ServerSocket::Impl::take(const ServerConnections::Incoming& incoming, const Welcome& welcome,
                                                 double now_s) {
  const bool is_large = incoming.event == Event::kTooLarge || incoming.message.size() > kMostMessageBytes;
  if (incoming.event != Event::kMessage || is_large) {
    ++(is_large ? refused.oversized : refused.malformed);
    refuse(incoming.routing_id,
           is_large ? fmt::format("a message of more than {} bytes", kMostMessageBytes)
                    : std::string("a message of several frames: send one frame"),
           now_s);
    return {};
  }
  auto message = decode_client_message(incoming.message);
  if (!message) {
    ++refused.malformed;
    explain(incoming, message.error(), now_s);
    return {};
  }
  const Hello* hello = std::get_if<Hello>(&message->body);
  Peer* peer = hello != nullptr ? peers.greet(incoming.routing_id, *hello, make_session(), now_s)
                                : peers.find(incoming.routing_id);
  if (hello != nullptr) connections.refresh(now_s);
  const Verdict verdict = peer == nullptr    ? Verdict::kUnknownSession
                          : hello != nullptr ? Verdict::kGood
                                             : peers.judge(*peer, message->session, message->sequence, now_s);
  if (verdict != Verdict::kGood) {
    ++(verdict == Verdict::kReplayed ? refused.replayed : refused.unknown_session);
    if (peer == nullptr) {
      refuse(incoming.routing_id, hello == nullptr ? "no session: send Hello first" : "the server has too many clients",
             now_s);
    }
    return {};
  }
  const bool is_leaving = std::holds_alternative<Goodbye>(message->body);
  if (!is_leaving) peers.offer_control(*peer, now_s);
  Received received{peer->session, peers.has_control(*peer), std::move(message->body)};
  if (is_leaving) {
    received.has_control = false;
    peers.forget(received.session);
    connections.refresh(now_s);
    return received;
  }
  if (hello != nullptr || received.has_control != peer->was_told_control) greet(*peer, welcome);
  if (!is_permitted(*peer, received.body)) return {};
  if (const auto* beat = std::get_if<Heartbeat>(&received.body)) {
    ServerMessage pong{0, 0, Pong{beat->client_time_s, now_s}};
    send(*peer, pong);
  }
  return received;
}

/// Handles a message that cannot be decoded: a command of a known client gets a reply, everything else a refusal.
void ServerSocket::Impl::explain(const ServerConnections::Incoming& incoming, const Error& error, double now_s) {
  connections.report(fmt::format("a message was refused: {}", error.text()));
  Peer* peer = peers.find(incoming.routing_id);
  const auto command = peer == nullptr ? std::nullopt : find_command(incoming.message);
  if (!command || peers.judge(*peer, command->session, command->sequence, now_s) != Verdict::kGood) {
    refuse(incoming.routing_id, error.text(), now_s);
    return;
  }
  send_reply(*peer, {command->request, false, error.text()});
}

void ServerSocket::Impl::refuse(std::string_view routing_id, std::string text, double now_s) {
  if (!connections.may_refuse(routing_id, now_s)) return;
  ServerMessage message{0, 0, Refusal{std::move(text)}};
  if (Peer* peer = peers.find(routing_id)) {
    send(*peer, message);
  } else {
    connections.send(routing_id, encode(message));
  }
}

/// Sends a client its session, and whether it has control.
void ServerSocket::Impl::greet(Peer& peer, const Welcome& welcome) {
  Welcome mine = welcome;
  mine.session = peer.session;
  mine.has_control = peers.has_control(peer);
  ServerMessage message{0, 0, std::move(mine)};
  if (send(peer, message)) peer.was_told_control = peers.has_control(peer);
}

/// Clients without control may not move anything; everyone may stop the forces.
bool ServerSocket::Impl::is_permitted(Peer& peer, const ClientBody& body) {
  const auto* command = std::get_if<Command>(&body);
  if (command == nullptr && !std::holds_alternative<HandTarget>(body)) return true;
  if (peers.has_control(peer) || (command != nullptr && is_stop(*command))) return true;
  ++refused.not_in_control;
  if (command != nullptr) send_reply(peer, {command->request, false, "another client controls this server"});
  return false;
}

/// Sends the message with the client's session and next number. Returns false if the client is gone or accepts no more
/// messages.
bool ServerSocket::Impl::send(Peer& peer, ServerMessage& message, std::size_t most_waiting) {
  message.session = peer.session;
  message.sequence = peer.last_sent + 1;
  if (!connections.send(peer.routing_id, encode(message), most_waiting)) return false;
  ++peer.last_sent;
  return true;
}

/// Every command has one reply. A client that reads so slowly that it cannot be queued loses its session instead.
void ServerSocket::Impl::send_reply(Peer& peer, Reply reply) {
  ServerMessage message{0, 0, std::move(reply)};
  if (!send(peer, message, kMostBytesOut + kMostReplyBytesOut)) peer.has_missed_reply = true;
}

void ServerSocket::send_batch(StateBatch batch) {
  if (impl_->peers.all().empty()) return;
  ServerMessage message{0, 0, std::move(batch)};
  for (Peer& peer : impl_->peers.all()) {
    if (!impl_->send(peer, message)) ++impl_->batches_not_taken;
  }
}

void ServerSocket::send_reply(std::uint64_t session, const Reply& reply) {
  if (Peer* peer = impl_->peers.find_session(session)) impl_->send_reply(*peer, reply);
}

void ServerSocket::drop_lost(double now_s) {
  impl_->peers.forget_lost(now_s, kForgotten_s);
  impl_->connections.drop_unauthenticated(now_s);
}

std::optional<double> ServerSocket::controller_heard_s() const {
  const Peer* controller = impl_->peers.controller();
  return controller == nullptr ? std::optional<double>() : controller->heard_s;
}

std::uint64_t ServerSocket::controller() const {
  const Peer* controller = impl_->peers.controller();
  return controller == nullptr ? 0 : controller->session;
}

std::shared_ptr<LogLimit> ServerSocket::log_limit() const {
  return impl_->connections.log_limit();
}

std::string ServerSocket::bound_url() const {
  return impl_->connections.url();
}

RefusedMessages ServerSocket::refused() const {
  RefusedMessages refused = impl_->refused;
  refused.connections = impl_->connections.refused();
  return refused;
}

std::uint64_t ServerSocket::batches_not_taken() const {
  return impl_->batches_not_taken;
}

std::size_t ServerSocket::connections() const {
  return impl_->connections.count();
}

}  // namespace trocar::link
