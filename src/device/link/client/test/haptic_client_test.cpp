// The client's thread against a running server, and against raw sockets that misbehave.
#include "link/client/haptic_client.h"

#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <memory>
#include <thread>

#include "link/client/detail/zmq_handles.h"
#include "link/test/link_fixture.h"

namespace trocar::link {
namespace {

using namespace testing;  // the link's

HapticClient connected(const std::string& url, bool wants_control = true) {
  ClientOptions options;
  options.endpoint = url;
  options.wants_control = wants_control;
  auto client = HapticClient::connect(options);
  EXPECT_TRUE(client) << client.error().text();
  return *std::move(client);
}

TEST(HapticClient, ConnectsToARunningServer) {
  const TemporaryFolder folder;
  for (const Endpoint& endpoint : {any_endpoint(), ipc_endpoint(folder)}) {
    RunningServer server(endpoint);
    const HapticClient client = connected(server.url());
    ASSERT_TRUE(HapticClient(connected(server.url(), false)).wait_connected(kPatience));
    EXPECT_TRUE(eventually([&] { return client.view().is_connected; }));
    EXPECT_EQ(client.view().welcome.tool, "needle");
    EXPECT_GE(client.view().welcomes, 1u);
  }
}

TEST(HapticClient, FindsAServerThatComesLater) {
  const TemporaryFolder folder;
  HapticClient client = connected(ipc_endpoint(folder).url);
  EXPECT_FALSE(client.wait_connected(std::chrono::milliseconds(1)));
  EXPECT_FALSE(client.view().is_connected);
  EXPECT_FALSE(client.ask(ServerCommand::kStart, std::chrono::milliseconds(1)));
  const RunningServer server(ipc_endpoint(folder));
  EXPECT_TRUE(client.wait_connected(kPatience));
}

TEST(HapticClient, ConnectsTwoClientsToTwoServersInAnyOrder) {
  const TemporaryFolder one, two;
  HapticClient early = connected(ipc_endpoint(one).url);
  const RunningServer second(ipc_endpoint(two));
  HapticClient late = connected(ipc_endpoint(two).url);
  const RunningServer first(ipc_endpoint(one));
  EXPECT_TRUE(early.wait_connected(kPatience));
  EXPECT_TRUE(late.wait_connected(kPatience));
}

TEST(HapticClient, AskGivesTheReplyOrItsError) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  EXPECT_EQ(client.ask(ServerCommand::kStart, kPatience).value_or("nothing"), "done");
  const SetParameters parameters{std::vector<TissueSetting>{{"liver", "k", 0.5}}};
  const auto refused = client.ask(parameters, kPatience);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("only obeys"), std::string::npos);
  EXPECT_EQ(std::get<SetParameters>(server.received<Command>().back().what), parameters);
}

TEST(HapticClient, NumbersCommandsAndMatchesReplies) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  const std::uint32_t one = client.send(ServerCommand::kStart), two = client.send(ServerCommand::kStop);
  EXPECT_NE(one, two);
  EXPECT_TRUE(client.ask(ServerCommand::kStyletOut, kPatience));
  const std::vector<Reply> replies = client.take_replies();
  ASSERT_EQ(replies.size(), 2u);
  EXPECT_EQ(replies[0].request, one);
  EXPECT_EQ(replies[1].request, two);
  EXPECT_TRUE(client.take_replies().empty());
}

TEST(HapticClient, FailsACommandWithoutServerAndDropsIt) {
  const TemporaryFolder folder;
  HapticClient client = connected(ipc_endpoint(folder).url);
  const std::uint32_t request = client.send(ServerCommand::kStart);
  std::vector<Reply> replies;
  ASSERT_TRUE(eventually([&] { return !(replies = client.take_replies()).empty(); }));
  EXPECT_EQ(replies[0].request, request);
  EXPECT_FALSE(replies[0].is_done);
  RunningServer server(ipc_endpoint(folder));
  ASSERT_TRUE(client.ask(ServerCommand::kStop, kPatience));
  ASSERT_EQ(server.received<Command>().size(), 1u);
}

