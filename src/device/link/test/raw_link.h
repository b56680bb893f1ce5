#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "link/client/detail/zmq_handles.h"
#include "link/test/link_fixture.h"

namespace trocar::testing {

/// A DEALER that sends any messages of a test, valid or invalid.
class RawClient {
 public:
  explicit RawClient(const std::string& url, int most_waiting = 1000) : socket_(context_, ZMQ_DEALER) {
    socket_.set(ZMQ_LINGER, 0);
    socket_.set(ZMQ_RCVHWM, most_waiting);
    socket_.set(ZMQ_SNDTIMEO, kPatience_ms);
    socket_.set(ZMQ_RCVTIMEO, kPatience_ms);
    url_ = url;
  }
  link::detail::ZmqSocket& socket() { return socket_; }
  void connect() { zmq_connect(socket_.get(), url_.c_str()); }

  bool send(std::span<const std::byte> bytes) { return socket_.send(bytes, 0); }
  bool send(std::uint64_t session, std::uint64_t sequence, link::ClientBody body) {
    return send(link::encode(link::ClientMessage{session, sequence, std::move(body)}));
  }
  bool send(link::ClientBody body) { return send(session_, ++sequence_, std::move(body)); }
  bool hello(const std::string& name = "raw", bool wants_control = true) {
    sequence_ = 0;
    return send(0, 0, link::Hello{name, wants_control});
  }
  /// Receives the next message; a Welcome sets the session of this client.
  std::optional<link::ServerMessage> receive(int flags = 0) {
    link::detail::ZmqFrame frame;
    if (!socket_.receive(frame, flags)) return {};
    auto message = link::decode_server_message(frame.bytes());
    if (!message) return {};
    if (const auto* welcome = std::get_if<link::Welcome>(&message->body)) session_ = welcome->session;
    return *std::move(message);
  }
  /// Receives the next message with this body; other messages are skipped.
  template <class Body>
  std::optional<Body> next() {
    while (auto message = receive()) {
      if (auto* body = std::get_if<Body>(&message->body)) return std::move(*body);
    }
    return {};
  }
  std::uint64_t session() const { return session_; }

 private:
  link::detail::ZmqContext context_;
  link::detail::ZmqSocket socket_;
  std::string url_;
  std::uint64_t session_ = 0, sequence_ = 0;
};

inline constexpr double kNow_s = 100.0;
inline constexpr double kLongAfter_s = 1000.0;

inline link::ServerSocket bound(const link::Endpoint& endpoint = any_endpoint()) {
  auto server = link::ServerSocket::bind(endpoint);
  EXPECT_TRUE(server) << server.error().text();
  return *std::move(server);
}

inline std::optional<link::Received> serve(link::ServerSocket& server, double now_s = kNow_s) {
  return server.receive(kPatience_ms, test_welcome(), now_s);
}

/// Receives the next message with this body, while the server sends its queued data. Messages of clients are dropped
/// meanwhile.
template <class Body>
std::optional<Body> next_while_served(link::ServerSocket& server, RawClient& client) {
  std::optional<Body> body;
  eventually([&] {
    server.receive(0, test_welcome(), kNow_s);
    const auto message = client.receive(ZMQ_DONTWAIT);
    if (message && std::holds_alternative<Body>(message->body)) body = std::get<Body>(message->body);
    return body.has_value();
  });
  return body;
}

/// Connects a client and waits for its session.
inline void join(link::ServerSocket& server, RawClient& client, bool wants_control = true, double now_s = kNow_s) {
  client.connect();
  ASSERT_TRUE(client.hello("raw", wants_control));
  const auto hello = serve(server, now_s);
  ASSERT_TRUE(hello);
  ASSERT_TRUE(std::holds_alternative<link::Hello>(hello->body));
  const auto welcome = client.next<link::Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_NE(welcome->session, 0u);
  EXPECT_EQ(welcome->session, hello->session);
}

/// Sends a heartbeat that must arrive: the server has then checked all earlier messages of the client.
inline std::optional<link::Received> beat(link::ServerSocket& server, RawClient& client, double now_s = kNow_s) {
  EXPECT_TRUE(client.send(link::Heartbeat{1.0, 0.0, 0}));
  auto received = serve(server, now_s);
  EXPECT_TRUE(received && std::holds_alternative<link::Heartbeat>(received->body));
  return received;
}

}  // namespace trocar::testing
