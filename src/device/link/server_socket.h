#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/result.h"
#include "link/curve_keys.h"
#include "link/endpoint.h"
#include "link/messages.h"

namespace trocar::link {

struct ServerSecurity {
  CurveKeys keys;
  std::set<std::string> allowed;  ///< Clients' public keys.
};

/// What was dropped, and why.
struct RefusedMessages {
  std::uint64_t malformed = 0, oversized = 0, replayed = 0, unknown_session = 0, not_in_control = 0;
  std::uint64_t connections = 0;  ///< Closed for what they sent; not a message.
  std::uint64_t total() const noexcept { return malformed + oversized + replayed + unknown_session + not_in_control; }
};

/// A message of a client that is known, in its order.
struct Received {
  std::uint64_t session = 0;
  bool has_control = false;
  ClientBody body;
};

/// The server's side of the link: a ZMTP 3 ROUTER of its own, for kMostControllers clients that want control and
/// kMostWatchers that do not. Used by one thread. Never blocks on a client: batches that a client does not take are
/// counted and dropped. Memory, connections and rates are bounded (link/limits.h), whatever clients send.
class ServerSocket {
 public:
  /// Binds. Errors: tcp:// without security (refused, exit status 2), address in use, no such folder.
  static Result<ServerSocket> bind(const Endpoint& endpoint, std::optional<ServerSecurity> security = {});
  ServerSocket(ServerSocket&&) noexcept;
  ServerSocket& operator=(ServerSocket&&) noexcept;
  ~ServerSocket();

  /// The next good message, waiting at most so long (ms; 0: not at all). Hello is answered here with a Welcome that
  /// carries `welcome`'s server, tool and device. Heartbeats are answered here with a Pong, and returned.
  std::optional<Received> receive(int wait_ms, const Welcome& welcome, double now_s);
  /// To every peer; batches a slow peer cannot take are dropped for it and counted.
  void send_batch(const StateBatch& batch);
  /// Never dropped: a peer that reads too slowly even for replies loses its session instead.
  void send_reply(std::uint64_t session, const Reply& reply);
  /// Removes clients that timed out or missed a reply, and closes connections that never sent Hello.
  void drop_lost(double now_s);

  /// Time of the last message from the client in control (steady clock, s); empty without such a client.
  std::optional<double> controller_heard_s() const;
  /// "tcp://127.0.0.1:40123" where the port was 0.
  std::string bound_url() const;
  RefusedMessages refused() const;
  std::uint64_t batches_not_taken() const;
  std::size_t connections() const;  ///< Open now.

 private:
  struct Impl;
  explicit ServerSocket(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::link