TEST(HapticClient, SendsHeartbeatsAndEstimatesTheServerClock) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  EXPECT_TRUE(eventually([&] { return server.received<Heartbeat>().size() > 20; }));
  for (const Heartbeat& beat : server.received<Heartbeat>()) EXPECT_EQ(beat.window_age_s, 0.0);
  const ClientView view = client.view();
  EXPECT_GT(view.round_trip_s, 0.0);
  // One machine, one clock: the offset is at most what half the round trip leaves open.
  EXPECT_LE(std::abs(view.clock_offset_s), view.round_trip_s / 2.0);
}

TEST(HapticClient, ReportsTheAgeOfItsLastFrame) {
  RunningServer server(any_endpoint());
  ClientOptions options;
  options.endpoint = server.url();
  options.has_window = true;
  auto client = HapticClient::connect(options);
  ASSERT_TRUE(client);
  // It grows while nothing is drawn, and falls with a picture.
  ASSERT_TRUE(eventually([&] { return server.received<Heartbeat>().size() > 5; }));
  const std::vector<Heartbeat> before = server.received<Heartbeat>();
  EXPECT_GT(before.back().window_age_s, before.front().window_age_s);
  EXPECT_GT(before.front().window_age_s, 0.0);
  EXPECT_TRUE(eventually([&] {
    client->frame_drawn();
    return server.received<Heartbeat>().back().window_age_s < before.back().window_age_s;
  }));
}

TEST(HapticClient, ReceivesTicksInOrderAndTheLatestStatus) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  EXPECT_FALSE(client.newest());
  constexpr std::uint64_t kBatches = 40, kTicks = 25;
  for (std::uint64_t i = 0; i < kBatches; ++i) {
    StateBatch batch = test_batch(i * kTicks, kTicks);
    batch.status = ServerStatus{};
    batch.status->patient = "patient " + std::to_string(i);
    server.send(batch);
  }
  ASSERT_TRUE(eventually([&] { return client.view().ticks_received == kBatches * kTicks; }));
  const std::vector<NumberedSample> samples = client.take_samples();
  ASSERT_EQ(samples.size(), kBatches * kTicks);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(samples[i].tick, i);
    ASSERT_EQ(samples[i].sample.time_s, static_cast<double>(i));
  }
  EXPECT_TRUE(client.take_samples().empty());
  EXPECT_EQ(client.view().ticks_missing, 0u);
  EXPECT_EQ(client.view().status.patient, "patient 39");
  EXPECT_EQ(client.newest()->time_s, static_cast<double>(kBatches * kTicks - 1));
}

TEST(HapticClient, CountsGapsInTheTicks) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  server.send(test_batch(1000, 10));  // a client that joins late misses nothing of its own
  server.send(test_batch(1015, 10));
  server.send(test_batch(1025, 10));
  ASSERT_TRUE(eventually([&] { return client.view().ticks_received == 30; }));
  EXPECT_EQ(client.view().ticks_missing, 5u);
  server.send(test_batch(1000, 10));  // behind what was seen
  ASSERT_TRUE(eventually([&] { return client.view().messages_refused == 1; }));
  EXPECT_EQ(client.view().ticks_received, 30u);
}

TEST(HapticClient, KeepsAMinuteOfTicksAndCountsOlderOnesAsMissing) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  constexpr std::uint64_t kMinute = 60 * 4000;
  std::uint64_t sent = 0;
  while (sent < kMinute + 10 * kMostSamples) {
    server.send(test_batch(sent, kMostSamples));
    sent += kMostSamples;
    ASSERT_TRUE(eventually([&] { return client.view().ticks_received == sent; }));
  }
  const std::vector<NumberedSample> samples = client.take_samples();
  EXPECT_LE(samples.size(), kMinute);
  EXPECT_GT(samples.size(), kMinute - 2 * kMostSamples);
  EXPECT_EQ(samples.size() + client.view().ticks_missing, sent);
  EXPECT_EQ(samples.back().tick, sent - 1);
}

