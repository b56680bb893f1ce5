// Clients that read more slowly than the server sends.
#include <gtest/gtest.h>

#include "link/server_socket.h"
#include "link/test/raw_link.h"

namespace trocar::link {
namespace {

using namespace testing;  // the link's

TEST(SlowClient, MissesCountedBatches) {
  ServerSocket server = bound();
  RawClient slow(server.bound_url(), 1), quick(server.bound_url());
  join(server, slow);
  join(server, quick, false);
  // Queues and the system's buffers hold some megabytes; then the slow one takes no more, and the quick one all.
  std::uint64_t sent = 0;
  while (server.batches_not_taken() < 50) {
    ASSERT_LT(sent, 20'000u);
    server.send_batch(test_batch(sent * kMostSamples, kMostSamples));
    const auto batch = next_while_served<StateBatch>(server, quick);
    ASSERT_TRUE(batch);
    ASSERT_EQ(batch->first_tick, sent * kMostSamples);
    ++sent;
  }
  const std::uint64_t taken = sent - server.batches_not_taken();
  std::uint64_t sequence = 0;
  for (std::uint64_t i = 0; i < taken; ++i) {
    std::optional<ServerMessage> message;
    ASSERT_TRUE(eventually([&] {
      EXPECT_FALSE(server.receive(0, test_welcome(), kNow_s));  // it sends what waits
      message = slow.receive(ZMQ_DONTWAIT);
      return message.has_value();
    })) << "batch "
        << i << " of " << taken;
    ASSERT_TRUE(std::holds_alternative<StateBatch>(message->body));
    EXPECT_GT(message->sequence, sequence);
    sequence = message->sequence;
  }
  server.send_batch(test_batch(sent * kMostSamples, 1));
  const auto last = slow.next<StateBatch>();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->first_tick, sent * kMostSamples);
}

/// Sends batches that `slow` does not read until many are dropped.
void fill_queue(ServerSocket& server) {
  const std::uint64_t before = server.batches_not_taken();
  for (std::uint64_t sent = 0; server.batches_not_taken() < before + 50; ++sent) {
    ASSERT_LT(sent, 20'000u);
    server.send_batch(test_batch(sent * kMostSamples, kMostSamples));
  }
}

TEST(SlowClient, GetsEveryReply) {
  ServerSocket server = bound();
  RawClient slow(server.bound_url(), 1);
  join(server, slow);
  ASSERT_NO_FATAL_FAILURE(fill_queue(server));
  slow.send(Command{1, ServerCommand::kStart});
  const auto received = serve(server);
  ASSERT_TRUE(received);
  server.send_reply(received->session, {1, true, "started"});
  server.drop_lost(kNow_s);
  const auto reply = next_while_served<Reply>(server, slow);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->request, 1u);
}

TEST(SlowClient, LosesItsSessionIfItDoesNotReadReplies) {
  ServerSocket server = bound();
  RawClient slow(server.bound_url(), 1);
  join(server, slow);
  ASSERT_NO_FATAL_FAILURE(fill_queue(server));
  // The client's thread may still take what waits in the system's buffers, which are larger than the queue.
  const Reply large{1, true, std::string(kMostTextBytes, 'x')};
  constexpr std::size_t kMostUnread = 64 << 20;
  std::size_t bytes = 0;
  for (; server.controller_heard_s(); bytes += kMostTextBytes) {
    ASSERT_LT(bytes, kMostUnread);
    server.send_reply(slow.session(), large);
    server.drop_lost(kNow_s);
  }
  EXPECT_GE(bytes, kMostReplyBytesOut);
  slow.send(Heartbeat{});
  const auto refusal = next_while_served<Refusal>(server, slow);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->text, "no session: send Hello first");
}

}  // namespace
}  // namespace trocar::link
