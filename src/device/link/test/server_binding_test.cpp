// Where a server listens, and to whom: addresses, socket files, keys.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "link/server_socket.h"
#include "link/test/raw_link.h"

namespace trocar::link {
namespace {

using namespace testing;  // the link's

TEST(ServerBinding, RefusesTcpWithoutKeys) {
  for (const char* url : {"tcp://127.0.0.1:0", "tcp://[::1]:0", "tcp://0.0.0.0:0"}) {
    const auto server = ServerSocket::bind(*parse_endpoint(url));
    ASSERT_FALSE(server) << url;
    EXPECT_EQ(server.error().exit_status, 2) << url;
  }
}

TEST(ServerBinding, EndpointInUseIsAnError) {
  const TemporaryFolder folder;
  ServerSocket first = bound(ipc_endpoint(folder));
  const auto second = ServerSocket::bind(ipc_endpoint(folder));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("in use"), std::string::npos) << second.error().text();
  // The first is not harmed.
  RawClient client(first.bound_url());
  join(first, client);
}

TEST(ServerBinding, FailsForAMissingFolder) {
  EXPECT_FALSE(ServerSocket::bind({"ipc:///no/such/folder/socket", false}));
}

TEST(ServerBinding, MakesAPrivateSocketFileAndRemovesIt) {
  const TemporaryFolder folder;
  {
    ServerSocket server = bound(ipc_endpoint(folder));
    struct stat made {};
    ASSERT_EQ(::stat((folder / "socket").c_str(), &made), 0);
    EXPECT_EQ(made.st_mode & 0777u, 0600u);
  }
  EXPECT_TRUE(folder.is_empty());
}

TEST(ServerBinding, ReplacesTheSocketOfADeadServer) {
  const TemporaryFolder folder;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, (folder / "socket").c_str(), sizeof name.sun_path - 1);
  const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(::bind(dead, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  ::close(dead);
  ASSERT_TRUE(std::filesystem::exists(folder / "socket"));
  ServerSocket server = bound(ipc_endpoint(folder));
  RawClient client(server.bound_url());
  join(server, client);
}

TEST(ServerBinding, KeepsAFileThatIsNotASocket) {
  const TemporaryFolder folder;
  std::ofstream(folder / "socket") << "somebody's";
  EXPECT_FALSE(ServerSocket::bind(ipc_endpoint(folder)));
  EXPECT_EQ(std::filesystem::file_size(folder / "socket"), 10u);
}

class SecureServer : public ::testing::Test {
 protected:
  void SetUp() override {
    auto bound = ServerSocket::bind(any_port(), ServerSecurity{server_keys_, {allowed_.public_key}});
    ASSERT_TRUE(bound) << bound.error().text();
    server_.emplace(*std::move(bound));
  }
  void use(RawClient& client, const CurveKeys& keys) {
    client.socket().set_key(ZMQ_CURVE_SERVERKEY, server_keys_.public_key);
    client.socket().set_key(ZMQ_CURVE_PUBLICKEY, keys.public_key);
    client.socket().set_key(ZMQ_CURVE_SECRETKEY, keys.secret_key);
  }
  CurveKeys server_keys_ = *make_curve_keys(), allowed_ = *make_curve_keys();
  std::optional<ServerSocket> server_;
};

TEST_F(SecureServer, WelcomesOnlyAllowedClients) {
  RawClient unknown(server_->bound_url()), keyless(server_->bound_url()), good(server_->bound_url());
  use(unknown, *make_curve_keys());
  use(good, allowed_);
  for (RawClient* client : {&unknown, &keyless}) {
    client->connect();
    client->hello("stranger");
  }
  // The strangers were first; when the allowed one is served for a while, they would have been.
  join(*server_, good);
  for (int i = 0; i < 20; ++i) {
    const auto beaten = beat(*server_, good);
    ASSERT_TRUE(beaten);
    EXPECT_EQ(beaten->session, good.session());
    EXPECT_TRUE(beaten->has_control);
    ASSERT_TRUE(good.next<Pong>());
  }
  server_->send_batch(test_batch(0, 1));
  EXPECT_TRUE(good.next<StateBatch>());
  EXPECT_FALSE(unknown.receive(ZMQ_DONTWAIT));
  EXPECT_FALSE(keyless.receive(ZMQ_DONTWAIT));
  EXPECT_EQ(server_->refused().total(), 0u);
}

TEST_F(SecureServer, ListensBeyondLoopback) {
  auto server = ServerSocket::bind({"tcp://0.0.0.0:0", true}, ServerSecurity{server_keys_, {}});
  EXPECT_TRUE(server) << server.error().text();
}

TEST_F(SecureServer, ListensOnIpv6) {
  auto server = ServerSocket::bind({"tcp://[::1]:0", true}, ServerSecurity{server_keys_, {allowed_.public_key}});
  if (!server) GTEST_SKIP() << "no IPv6 here: " << server.error().text();
  RawClient client(server->bound_url());
  client.socket().set(ZMQ_IPV6, 1);
  use(client, allowed_);
  join(*server, client);
}

TEST_F(SecureServer, PortInUseIsAnError) {
  const auto second =
      ServerSocket::bind({server_->bound_url(), true}, ServerSecurity{server_keys_, {allowed_.public_key}});
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().what.find("in use"), std::string::npos) << second.error().text();
}

TEST_F(SecureServer, CarriesLongMessagesInBothDirections) {
  RawClient client(server_->bound_url());
  use(client, allowed_);
  join(*server_, client);
  SetParameters parameters;
  parameters.tissues = std::vector(3, TissueSetting{std::string(kMostTextBytes, 'x'), "k", 0.5});
  client.send(Command{7, parameters});
  const auto received = serve(*server_);
  ASSERT_TRUE(received);
  EXPECT_EQ(std::get<SetParameters>(std::get<Command>(received->body).what), parameters);
  server_->send_batch(test_batch(3, kMostSamples));
  const auto batch = client.next<StateBatch>();
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->samples.size(), kMostSamples);
}

TEST_F(SecureServer, RefusesMalformedKeys) {
  const auto server = ServerSocket::bind(any_endpoint(), ServerSecurity{{"no", "key"}, {}});
  ASSERT_FALSE(server);
  EXPECT_EQ(server.error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::link
