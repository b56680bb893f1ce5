// The server's socket against raw clients, in one thread: time is an argument.
#include "link/server_socket.h"

#include <gtest/gtest.h>

#include "link/test/raw_link.h"

namespace trocar::link {
namespace {

using namespace testing;  // the link's

TEST(ServerSocket, WelcomesAClientWithItsToolAndDevice) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  client.connect();
  client.hello("the client");
  const auto received = serve(server);
  ASSERT_TRUE(received);
  EXPECT_EQ(std::get<Hello>(received->body).client, "the client");
  EXPECT_TRUE(received->has_control);
  const auto welcome = client.next<Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_EQ(welcome->tool, "needle");
  EXPECT_EQ(welcome->device.name, "virtual");
  EXPECT_TRUE(welcome->has_control);
}

TEST(ServerSocket, AnswersAHeartbeatWithItsOwnTime) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  client.send(Heartbeat{12.5, 0.0, 7});
  const auto received = serve(server);
  ASSERT_TRUE(received);
  EXPECT_EQ(std::get<Heartbeat>(received->body).ticks_received, 7u);
  const auto pong = client.next<Pong>();
  ASSERT_TRUE(pong);
  EXPECT_EQ(pong->client_time_s, 12.5);
  EXPECT_GE(pong->server_time_s, kNow_s);
}

TEST(ServerSocket, CarriesCommandsInOrderWithTheirReplies) {
  const TemporaryFolder folder;
  ServerSocket server = bound(ipc_endpoint(folder));
  RawClient client(server.bound_url());
  join(server, client);
  for (std::uint32_t i = 1; i <= 20; ++i) client.send(Command{i, ServerCommand::kStart});
  for (std::uint32_t i = 1; i <= 20; ++i) {
    const auto received = serve(server);
    ASSERT_TRUE(received);
    ASSERT_EQ(std::get<Command>(received->body).request, i);
    server.send_reply(received->session, {i, true, "started"});
    const auto reply = client.next<Reply>();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->request, i);
    EXPECT_EQ(reply->text, "started");
  }
}

TEST(ServerSocket, SendsEveryTickToEveryClient) {
  ServerSocket server = bound();
  RawClient one(server.bound_url()), two(server.bound_url());
  join(server, one);
  join(server, two, false);
  for (std::uint64_t i = 0; i < 20; ++i) server.send_batch(test_batch(i * 25, 25));
  for (RawClient* client : {&one, &two}) {
    for (std::uint64_t i = 0; i < 20; ++i) {
      const auto batch = next_while_served<StateBatch>(server, *client);
      ASSERT_TRUE(batch);
      EXPECT_EQ(batch->first_tick, i * 25);
      ASSERT_EQ(batch->samples.size(), 25u);
      EXPECT_EQ(batch->samples.back().time_s, static_cast<double>(i * 25 + 24));
    }
  }
  EXPECT_EQ(server.batches_not_taken(), 0u);
}

TEST(ServerSocket, EveryClientMayStop) {
  ServerSocket server = bound();
  RawClient controller(server.bound_url());
  join(server, controller);
  for (const bool wants_control : {false, true}) {
    RawClient other(server.bound_url());
    join(server, other, wants_control);
    other.send(Command{7, ServerCommand::kStop});
    const auto stop = serve(server);
    ASSERT_TRUE(stop);
    EXPECT_FALSE(stop->has_control);
    const auto* command = std::get_if<Command>(&stop->body);
    ASSERT_NE(command, nullptr);
    EXPECT_TRUE(is_stop(*command));
    // Only the stop: any other command without control is answered with an error.
    for (int number = 0; number <= static_cast<int>(kLastServerCommand); ++number) {
      if (static_cast<ServerCommand>(number) != ServerCommand::kStop)
        other.send(Command{8, static_cast<ServerCommand>(number)});
    }
    other.send(Command{9, LoadScene{}});
    other.send(Command{10, SetParameters{}});
    ASSERT_TRUE(beat(server, other));
  }
  EXPECT_EQ(server.refused().not_in_control, 2u * (static_cast<unsigned>(kLastServerCommand) + 2u));
}

