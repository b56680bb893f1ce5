#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/log.h"
#include "core/result.h"
#include "link/endpoint.h"
#include "link/messages.h"

namespace trocar::link {

struct ServerSecurity {
  CurveKeys keys;
  std::set<std::string> allowed;  ///< Clients' public keys.
};

/// Numbers of dropped messages, by reason.
struct RefusedMessages {
  std::uint64_t malformed = 0, oversized = 0, replayed = 0, unknown_session = 0, not_in_control = 0;
  std::uint64_t connections = 0;  ///< Connections refused, or closed because of invalid data; not in total().
  std::uint64_t total() const noexcept { return malformed + oversized + replayed + unknown_session + not_in_control; }
};

/// A message of a client with a session, in the order of sending.
struct Received {
  std::uint64_t session = 0;
  bool has_control = false;  ///< After this message: false for a Goodbye.
  ClientBody body;
};

/// The server's side of the link: an own implementation of a ZMTP 3 ROUTER, for kMostControllers clients that request
/// control and kMostWatchers that do not. One thread uses it. It never blocks on a client: batches that a client does
/// not read in time are counted and dropped. Memory, connections and rates are bounded (link/messages.h) for any input
/// of clients.
class ServerSocket {
 public:
  /// Binds to `endpoint`. Errors: tcp:// without security (exit status 2), address in use, no such folder.
  static Result<ServerSocket> bind(const Endpoint& endpoint, std::optional<ServerSecurity> security = {});
  ServerSocket(ServerSocket&&) noexcept;
  ServerSocket& operator=(ServerSocket&&) noexcept;
  ~ServerSocket();

  /// Returns the next valid message; waits at most `wait_ms` (0: no wait). Answers Hello with a Welcome that has
  /// server, tool and device of `welcome`. Answers a heartbeat with a Pong and returns the heartbeat.
  std::optional<Received> receive(int wait_ms, const Welcome& welcome, double now_s);
  /// Sends a batch to every peer; batches for a peer with a full queue are dropped and counted.
  void send_batch(StateBatch batch);
  /// Sends a reply. Replies are never dropped: a peer that reads too slowly for replies loses its session instead.
  void send_reply(std::uint64_t session, const Reply& reply);
  /// Removes clients that timed out or missed a reply, and closes connections that never sent Hello.
  void drop_lost(double now_s);

  /// Time of the last message from the client in control (steady clock, s); empty without such a client.
  std::optional<double> controller_heard_s() const;
  /// Session of the client in control; 0: none.
  std::uint64_t controller() const;
  /// Limit of the log lines that clients can cause: those of this socket, and the caller's own about their messages.
  std::shared_ptr<LogLimit> log_limit() const;
  /// URL with the actual port: "tcp://127.0.0.1:40123" if the port was 0.
  std::string bound_url() const;
  RefusedMessages refused() const;
  std::uint64_t batches_not_taken() const;
  std::size_t connections() const;  ///< Number of open connections.

 private:
  struct Impl;
  explicit ServerSocket(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::link
