#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::devices {

/// "ws://HOST[:PORT][/PATH]".
struct WebSocketAddress {
  std::string host = "localhost";
  std::string port = "80";
  std::string path = "/";

  std::string text() const { return "ws://" + host + ":" + port + path; }
};
/// Exit status 2 where it is not that.
Result<WebSocketAddress> parse_websocket_address(std::string_view text);

/// A client's connection (RFC 6455) that never waits longer than it is told. For one thread at a time.
class WebSocket {
 public:
  /// Messages of more than `most_bytes` close the connection.
  static Result<std::unique_ptr<WebSocket>> connect(const WebSocketAddress& address, std::size_t most_bytes,
                                                    std::chrono::milliseconds limit);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  enum class Received { kMessage, kNothingYet, kClosed };
  /// The next message; after kNothingYet ask again.
  Received receive(std::string& message, std::chrono::milliseconds limit);
  /// false: it was not sent in time, or the connection is closed; it is closed then.
  bool send(std::string_view message, std::chrono::milliseconds limit);
  /// Says goodbye and closes.
  void close(std::chrono::milliseconds limit);

 private:
  struct Connection;
  explicit WebSocket(std::unique_ptr<Connection> connection);

  std::unique_ptr<Connection> connection_;
};

}  // namespace trocar::devices