TEST(ServerSocket, ReportsTheController) {
  ServerSocket server = bound();
  EXPECT_EQ(server.controller(), 0u);
  RawClient first(server.bound_url()), second(server.bound_url());
  join(server, first);
  EXPECT_EQ(server.controller(), first.session());
  join(server, second);
  EXPECT_EQ(server.controller(), first.session());
  first.send(Goodbye{});
  const auto goodbye = serve(server);
  ASSERT_TRUE(goodbye);
  EXPECT_FALSE(goodbye->has_control) << "a client that leaves has no control";
  EXPECT_EQ(server.controller(), 0u);
  ASSERT_TRUE(beat(server, second));
  EXPECT_EQ(server.controller(), second.session());
  server.drop_lost(kLongAfter_s);  // it sent nothing for kForgotten_s
  EXPECT_EQ(server.controller(), 0u);
}

TEST(ServerSocket, FirstClientGetsControlAndOthersWatch) {
  ServerSocket server = bound();
  RawClient first(server.bound_url()), second(server.bound_url());
  join(server, first);
  join(server, second);
  second.send(HandTarget{});
  second.send(Command{5, ServerCommand::kStart});
  const auto beaten = beat(server, second);
  ASSERT_TRUE(beaten);
  EXPECT_FALSE(beaten->has_control);
  EXPECT_EQ(server.refused().not_in_control, 2u);
  const auto reply = second.next<Reply>();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->request, 5u);
  EXPECT_FALSE(reply->is_done);

  first.send(HandTarget{});
  const auto hand = serve(server);
  ASSERT_TRUE(hand);
  EXPECT_TRUE(hand->has_control);
  EXPECT_TRUE(std::holds_alternative<HandTarget>(hand->body));
}

TEST(ServerSocket, WatcherNeverGetsControl) {
  ServerSocket server = bound();
  RawClient watcher(server.bound_url());
  join(server, watcher, false);
  EXPECT_FALSE(server.controller_heard_s());
  const auto beaten = beat(server, watcher);
  ASSERT_TRUE(beaten);
  EXPECT_FALSE(beaten->has_control);
}

TEST(ServerSocket, GoodbyePassesControlToTheNextClient) {
  ServerSocket server = bound();
  RawClient first(server.bound_url()), second(server.bound_url());
  join(server, first);
  join(server, second);
  first.send(Goodbye{});
  const auto goodbye = serve(server);
  ASSERT_TRUE(goodbye);
  EXPECT_TRUE(std::holds_alternative<Goodbye>(goodbye->body));
  EXPECT_FALSE(server.controller_heard_s());
  const auto beaten = beat(server, second);
  ASSERT_TRUE(beaten);
  EXPECT_TRUE(beaten->has_control);
  const std::uint64_t session = second.session();
  const auto welcome = second.next<Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_TRUE(welcome->has_control);
  EXPECT_EQ(welcome->session, session);
}

TEST(ServerSocket, NotifiesASilentControllerThatItLostControl) {
  ServerSocket server = bound();
  RawClient first(server.bound_url()), second(server.bound_url());
  join(server, first);
  join(server, second);
  EXPECT_TRUE(beat(server, second, kLongAfter_s)->has_control);
  EXPECT_GE(server.controller_heard_s().value_or(0.0), kLongAfter_s);
  EXPECT_TRUE(second.next<Welcome>()->has_control);
  EXPECT_FALSE(beat(server, first, kLongAfter_s)->has_control);
  EXPECT_FALSE(first.next<Welcome>()->has_control);
}

TEST(ServerSocket, HelloOnAUsedSessionStartsANewOneWithControl) {
  ServerSocket server = bound();
  RawClient client(server.bound_url()), other(server.bound_url());
  join(server, client);
  join(server, other);
  beat(server, client);
  const std::uint64_t old_session = client.session();
  client.hello();
  ASSERT_TRUE(serve(server));
  const auto welcome = client.next<Welcome>();
  ASSERT_TRUE(welcome);
  EXPECT_NE(welcome->session, old_session);
  EXPECT_TRUE(welcome->has_control);
  EXPECT_TRUE(beat(server, client)->has_control);
}

