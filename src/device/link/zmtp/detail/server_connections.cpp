#include "link/zmtp/detail/server_connections.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "core/log.h"
#include "link/messages.h"
#include "link/zmtp/detail/tcp_address.h"

namespace trocar::link::detail {
namespace {

constexpr int kMostAcceptedPerPoll = 8;  ///< Per poll of the sockets.
constexpr int kHeldBack_ms = 1;          ///< Interval of checking a rate limit.
/// Descriptors of a server besides its connections: device, records, scenes, libraries. [assumed]
constexpr rlim_t kReservedDescriptors = 128;
constexpr double kPauseAccepts = 50.0;  ///< Skipped accepts without a free descriptor: half a second.

/// Raises the soft limit if it is too low for all connections and the reserve.
Status ensure_descriptors() {
  constexpr rlim_t kWanted = kReservedDescriptors + kMostUnauthenticated + kMostControllers + kMostWatchers;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kWanted) return {};
  limit.rlim_cur = kWanted;
  if (limit.rlim_max >= kWanted && ::setrlimit(RLIMIT_NOFILE, &limit) == 0) return {};
  return fail(fmt::format("only {} file descriptors are allowed, the server needs {}", limit.rlim_max, kWanted),
              "RLIMIT_NOFILE", "raise the limit: ulimit -n 1024");
}

}  // namespace

Result<ServerConnections> ServerConnections::listen(const Endpoint& endpoint, std::optional<CurveIdentity> identity) {
  TROCAR_TRY_STATUS(ensure_descriptors());
  ServerConnections made;
  if (identity) made.identity_ = std::make_unique<CurveIdentity>(*std::move(identity));
  if (endpoint.url.starts_with(kIpcScheme)) {
    TROCAR_TRY(made.file_, IpcFile::listen(endpoint.url.substr(kIpcScheme.size())));
    made.url_ = endpoint.url;
    return made;
  }
  TROCAR_TRY(TcpListener listener, listen_tcp(endpoint.url));
  made.tcp_ = std::move(listener.socket);
  made.url_ = std::move(listener.url);
  return made;
}

std::optional<ServerConnections::Incoming> ServerConnections::next(double now_s) {
  if (auto incoming = next_buffered(now_s)) return incoming;
  pump(0, now_s);
  return next_buffered(now_s);
}

bool ServerConnections::wait(int wait_ms, double now_s) {
  const bool is_held_back =
      std::ranges::any_of(connections_, [&](Connection& connection) { return connection.stream->room(now_s) == 0; });
  pump(is_held_back ? std::min(wait_ms, kHeldBack_ms) : wait_ms, now_s);
  return has_ready_ || is_held_back;
}

std::optional<ServerConnections::Incoming> ServerConnections::next_buffered(double now_s) {
  std::erase_if(connections_, [](const Connection& connection) { return connection.is_closed; });
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    turn_ = (turn_ + 1) % connections_.size();
    Connection& connection = connections_[turn_];
    if (connection.is_closed) continue;
    ZmtpConnection::Incoming incoming = connection.stream->next(now_s);
    if (incoming.event == ZmtpConnection::Event::kReady) {
      name(connection);
      incoming = connection.stream->next(now_s);
    }
    if (incoming.event == ZmtpConnection::Event::kNone) {
      flush(connection);
      continue;
    }
    if (incoming.event == ZmtpConnection::Event::kBroken) {
      report(fmt::format("a connection was closed: {}", connection.stream->why()));
      flush(connection);  // the last message to the client
      connection.is_closed = true;
      ++refused_;
      continue;
    }
    return Incoming{incoming.event, connection.routing_id, incoming.message};
  }
  return {};
}

/// A client that reconnects keeps its routing id; the old connection is dead.
void ServerConnections::name(Connection& connection) {
  std::string routing_id = connection.stream->identity();
  if (routing_id.empty()) {
    routing_id = fmt::format("connection {}", ++last_number_);
    routing_id.insert(routing_id.begin(), '\0');  // routing ids of clients never start with it
  }
  if (Connection* old = find(routing_id)) {
    connection.since_s = std::max(connection.since_s, old->since_s);
    old->is_closed = true;
    old->routing_id.clear();
  }
  connection.stream->set_greeted(is_known_(routing_id));
  connection.routing_id = std::move(routing_id);
}

void ServerConnections::pump(int wait_ms, double now_s) {
  has_ready_ = false;
  accepts_.refill(now_s);
  std::vector<pollfd> polled;
  polled.reserve(connections_.size() + 1);
  for (Connection& connection : connections_) {
    short events = 0;
    if (connection.stream->room(now_s) > 0) events |= POLLIN;
    if (!connection.stream->outgoing().empty()) events |= POLLOUT;
    polled.push_back({connection.socket.get(), events, 0});
  }
  const int listener = tcp_.is_open() ? tcp_.get() : file_.get();
  polled.push_back({accepts_.has_tokens() ? listener : -1, POLLIN, 0});
  if (::poll(polled.data(), polled.size(), wait_ms) <= 0) return;
  has_ready_ = true;
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    const short ready = polled[i].revents;
    if ((ready & POLLOUT) != 0) flush(connections_[i]);
    if ((ready & POLLIN) != 0) {
      read_some(connections_[i], now_s);
    } else if ((ready & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
      connections_[i].is_closed = true;
    }
  }
  if (polled.back().revents != 0) accept_some(now_s);
}