TEST(HapticClient, SendsTheNewestHand) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  HandTarget hand;
  for (int i = 1; i <= 1000; ++i) {
    hand.server_time_s = i;
    client.set_hand(hand);
  }
  ASSERT_TRUE(eventually([&] {
    const auto hands = server.received<HandTarget>();
    return !hands.empty() && hands.back().server_time_s == 1000.0;
  }));
  const auto hands = server.received<HandTarget>();
  for (std::size_t i = 1; i < hands.size(); ++i) EXPECT_GT(hands[i].server_time_s, hands[i - 1].server_time_s);
}

TEST(HapticClient, SecondClientTakesControlWhenTheFirstLeaves) {
  RunningServer server(any_endpoint());
  auto first = std::make_unique<HapticClient>(connected(server.url()));
  ASSERT_TRUE(first->wait_connected(kPatience));
  HapticClient second = connected(server.url());
  ASSERT_TRUE(second.wait_connected(kPatience));
  EXPECT_TRUE(first->view().welcome.has_control);
  EXPECT_FALSE(second.view().welcome.has_control);
  EXPECT_FALSE(second.ask(ServerCommand::kStart, kPatience));
  first.reset();
  EXPECT_TRUE(eventually([&] { return second.view().welcome.has_control; }));
  EXPECT_EQ(server.received<Goodbye>().size(), 1u);
  EXPECT_TRUE(second.ask(ServerCommand::kStart, kPatience));
}

TEST(HapticClient, ReconnectsToARestartedServer) {
  const TemporaryFolder folder;
  auto server = std::make_unique<RunningServer>(ipc_endpoint(folder));
  HapticClient client = connected(ipc_endpoint(folder).url);
  ASSERT_TRUE(client.wait_connected(kPatience));
  server->send(test_batch(0, 500));
  ASSERT_TRUE(eventually([&] { return client.view().ticks_received == 500; }));
  const std::uint64_t first_session = client.view().welcome.session;

  server.reset();
  ASSERT_TRUE(eventually([&] { return !client.view().is_connected; }));
  EXPECT_GT(client.view().silent_s, 0.0);

  server = std::make_unique<RunningServer>(ipc_endpoint(folder));
  ASSERT_TRUE(eventually([&] { return client.view().welcomes >= 2; }));
  EXPECT_NE(client.view().welcome.session, first_session);
  server->send(test_batch(0, 10));  // its ticks begin at 0 again, and that is no gap
  ASSERT_TRUE(eventually([&] { return client.view().ticks_received == 510; }));
  EXPECT_EQ(client.view().ticks_missing, 0u);
  EXPECT_TRUE(client.ask(ServerCommand::kStart, kPatience));
}

TEST(HapticClient, RegainsControlOnAServerThatForgotIt) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  server.with_socket([](ServerSocket& socket) { socket.drop_lost(1e18); });
  ASSERT_TRUE(eventually([&] { return client.view().welcomes >= 2; }));
  EXPECT_TRUE(client.view().welcome.has_control);
}

TEST(HapticClient, KeepsControlOverAServerThatStoodStill) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  ASSERT_TRUE(client.wait_connected(kPatience));
  constexpr double kLongerThanItWaits_s = 3.0;
  server.with_socket(
      [&](ServerSocket&) { EXPECT_TRUE(eventually([&] { return client.view().silent_s > kLongerThanItWaits_s; })); });
  // What it said to the old session is refused there, and it has a new one.
  ASSERT_TRUE(eventually([&] { return client.view().welcomes >= 2; }));
  EXPECT_TRUE(client.view().welcome.has_control);
  EXPECT_TRUE(client.ask(ServerCommand::kStart, kPatience));
}