TEST(ServerSocket, RepeatedHelloKeepsTheSession) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  client.connect();
  for (int i = 0; i < 3; ++i) client.hello();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(serve(server));
  const std::uint64_t session = client.next<Welcome>()->session;
  EXPECT_EQ(client.next<Welcome>()->session, session);
  EXPECT_EQ(client.next<Welcome>()->session, session);
  EXPECT_TRUE(beat(server, client));
  EXPECT_EQ(server.refused().total(), 0u);
}

TEST(ServerSocket, CountsMalformedMessagesAndContinues) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  const Bytes good = encode(ClientMessage{client.session(), 9, Heartbeat{}});
  client.send(Bytes{});
  client.send(Bytes(100, std::byte{0xff}));
  client.send(std::span(good).first(good.size() / 2));
  client.socket().send("two", ZMQ_SNDMORE);
  client.socket().send("frames", 0);
  ASSERT_TRUE(beat(server, client));
  EXPECT_EQ(server.refused().malformed, 4u);
  EXPECT_EQ(server.refused().total(), 4u);
}

TEST(ServerSocket, OversizedMessageIsCountedAndDropped) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  client.send(Bytes(kMostMessageBytes + 1));
  ASSERT_TRUE(beat(server, client));
  EXPECT_EQ(server.refused().oversized, 1u);
  EXPECT_EQ(server.refused().total(), 1u);
}

TEST(ServerSocket, EnormousMessageDisconnectsOnlyItsSender) {
  ServerSocket server = bound();
  RawClient hostile(server.bound_url()), good(server.bound_url());
  join(server, good);
  join(server, hostile, false);
  hostile.send(Bytes(8 * kMostMessageBytes));
  // The library connects again; the old routing id is gone, so this is nobody's session.
  EXPECT_TRUE(eventually([&] {
    hostile.send(Heartbeat{});
    server.receive(1, test_welcome(), kNow_s);
    return server.refused().unknown_session > 0;
  }));
  EXPECT_TRUE(beat(server, good));
}

TEST(ServerSocket, ReplayedBytesAreDropped) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  const Bytes recorded = encode(ClientMessage{client.session(), 1, Command{1, ServerCommand::kStart}});
  client.send(recorded);
  ASSERT_TRUE(serve(server));
  client.send(recorded);
  client.send(recorded);
  client.send(client.session(), 0, Heartbeat{});
  client.send(client.session(), 2, Heartbeat{});
  const auto received = serve(server);
  ASSERT_TRUE(received);
  EXPECT_TRUE(std::holds_alternative<Heartbeat>(received->body));
  EXPECT_EQ(server.refused().replayed, 3u);
}

TEST(ServerSocket, BytesOfAnOlderSessionAreDropped) {
  ServerSocket server = bound();
  RawClient victim(server.bound_url());
  join(server, victim);
  const Bytes recorded = encode(ClientMessage{victim.session(), 1, Command{1, ServerCommand::kStart}});
  beat(server, victim);
  victim.hello();
  ASSERT_TRUE(serve(server));
  victim.next<Pong>();
  victim.next<Welcome>();
  victim.send(recorded);
  ASSERT_TRUE(beat(server, victim));
  EXPECT_EQ(server.refused().unknown_session, 1u);
}

TEST(ServerSocket, ForeignConnectionCannotUseAnothersSession) {
  ServerSocket server = bound();
  RawClient victim(server.bound_url()), thief(server.bound_url()), stranger(server.bound_url());
  join(server, victim);
  join(server, thief, false);
  stranger.connect();
  thief.send(victim.session(), 50, Command{1, ServerCommand::kStart});
  ASSERT_TRUE(beat(server, thief));
  stranger.send(victim.session(), 50, Goodbye{});
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.receive(1, test_welcome(), kNow_s));
    return server.refused().unknown_session == 2;
  }));
  EXPECT_TRUE(beat(server, victim)->has_control);
}

TEST(ServerSocket, RefusesExcessWatchersUntilOneIsSilent) {
  ServerSocket server = bound();
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < kMostWatchers; ++i) {
    clients.push_back(std::make_unique<RawClient>(server.bound_url()));
    join(server, *clients.back(), false);
  }
  RawClient late(server.bound_url());
  late.connect();
  late.hello("late", false);
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.receive(1, test_welcome(), kNow_s));
    return server.refused().unknown_session == 1;
  }));
  const auto refusal = late.next<Refusal>();
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->text.find("too many"), std::string::npos) << refusal->text;
  late.hello("late", false);
  ASSERT_TRUE(serve(server, kLongAfter_s));
  EXPECT_TRUE(late.next<Welcome>());
}

