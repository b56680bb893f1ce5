#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "link/client/haptic_client.h"
#include "link/test/link_fixture.h"

namespace trocar::link {
namespace {

using namespace testing;  // the link's

/// A server that does not read: the client's socket is full, and the stop waits. Commands behind it do not overtake it.
TEST(HapticClient, SendsAStopAheadOfQueuedCommands) {
  RunningServer server(any_endpoint());
  ClientOptions options;
  options.endpoint = server.url();
  auto connected = HapticClient::connect(options);
  ASSERT_TRUE(connected) << connected.error().text();
  HapticClient& client = *connected;
  ASSERT_TRUE(client.wait_connected(kPatience));
  std::uint32_t stop = 0, start = 0;
  std::vector<Reply> replies;
  const auto find_reply = [&](std::uint32_t request) -> std::optional<Reply> {
    for (Reply& reply : client.take_replies()) replies.push_back(std::move(reply));
    const auto found = std::ranges::find(replies, request, &Reply::request);
    return found == replies.end() ? std::optional<Reply>() : *found;
  };
  server.with_socket([&](ServerSocket&) {
    std::uint32_t last = 0;
    do {
      for (int i = 0; i < 500; ++i) last = client.send(ServerCommand::kStyletIn);
      eventually([&] { return find_reply(last) || client.view().silent_s > 1.0; });
    } while (!find_reply(last));  // refused: the socket is full
    stop = client.send(ServerCommand::kStop);
    start = client.send(ServerCommand::kStart);
  });
  ASSERT_TRUE(eventually([&] { return find_reply(stop).has_value(); }));
  EXPECT_TRUE(find_reply(stop)->is_done) << find_reply(stop)->text;
  ASSERT_TRUE(eventually([&] { return find_reply(start).has_value(); }));
  std::vector<ServerCommand> last;
  for (const Command& command : server.received<Command>()) last.push_back(std::get<ServerCommand>(command.what));
  const auto stopped = std::ranges::find(last, ServerCommand::kStop);
  ASSERT_NE(stopped, last.end());
  EXPECT_EQ(std::find(last.begin(), stopped, ServerCommand::kStart), stopped) << "the start has overtaken the stop";
}

}  // namespace
}  // namespace trocar::link