/// A server of bytes, for what a good one does not do.
class RawServer {
 public:
  RawServer() : socket_(context_, ZMQ_ROUTER) {
    socket_.set(ZMQ_LINGER, 0);
    socket_.set(ZMQ_ROUTER_HANDOVER, 1);
    socket_.set(ZMQ_RCVTIMEO, static_cast<int>(std::chrono::milliseconds(kPatience).count()));
    zmq_bind(socket_.get(), any_endpoint().url.c_str());
  }
  std::string url() const { return socket_.last_endpoint(); }
  std::optional<ClientMessage> receive() {
    detail::ZmqFrame id, body;
    if (!socket_.receive(id, 0) || !socket_.receive(body, 0)) return {};
    client_ = id.text();
    auto message = decode_client_message(body.bytes());
    if (!message) return {};
    return *std::move(message);
  }
  void send(std::span<const std::byte> bytes) {
    socket_.send(client_, ZMQ_SNDMORE);
    socket_.send(bytes, 0);
  }
  void send(std::uint64_t session, std::uint64_t sequence, ServerBody body) {
    send(encode(ServerMessage{session, sequence, std::move(body)}));
  }

 private:
  detail::ZmqContext context_;
  detail::ZmqSocket socket_;
  std::string client_;
};

TEST(HapticClient, ReportsAServerOfAnotherVersion) {
  RawServer server;
  HapticClient client = connected(server.url());
  ASSERT_TRUE(server.receive());
  Bytes other = encode(ServerMessage{0, 0, Refusal{"no"}});
  set_version(other, kLinkVersion + 1);
  server.send(other);
  ASSERT_TRUE(eventually([&] { return !client.view().refusal.empty(); }));
  const Status connected = client.wait_connected(std::chrono::milliseconds(1));
  ASSERT_FALSE(connected);
  EXPECT_NE(connected.error().text().find("version"), std::string::npos) << connected.error().text();
}

TEST(HapticClient, RepeatsHelloToAServerThatForgotIt) {
  RawServer server;
  HapticClient client = connected(server.url());
  ASSERT_TRUE(server.receive());
  Welcome welcome;
  welcome.session = 7;
  server.send(7, 1, welcome);
  ASSERT_TRUE(eventually([&] { return client.view().welcomes == 1; }));
  server.send(0, 0, Refusal{"no session: send Hello first"});
  std::optional<ClientMessage> message;
  do {
    message = server.receive();
    ASSERT_TRUE(message);
  } while (!std::holds_alternative<Hello>(message->body));
  EXPECT_EQ(client.view().refusal, "no session: send Hello first");
}

TEST(HapticClient, CountsForeignMessages) {
  RawServer server;
  HapticClient client = connected(server.url());
  const auto hello = server.receive();
  ASSERT_TRUE(hello && std::holds_alternative<Hello>(hello->body));
  server.send(7, 1, test_batch(0, 1));  // before any welcome
  Welcome welcome;
  welcome.session = 7;
  server.send(7, 1, welcome);
  server.send(Bytes(10, std::byte{1}));
  server.send(8, 2, test_batch(0, 1));     // of another session
  server.send(7, 1, test_batch(0, 1));     // old
  server.send(7, 2, Reply{99, true, ""});  // to nothing
  server.send(7, 3, test_batch(0, 1));
  ASSERT_TRUE(eventually([&] { return client.view().ticks_received == 1; }));
  EXPECT_EQ(client.view().messages_refused, 5u);
}

TEST(HapticClient, RepeatsHelloUntilWelcomed) {
  RawServer server;
  const HapticClient client = connected(server.url());
  for (int i = 0; i < 3; ++i) {
    const auto message = server.receive();
    ASSERT_TRUE(message);
    EXPECT_TRUE(std::holds_alternative<Hello>(message->body));
  }
  EXPECT_FALSE(client.view().is_connected);
}