TEST(ServerSocket, WatchersNeverBlockAController) {
  ServerSocket server = bound();
  std::vector<std::unique_ptr<RawClient>> watchers;
  for (std::size_t i = 0; i < kMostWatchers; ++i) {
    watchers.push_back(std::make_unique<RawClient>(server.bound_url()));
    join(server, *watchers.back(), false);
  }
  RawClient controller(server.bound_url());
  join(server, controller);
  EXPECT_TRUE(beat(server, controller)->has_control);
}

TEST(ServerSocket, ReplyNamesTheInvalidNumberOfACommand) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  LoadScene scene;
  scene.needle_bevel_share = 2.0;
  client.send(Command{41, scene});
  client.send(Command{42, static_cast<ServerCommand>(200)});
  ASSERT_TRUE(beat(server, client));
  for (const auto& [request, word] : {std::pair(41u, "needle_bevel_share"), std::pair(42u, "command")}) {
    const auto reply = client.next<Reply>();
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->request, request);
    EXPECT_FALSE(reply->is_done);
    EXPECT_NE(reply->text.find(word), std::string::npos) << reply->text;
  }
}

TEST(ServerSocket, RefusesAnotherVersionWithAReason) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  client.connect();
  Bytes hello = encode(ClientMessage{0, 0, Hello{}});
  set_version(hello, kLinkVersion + 1);
  client.send(hello);
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.receive(1, test_welcome(), kNow_s));
    return server.refused().malformed == 1;
  }));
  const auto refusal = client.next<Refusal>();
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->text.find("version"), std::string::npos) << refusal->text;
}

TEST(ServerSocket, LongNameInHelloIsRefused) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  client.connect();
  client.hello(std::string(kMostNameBytes + 1, 'n'));
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.receive(1, test_welcome(), kNow_s));
    return server.refused().malformed == 1;
  }));
  client.hello(std::string(kMostNameBytes, 'n'));
  EXPECT_TRUE(serve(server));
}

TEST(ServerSocket, BoundsTheNumberOfConnections) {
  ServerSocket server = bound();
  // Each round: many connections, whose clients say Hello and are silent afterwards.
  double now_s = kNow_s;
  const auto receive = [&] {
    now_s += 0.005;
    return server.receive(1, test_welcome(), now_s);
  };
  for (int round = 0; round < 4; ++round, now_s += 2.0 * kControlLost_s) {
    std::vector<std::unique_ptr<RawClient>> many;
    for (int i = 0; i < 40; ++i) {
      many.push_back(std::make_unique<RawClient>(server.bound_url()));
      many.back()->connect();
      many.back()->hello("many", i % 2 == 0);
    }
    for (int i = 0; i < 500; ++i) receive();
    EXPECT_LE(server.connections(), kMostUnauthenticated + kMostControllers + kMostWatchers);
    EXPECT_GT(server.connections(), 0u);
  }
  RawClient good(server.bound_url());
  good.connect();
  good.hello();
  EXPECT_TRUE(eventually([&] {
    const auto received = receive();
    const auto* hello = received ? std::get_if<Hello>(&received->body) : nullptr;
    return hello != nullptr && hello->client == "raw";
  }));
}

TEST(ServerSocket, SilentPeersAreForgotten) {
  ServerSocket server = bound();
  RawClient client(server.bound_url());
  join(server, client);
  server.drop_lost(kNow_s);
  EXPECT_TRUE(server.controller_heard_s());
  server.drop_lost(kLongAfter_s);
  EXPECT_FALSE(server.controller_heard_s());
  client.send(Heartbeat{});
  EXPECT_TRUE(eventually([&] {
    EXPECT_FALSE(server.receive(1, test_welcome(), kLongAfter_s));
    return server.refused().unknown_session == 1;
  }));
}

}  // namespace
}  // namespace trocar::link
