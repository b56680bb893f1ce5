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
/// Errors (exit status 2): `text` does not have this format.
Result<WebSocketAddress> parse_websocket_address(std::string_view text);

/// Connection of a client (RFC 6455). No call waits longer than its `limit`. For one thread at a time.
class WebSocket {
 public:
  /// A message of more than `most_bytes` closes the connection.
  static Result<std::unique_ptr<WebSocket>> connect(const WebSocketAddress& address, std::size_t most_bytes,
                                                    std::chrono::milliseconds limit);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  enum class Received { kMessage, kNothingYet, kClosed };
  /// Receives the next message; after kNothingYet, call it again.
  Received receive(std::string& message, std::chrono::milliseconds limit);
  /// Returns false if the message was not sent in time or the connection is closed; the connection is closed then.
  bool send(std::string_view message, std::chrono::milliseconds limit);
  /// Sends the close frame and closes the connection.
  void close(std::chrono::milliseconds limit);

 private:
  struct Connection;
  explicit WebSocket(std::unique_ptr<Connection> connection);

  std::unique_ptr<Connection> connection_;
};

}  // namespace trocar::devices
