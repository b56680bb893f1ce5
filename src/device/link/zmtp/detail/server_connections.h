#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "link/detail/descriptor.h"
#include "link/detail/ipc_file.h"
#include "link/endpoint.h"
#include "link/limits.h"
#include "link/zmtp/detail/curve_handshake.h"
#include "link/zmtp/detail/token_bucket.h"
#include "link/zmtp/detail/zmtp_connection.h"

namespace trocar::link::detail {

/// The listening socket of a server and its connections, in one thread. Bounded in everything that a stranger can
/// raise: connections, accepts a second, bytes and messages of each connection (link/limits.h). Connections that have
/// not said Hello are never more than kMostStrangers: a new one takes the place of the oldest.
class ServerConnections {
 public:
  /// Errors: no keys where the endpoint needs some, address in use, no such folder, too few file descriptors.
  static Result<ServerConnections> listen(const Endpoint& endpoint, std::optional<CurveIdentity> identity);

  struct Incoming {
    ZmtpConnection::Event event = ZmtpConnection::Event::kNone;
    std::string routing_id;              ///< Of the connection: the peer's own, else one of ours.
    std::span<const std::byte> message;  ///< Until the next call.
  };
  /// The next event, connections in turn; it reads and accepts what is there, without waiting.
  std::optional<Incoming> next(double now_s);
  /// Waits until a socket is ready; false: nothing came. Shorter where a rate limit holds a connection back.
  bool wait(int wait_ms, double now_s);

  /// False: the connection is gone, or more than `most_waiting` bytes would wait for the peer.
  bool send(std::string_view routing_id, std::span<const std::byte> message, std::size_t most_waiting = kMostBytesOut);
  /// Whether a message to a peer about a bad one of its own is due: they are limited in rate.
  bool may_refuse(std::string_view routing_id, double now_s);
  /// A warning in the log, limited in rate.
  void report(const std::string& what, double now_s);
  /// Who has said Hello, by routing id: asked when a connection is made, and by refresh().
  void set_known(std::function<bool(std::string_view)> is_known) { is_known_ = std::move(is_known); }
  /// Clients came or went.
  void refresh(double now_s);
  /// Closes connections that have not said Hello within kHelloPatience_s.
  void drop_strangers(double now_s);

  const std::string& url() const { return url_; }
  std::size_t count() const { return connections_.size(); }
  std::uint64_t refused() const { return refused_; }  ///< Connections that were closed for what they sent.

 private:
  struct Connection {
    Descriptor socket;
    std::unique_ptr<ZmtpConnection> stream;  ///< At one place: messages point into it.
    std::string routing_id;
    double since_s = 0.0;  ///< A stranger since.
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
  TokenBucket log_lines_{kMostLogLinesPerS, kMostLogLinesAtOnce};
  bool has_ready_ = false;  ///< The last pump found a socket ready.
};

}  // namespace trocar::link::detail
