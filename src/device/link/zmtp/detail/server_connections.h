#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/log.h"
#include "core/result.h"
#include "link/detail/ipc_file.h"
#include "link/endpoint.h"
#include "link/messages.h"
#include "link/zmtp/detail/curve_handshake.h"
#include "link/zmtp/detail/peer_table.h"
#include "link/zmtp/detail/zmtp_connection.h"

namespace trocar::link::detail {

/// The listening socket of a server and its connections, used by one thread. Limits for untrusted peers: connections,
/// accepts per second, bytes and messages of each connection (link/messages.h). At most kMostUnauthenticated
/// connections have not sent Hello: a new one replaces the oldest of them.
class ServerConnections {
 public:
  /// Errors: address in use, no such folder, too few file descriptors.
  static Result<ServerConnections> listen(const Endpoint& endpoint, std::optional<CurveIdentity> identity);

  struct Incoming {
    ZmtpConnection::Event event = ZmtpConnection::Event::kNone;
    std::string routing_id;              ///< Of the connection: given by the peer, else generated.
    std::span<const std::byte> message;  ///< Valid until the next call.
  };
  /// Returns the next event; connections take turns. Reads available bytes and accepts connections, without waiting.
  std::optional<Incoming> next(double now_s);
  /// Waits until a socket is ready. Returns false if none became ready. The wait is shorter, and returns true, if a
  /// connection has reached a rate limit.
  bool wait(int wait_ms, double now_s);

  /// Returns false if the connection is closed, or more than `most_waiting` bytes would be queued for the peer.
  bool send(std::string_view routing_id, std::span<const std::byte> message, std::size_t most_waiting = kMostBytesOut);
  /// True if a Refusal may be sent to the peer now; refusals are limited in rate.
  bool may_refuse(std::string_view routing_id, double now_s);
  /// Logs a warning within log_limit().
  void report(const std::string& what);
  const std::shared_ptr<LogLimit>& log_limit() const { return log_limit_; }
  /// Sets the function that returns whether the client with this routing id has sent Hello. It is called after the
  /// handshake of a connection, and by refresh().
  void set_known(std::function<bool(std::string_view)> is_known) { is_known_ = std::move(is_known); }
  /// Call it after clients were added or removed.
  void refresh(double now_s);
  /// Closes connections that have not sent Hello within kHelloPatience_s.
  void drop_unauthenticated(double now_s);

  const std::string& url() const { return url_; }
  std::size_t count() const { return connections_.size(); }
  /// Number of connections that were refused, or closed because of invalid data.
  std::uint64_t refused() const { return refused_; }

 private:
  struct Connection {
    Descriptor socket;
    std::unique_ptr<ZmtpConnection> stream;  ///< At a fixed address: messages point into it.
    std::string routing_id;
    double since_s = 0.0;  ///< Start of the time without a Hello.
    bool is_closed = false;
    TokenBucket refusals{kMostRefusalsPerS, kMostRefusalsAtOnce};
  };
  ServerConnections() = default;
  void pump(int wait_ms, double now_s);
  void accept_some(double now_s);
  bool may_connect(int socket) const;
  void make_place();
  void read_some(Connection& connection, double now_s);
  static void flush(Connection& connection);
  std::optional<Incoming> next_buffered(double now_s);
  void name(Connection& connection);
  Connection* find(std::string_view routing_id);

  std::unique_ptr<CurveIdentity> identity_;
  IpcFile file_;
  Descriptor tcp_;
  std::string url_;
  std::vector<Connection> connections_;
  std::function<bool(std::string_view)> is_known_ = [](std::string_view) { return false; };
  std::size_t turn_ = 0;
  std::uint64_t last_number_ = 0, refused_ = 0;
  TokenBucket accepts_{kMostAcceptedPerS, kMostAcceptedAtOnce};
  std::shared_ptr<LogLimit> log_limit_ = std::make_shared<LogLimit>();
  bool has_ready_ = false;  ///< The last pump found a socket ready.
};

}  // namespace trocar::link::detail