TEST(HapticClient, FailsPendingCommandsOfASilentServerAndReconnects) {
  RawServer server;
  HapticClient client = connected(server.url());
  ASSERT_TRUE(server.receive());
  Welcome welcome;
  welcome.session = 7;
  server.send(7, 1, welcome);
  ASSERT_TRUE(client.wait_connected(kPatience));
  const std::uint32_t request = client.send(ServerCommand::kStart);
  std::vector<Reply> replies;
  ASSERT_TRUE(eventually([&] { return !(replies = client.take_replies()).empty(); }));
  EXPECT_EQ(replies[0].request, request);
  EXPECT_FALSE(replies[0].is_done);
  std::optional<ClientMessage> message;
  std::uint64_t last = 0;
  while ((message = server.receive()) && !std::holds_alternative<Hello>(message->body)) {
    EXPECT_EQ(message->session, 7u);
    EXPECT_EQ(message->sequence, last + 1);
    last = message->sequence;
  }
  EXPECT_TRUE(message);
}

TEST(HapticClient, DestroysWithoutAnyAnswer) {
  // A port where nobody listens, and a server that never speaks: the destructor must come back from both.
  RawServer mute;
  const TemporaryFolder folder;
  std::promise<void> has_ended;
  std::thread destroying([&, mute_url = mute.url(), nobody_url = ipc_endpoint(folder).url] {
    connected(mute_url);
    connected(nobody_url);
    has_ended.set_value();
  });
  const bool is_in_time = has_ended.get_future().wait_for(kPatience) == std::future_status::ready;
  EXPECT_TRUE(is_in_time) << "the destructor waits for an answer";
  destroying.join();
}

TEST(HapticClient, CanBeMoved) {
  RunningServer server(any_endpoint());
  HapticClient client = connected(server.url());
  HapticClient other = connected(server.url(), false);
  other = std::move(client);
  EXPECT_TRUE(other.ask(ServerCommand::kStart, kPatience));
}

TEST(HapticClient, ConnectsOnlyWithAnAllowedKey) {
  const CurveKeys server_keys = *make_curve_keys(), allowed = *make_curve_keys(), unknown = *make_curve_keys();
  RunningServer server(any_endpoint(), ServerSecurity{server_keys, {allowed.public_key}});
  ClientOptions options;
  options.endpoint = server.url();
  auto keyless = HapticClient::connect(options);
  options.security = ClientSecurity{unknown, server_keys.public_key};
  auto stranger = HapticClient::connect(options);
  options.security = ClientSecurity{allowed, unknown.public_key};
  auto misled = HapticClient::connect(options);
  options.security = ClientSecurity{allowed, server_keys.public_key};
  options.name = "the allowed one";
  auto good = HapticClient::connect(options);
  ASSERT_TRUE(keyless && stranger && misled && good);
  EXPECT_TRUE(good->ask(ServerCommand::kStart, kPatience));
  // Each of the others says what is wrong.
  const auto refusal_of = [](const HapticClient& client) {
    EXPECT_TRUE(eventually([&] { return !client.view().refusal.empty(); }));
    return client.view().refusal;
  };
  EXPECT_NE(refusal_of(*keyless).find("only one side uses keys"), std::string::npos) << refusal_of(*keyless);
  EXPECT_NE(refusal_of(*stranger).find("refused the keys"), std::string::npos) << refusal_of(*stranger);
  EXPECT_NE(refusal_of(*misled).find("refused the keys"), std::string::npos) << refusal_of(*misled);
  EXPECT_NE(stranger->wait_connected(std::chrono::milliseconds(1)).error().text().find("refused the keys"),
            std::string::npos);
  for (const Hello& hello : server.received<Hello>()) EXPECT_EQ(hello.client, "the allowed one");
  for (const HapticClient* other : {&*keyless, &*stranger, &*misled}) {
    EXPECT_FALSE(other->view().is_connected);
    EXPECT_EQ(other->view().welcomes, 0u);
  }
}

TEST(HapticClient, RefusesRemoteServersWithoutValidKeys) {
  ClientOptions options;
  options.endpoint = "tcp://192.0.2.1:5571";  // RFC 5737: for documentation, nobody's
  auto client = HapticClient::connect(options);
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().exit_status, 2);
  options.security = ClientSecurity{{"no", "key"}, "none"};
  EXPECT_FALSE(HapticClient::connect(options));
  options.endpoint = "http://localhost";
  EXPECT_FALSE(HapticClient::connect(options));
}

}  // namespace
}  // namespace trocar::link
