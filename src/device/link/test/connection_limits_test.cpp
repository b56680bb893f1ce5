// Limits of docs/link.md for connections: each at the limit and one beyond. The time is the test's.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "link/detail/ipc_file.h"
#include "link/messages.h"
#include "link/test/raw_link.h"

namespace trocar::link {
namespace {

using testing::kNow_s;
using testing::RawClient;

/// A connection that says nothing.
detail::Descriptor dial(const std::string& url) {
  detail::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string path = url.substr(std::string_view("ipc://").size());
  std::memcpy(name.sun_path, path.c_str(), std::min(path.size() + 1, sizeof name.sun_path - 1));
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&name), sizeof name), 0) << std::strerror(errno);
  return socket;
}

bool is_closed(const detail::Descriptor& socket) {
  char bytes[256];
  ssize_t got = 0;
  while ((got = ::recv(socket.get(), bytes, sizeof bytes, MSG_DONTWAIT)) > 0) {
  }
  return got == 0 || errno == ECONNRESET;
}

/// Accepts and reads whatever waits.
void poll_all(ServerSocket& server, double now_s) {
  for (int n = 0; n < 50; ++n) server.receive(0, testing::test_welcome(), now_s);
}

TEST(ConnectionLimits, Accepts16AtOnceAnd100PerSecond) {
  ServerSocket server = testing::bound();
  std::vector<detail::Descriptor> sockets;
  for (int n = 0; n < 30; ++n) sockets.push_back(dial(server.bound_url()));
  poll_all(server, kNow_s);
  EXPECT_EQ(server.connections(), 16u);
  for (const detail::Descriptor& socket : sockets) EXPECT_FALSE(is_closed(socket));
  // A seventeenth a hundredth of a second later, in the place of the oldest.
  poll_all(server, kNow_s + 0.0101);
  EXPECT_EQ(server.connections(), kMostUnauthenticated);
  EXPECT_TRUE(is_closed(sockets[0]));
  EXPECT_FALSE(is_closed(sockets[1]));
}

TEST(ConnectionLimits, ClosesAConnectionWithoutHelloAfterFiveSeconds) {
  ServerSocket server = testing::bound();
  const detail::Descriptor silent = dial(server.bound_url());
  poll_all(server, kNow_s);
  EXPECT_EQ(server.connections(), 1u);
  server.drop_lost(kNow_s + kHelloPatience_s - 0.01);
  EXPECT_EQ(server.connections(), 1u);
  server.drop_lost(kNow_s + kHelloPatience_s + 0.01);
  EXPECT_EQ(server.connections(), 0u);
  EXPECT_TRUE(is_closed(silent));
}

TEST(ConnectionLimits, AnswersOnlyTenInvalidMessages) {
  ServerSocket server = testing::bound();
  RawClient client(server.bound_url());
  testing::join(server, client);
  constexpr std::uint64_t kSent = 25;
  const Bytes invalid(20, std::byte{7});
  for (std::uint64_t n = 0; n < kSent; ++n) client.send(invalid);
  ASSERT_TRUE(testing::eventually([&] {
    server.receive(1, testing::test_welcome(), kNow_s);
    return server.refused().malformed == kSent;
  }));
  // A pong, sent behind the refusals, ends the wait for them.
  ASSERT_TRUE(testing::beat(server, client));
  std::size_t refusals = 0;
  while (const auto message = client.receive()) {
    if (std::holds_alternative<Pong>(message->body)) break;
    refusals += std::holds_alternative<Refusal>(message->body) ? 1 : 0;
  }
  EXPECT_GE(refusals, 10u);
  EXPECT_LE(refusals, 11u);  // the calls themselves take a little time, in which one more may become due
}

/// With and without keys: the box of a message with keys does not count.
void expect_limit_before_hello(ServerSocket& server, RawClient& client) {
  client.connect();
  client.send(Bytes(kMostBytesBeforeHello));
  ASSERT_TRUE(testing::eventually([&] {
    server.receive(1, testing::test_welcome(), kNow_s);
    return server.refused().malformed == 1;
  }));
  EXPECT_EQ(server.refused().connections, 0u);
  client.send(Bytes(kMostBytesBeforeHello + 1));
  ASSERT_TRUE(testing::eventually([&] {
    server.receive(1, testing::test_welcome(), kNow_s);
    return server.refused().connections == 1;
  }));
  EXPECT_EQ(server.refused().malformed, 1u);
}

TEST(ConnectionLimits, ClosesOnOneByteTooManyBeforeHello) {
  ServerSocket server = testing::bound();
  RawClient client(server.bound_url());
  expect_limit_before_hello(server, client);
}

TEST(ConnectionLimits, ClosesOnOneByteTooManyBeforeHelloWithKeys) {
  const CurveKeys server_keys = *make_curve_keys(), client_keys = *make_curve_keys();
  auto server = ServerSocket::bind(testing::any_port(), ServerSecurity{server_keys, {client_keys.public_key}});
  ASSERT_TRUE(server) << server.error().text();
  RawClient client(server->bound_url());
  client.socket().set_key(ZMQ_CURVE_SERVERKEY, server_keys.public_key);
  client.socket().set_key(ZMQ_CURVE_PUBLICKEY, client_keys.public_key);
  client.socket().set_key(ZMQ_CURVE_SECRETKEY, client_keys.secret_key);
  expect_limit_before_hello(*server, client);
}

}  // namespace
}  // namespace trocar::link
