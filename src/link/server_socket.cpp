#include "link/server_socket.h"

#include <sys/random.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <utility>

#include "link/codec.h"
#include "link/detail/allowed_clients.h"
#include "link/detail/ipc_file.h"
#include "link/detail/peer_table.h"
#include "link/detail/zmq_handles.h"
#include "realtime/periodic_loop.h"

namespace trocar {
namespace {

using detail::Peer;
using detail::Verdict;
using detail::ZmqFrame;
using detail::ZmqSocket;

constexpr std::string_view kIpc = "ipc://";
/// Messages that wait for one peer, each way [assumed: two seconds of batches at 100 Hz].
constexpr int kMostWaiting = 200;
/// The library closes a connection that announces more, unread and uncounted; what is between this and
/// kMostMessageBytes is read, counted and dropped.
constexpr std::int64_t kCutOffBytes = 2 * static_cast<std::int64_t>(kMostMessageBytes);
/// A connection that does not finish its greeting is closed [assumed].
constexpr int kHandshake_ms = 2000;
/// A peer is forgotten when it was silent for so long [assumed: far above what a suspended client needs].
constexpr double kForgotten_s = 10.0;
/// Bad messages that one receive() drops before it gives its caller the turn [assumed].
constexpr int kMostDroppedAtOnce = 64;

/// Not to be guessed, and never 0.
std::uint64_t make_session() {
  std::uint64_t session = 0;
  while (session == 0) {
    if (::getrandom(&session, sizeof session, 0) != sizeof session) session = 0;
  }
  return session;
}

/// The library binds to numbers and network interfaces, not to names.
std::string bindable(std::string url) {
  constexpr std::string_view kName = "tcp://localhost:";
  return url.starts_with(kName) ? "tcp://127.0.0.1:" + url.substr(kName.size()) : url;
}

bool set_up(ZmqSocket& socket, const std::string& url) {
  return socket.is_open() && socket.set(ZMQ_LINGER, 0) && socket.set(ZMQ_ROUTER_MANDATORY, 1) &&
         // A client that comes back by a new connection keeps its routing id; the old connection is dead.
         socket.set(ZMQ_ROUTER_HANDOVER, 1) && socket.set(ZMQ_SNDHWM, kMostWaiting) &&
         socket.set(ZMQ_RCVHWM, kMostWaiting) && socket.set_long(ZMQ_MAXMSGSIZE, kCutOffBytes) &&
         socket.set(ZMQ_HANDSHAKE_IVL, kHandshake_ms) &&
         socket.set(ZMQ_IPV6, url.find('[') == std::string::npos ? 0 : 1);
}

Status set_keys(ZmqSocket& socket, const CurveKeys& keys) {
  if (socket.set(ZMQ_CURVE_SERVER, 1) && socket.set_key(ZMQ_CURVE_PUBLICKEY, keys.public_key) &&
      socket.set_key(ZMQ_CURVE_SECRETKEY, keys.secret_key)) {
    return {};
  }
  return fail_usage("the server's keys are no CURVE keys", {}, "make new ones");
}

tl::unexpected<Error> bind_error(const std::string& url) {
  if (zmq_errno() == EADDRINUSE) {
    return fail("the endpoint is in use by another server", url, "end that one or choose another endpoint");
  }
  return fail("the endpoint cannot be bound", url, zmq_strerror(zmq_errno()));
}

}  // namespace

struct ServerSocket::Impl {
  // In this order: the context waits for its sockets, and they go first.
  detail::ZmqContext context;
  std::unique_ptr<detail::AllowedClients> allowed;
  ZmqSocket socket;
  detail::IpcFile file;
  std::string url;
  detail::PeerTable peers{kMostPeers};
  RefusedMessages refused;
  std::uint64_t batches_not_taken = 0;