void ServerConnections::read_some(Connection& connection, double now_s) {
  std::array<std::byte, kReadAtOnce> bytes;
  const std::size_t room = std::min(connection.stream->room(now_s), bytes.size());
  const ssize_t got = ::recv(connection.socket.get(), bytes.data(), room, 0);
  if (got > 0) {
    connection.stream->append(std::span(bytes).first(static_cast<std::size_t>(got)));
  } else if (got == 0 || (errno != EAGAIN && errno != EINTR)) {
    connection.is_closed = true;
  }
}

void ServerConnections::flush(Connection& connection) {
  while (!connection.stream->outgoing().empty()) {
    const auto bytes = connection.stream->outgoing();
    const ssize_t sent = ::send(connection.socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno != EAGAIN) connection.is_closed = true;
    if (sent <= 0) return;
    connection.stream->note_sent(static_cast<std::size_t>(sent));
  }
}

void ServerConnections::accept_some(double now_s) {
  const int listener = tcp_.is_open() ? tcp_.get() : file_.get();
  for (int i = 0; i < kMostAcceptedPerPoll && accepts_.has_tokens(); ++i) {
    Descriptor socket(::accept4(listener, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket.is_open()) {
      if (errno == EAGAIN || errno == EINTR || errno == ECONNABORTED) return;
      accepts_.take(kPauseAccepts);
      report(fmt::format("cannot accept a connection: {}", std::strerror(errno)));
      return;
    }
    accepts_.take(1.0);
    if (!may_connect(socket.get())) {
      report("a connection of another user was refused");
      ++refused_;
      continue;
    }
    make_place();
    Connection& connection = connections_.emplace_back();
    connection.socket = std::move(socket);
    connection.stream = std::make_unique<ZmtpConnection>(identity_.get());
    connection.since_s = now_s;
    flush(connection);
  }
}

/// ipc: the same user, or root. tcp: decided by the keys.
bool ServerConnections::may_connect(int socket) const {
  if (tcp_.is_open()) {
    constexpr int kOn = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
    return true;
  }
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return false;
  return peer.uid == ::geteuid() || peer.uid == 0;
}

void ServerConnections::make_place() {
  const auto is_unauthenticated = [](const Connection& c) { return !c.is_closed && !c.stream->is_greeted(); };
  if (static_cast<std::size_t>(std::ranges::count_if(connections_, is_unauthenticated)) < kMostUnauthenticated) return;
  const auto oldest = std::ranges::find_if(connections_, is_unauthenticated);  // they are in the order of their accept
  oldest->is_closed = true;
  oldest->socket.close();
}

bool ServerConnections::send(std::string_view routing_id, std::span<const std::byte> message,
                             std::size_t most_waiting) {
  Connection* const connection = find(routing_id);
  if (connection == nullptr || !connection->stream->put(message, most_waiting)) return false;
  flush(*connection);
  return true;
}

bool ServerConnections::may_refuse(std::string_view routing_id, double now_s) {
  Connection* const connection = find(routing_id);
  if (connection == nullptr) return false;
  connection->refusals.refill(now_s);
  if (!connection->refusals.has_tokens()) return false;
  connection->refusals.take(1.0);
  return true;
}

void ServerConnections::refresh(double now_s) {
  for (Connection& connection : connections_) {
    const bool is_known = !connection.routing_id.empty() && is_known_(connection.routing_id);
    if (connection.stream->is_greeted() && !is_known) connection.since_s = now_s;
    connection.stream->set_greeted(is_known);
  }
}

void ServerConnections::drop_unauthenticated(double now_s) {
  refresh(now_s);
  for (Connection& connection : connections_) {
    const bool is_late = now_s - connection.since_s > kHelloPatience_s;
    if (is_late && !connection.stream->is_greeted()) connection.is_closed = true;
  }
  std::erase_if(connections_, [](const Connection& connection) { return connection.is_closed; });
}

ServerConnections::Connection* ServerConnections::find(std::string_view routing_id) {
  const auto found = std::ranges::find_if(connections_, [&](const Connection& connection) {
    return !connection.is_closed && !connection.routing_id.empty() && connection.routing_id == routing_id;
  });
  return found == connections_.end() ? nullptr : &*found;
}

void ServerConnections::report(const std::string& what) {
  const LimitedLog limited(*log_limit_);
  log_warning("link: {}", what);
}

}  // namespace trocar::link::detail