  Status bind(const Endpoint& endpoint);
  bool read(ZmqFrame& routing_id, ZmqFrame& body);
  std::optional<Received> take(std::string_view routing_id, const ZmqFrame& body, const Welcome& welcome, double now_s);
  void greet(Peer& peer, const Welcome& welcome);
  bool is_permitted(Peer& peer, const ClientBody& body);
  bool send(Peer& peer, ServerMessage& message);
};

Status ServerSocket::Impl::bind(const Endpoint& endpoint) {
  url = bindable(endpoint.url);
  if (url.starts_with(kIpc)) {
    TROCAR_TRY(file, detail::IpcFile::listen(url.substr(kIpc.size())));
    if (!socket.set(ZMQ_USE_FD, file.release())) return bind_error(url);
  }
  if (zmq_bind(socket.get(), url.c_str()) != 0) return bind_error(url);
  if (!url.starts_with(kIpc)) url = socket.last_endpoint();
  return {};
}

Result<ServerSocket> ServerSocket::bind(const Endpoint& endpoint, std::optional<ServerSecurity> security) {
  if (!endpoint.is_loopback && !security) {
    return fail_usage("an endpoint that other machines reach needs keys", endpoint.url,
                      "make them with `trocar link keygen`, or listen on ipc:// or 127.0.0.1");
  }
  auto impl = std::make_unique<Impl>();
  impl->socket = ZmqSocket(impl->context, ZMQ_ROUTER);
  if (!set_up(impl->socket, endpoint.url)) return fail("no socket", endpoint.url, zmq_strerror(zmq_errno()));
  if (security) {
    TROCAR_TRY_STATUS(set_keys(impl->socket, security->keys));
    TROCAR_TRY(impl->allowed, detail::AllowedClients::start(impl->context, std::move(security->allowed)));
  }
  TROCAR_TRY_STATUS(impl->bind(endpoint));
  return ServerSocket(std::move(impl));
}

ServerSocket::ServerSocket(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ServerSocket::ServerSocket(ServerSocket&&) noexcept = default;
ServerSocket& ServerSocket::operator=(ServerSocket&&) noexcept = default;
ServerSocket::~ServerSocket() = default;

std::optional<Received> ServerSocket::receive(int wait_ms, const Welcome& welcome, double now_s) {
  constexpr std::int64_t kNsPerMs = 1'000'000;
  const std::int64_t begin_ns = now_ns();
  for (int dropped = 0; dropped < kMostDroppedAtOnce;) {
    ZmqFrame routing_id, body;
    if (!impl_->socket.receive(routing_id, ZMQ_DONTWAIT)) {
      const std::int64_t left_ms = wait_ms - (now_ns() - begin_ns) / kNsPerMs;
      if (left_ms <= 0 || !impl_->socket.wait_readable(static_cast<int>(left_ms))) return {};
      continue;
    }
    // The caller's time is of before the wait.
    const double heard_s = now_s + seconds(now_ns() - begin_ns);
    if (impl_->read(routing_id, body)) {
      if (auto received = impl_->take(routing_id.text(), body, welcome, heard_s)) return received;
    }
    ++dropped;
  }
  return {};
}

/// The one frame after the routing id; false and counted when there are others, or it is too large.
bool ServerSocket::Impl::read(ZmqFrame& routing_id, ZmqFrame& body) {
  if (!routing_id.has_more() || !socket.receive(body, ZMQ_DONTWAIT) || body.has_more()) {
    socket.drop_rest(body);
    ++refused.malformed;
    return false;
  }
  if (body.bytes().size() > kMostMessageBytes) {
    ++refused.oversized;
    return false;
  }
  return true;
}

std::optional<Received> ServerSocket::Impl::take(std::string_view routing_id, const ZmqFrame& body,
                                                 const Welcome& welcome, double now_s) {
  auto message = decode_client_message(body.bytes());
  if (!message) {
    ++refused.malformed;
    return {};
  }
  const Hello* hello = std::get_if<Hello>(&message->body);
  Peer* peer = hello != nullptr ? peers.greet(routing_id, *hello, make_session(), now_s) : peers.find(routing_id);
  const Verdict verdict = peer == nullptr    ? Verdict::kUnknownSession
                          : hello != nullptr ? Verdict::kGood
                                             : peers.judge(*peer, message->session, message->sequence, now_s);
  if (verdict != Verdict::kGood) {
    ++(verdict == Verdict::kReplayed ? refused.replayed : refused.unknown_session);
    return {};
  }
  const bool is_leaving = std::holds_alternative<Goodbye>(message->body);
  if (!is_leaving) peers.offer_control(*peer, now_s);
  Received received{peer->session, peers.has_control(*peer), std::move(message->body)};
  if (is_leaving) {
    peers.forget(received.session);
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

/// Tells a peer who it is, and whether it has control.
void ServerSocket::Impl::greet(Peer& peer, const Welcome& welcome) {
  Welcome mine = welcome;
  mine.session = peer.session;
  mine.has_control = peers.has_control(peer);
  ServerMessage message{0, 0, std::move(mine)};
  if (send(peer, message)) peer.was_told_control = peers.has_control(peer);
}

/// Watchers may not move anything.
bool ServerSocket::Impl::is_permitted(Peer& peer, const ClientBody& body) {
  const auto* command = std::get_if<Command>(&body);
  if (command == nullptr && !std::holds_alternative<HandTarget>(body)) return true;
  if (peers.has_control(peer)) return true;
  ++refused.not_in_control;
  if (command != nullptr) {
    ServerMessage reply{0, 0, Reply{command->request, false, "another client has control of this server"}};
    send(peer, reply);
  }
  return false;
}

/// Gives the message the peer's session and next number. False: the peer takes no more, or is not there.
bool ServerSocket::Impl::send(Peer& peer, ServerMessage& message) {
  // Only the first frame can fail: the library has taken the whole message's place with it.
  if (!socket.send(peer.routing_id, ZMQ_SNDMORE | ZMQ_DONTWAIT)) return false;
  message.session = peer.session;
  message.sequence = ++peer.last_sent;
  return socket.send(encode(message), ZMQ_DONTWAIT);
}

void ServerSocket::send_batch(const StateBatch& batch) {
  if (impl_->peers.all().empty()) return;
  ServerMessage message{0, 0, batch};
  for (Peer& peer : impl_->peers.all()) {
    if (!impl_->send(peer, message)) ++impl_->batches_not_taken;
  }
}

void ServerSocket::send_reply(std::uint64_t session, const Reply& reply) {
  Peer* peer = impl_->peers.find_session(session);
  if (peer == nullptr) return;
  ServerMessage message{0, 0, reply};
  impl_->send(*peer, message);
}

void ServerSocket::drop_silent(double now_s) {
  impl_->peers.forget_silent(now_s, kForgotten_s);
}

std::optional<double> ServerSocket::controller_heard_s() const {
  const Peer* controller = impl_->peers.controller();
  return controller == nullptr ? std::optional<double>() : controller->heard_s;
}

std::string ServerSocket::bound_url() const {
  return impl_->url;
}

RefusedMessages ServerSocket::refused() const {
  return impl_->refused;
}

std::uint64_t ServerSocket::batches_not_taken() const {
  return impl_->batches_not_taken;
}

}  // namespace trocar
