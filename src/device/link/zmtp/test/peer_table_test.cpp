#include "link/zmtp/detail/peer_table.h"

#include <gtest/gtest.h>

namespace trocar::link::detail {
namespace {

constexpr double kJoined_s = 10.0;
const Hello kWatcher{"a watcher", false};
const Hello kDriver{"a driver", true};

/// A peer that was offered control when it came.
Peer& joined(PeerTable& peers, const char* id, std::uint64_t session, const Hello& hello, double now_s = kJoined_s) {
  Peer* peer = peers.greet(id, hello, session, now_s);
  EXPECT_NE(peer, nullptr);
  peers.offer_control(*peer, now_s);
  return *peer;
}

TEST(PeerTable, RequiresRisingSequencesButAllowsGaps) {
  PeerTable peers(2, 2);
  Peer& peer = joined(peers, "a", 7, kDriver);
  EXPECT_EQ(PeerTable::judge(peer, 7, 0, kJoined_s), Verdict::kReplayed);
  EXPECT_EQ(PeerTable::judge(peer, 7, 1, kJoined_s), Verdict::kGood);
  EXPECT_EQ(PeerTable::judge(peer, 7, 1, kJoined_s), Verdict::kReplayed);
  EXPECT_EQ(PeerTable::judge(peer, 7, 5, kJoined_s), Verdict::kGood);
  EXPECT_EQ(PeerTable::judge(peer, 7, 4, kJoined_s), Verdict::kReplayed);
  EXPECT_EQ(PeerTable::judge(peer, 8, 6, kJoined_s), Verdict::kUnknownSession);
}

TEST(PeerTable, OnlyAValidMessageRefreshesAPeer) {
  PeerTable peers(2, 2);
  Peer& peer = joined(peers, "a", 7, kDriver);
  PeerTable::judge(peer, 8, 1, kJoined_s + 1.0);
  PeerTable::judge(peer, 7, 0, kJoined_s + 1.0);
  EXPECT_EQ(peer.heard_s, kJoined_s);
  PeerTable::judge(peer, 7, 1, kJoined_s + 1.0);
  EXPECT_EQ(peer.heard_s, kJoined_s + 1.0);
}

TEST(PeerTable, PassesControlOnlyAfterTheFullTimeout) {
  PeerTable peers(2, 2);
  joined(peers, "a", 1, kDriver);
  joined(peers, "b", 2, kDriver);
  peers.offer_control(*peers.find("b"), kJoined_s + kControlLost_s);
  EXPECT_TRUE(peers.has_control(*peers.find("a")));
  peers.offer_control(*peers.find("b"), kJoined_s + kControlLost_s + 0.001);
  EXPECT_TRUE(peers.has_control(*peers.find("b")));
}

TEST(PeerTable, SilentControllerKeepsControlWithoutAClaimant) {
  PeerTable peers(2, 2);
  joined(peers, "a", 1, kDriver);
  joined(peers, "b", 2, kWatcher);
  peers.offer_control(*peers.find("b"), kJoined_s + 2.0 * kControlLost_s);
  EXPECT_TRUE(peers.has_control(*peers.find("a")));
}

TEST(PeerTable, NewSessionKeepsControlUnlessItDeclines) {
  PeerTable peers(2, 2);
  Peer& peer = joined(peers, "a", 1, kDriver);
  PeerTable::judge(peer, 1, 1, kJoined_s);
  EXPECT_EQ(peers.greet("a", kDriver, 2, kJoined_s)->session, 2u);
  EXPECT_TRUE(peers.has_control(*peers.find("a")));
  EXPECT_EQ(peers.find_session(1), nullptr);
  PeerTable::judge(*peers.find("a"), 2, 1, kJoined_s);
  peers.greet("a", kWatcher, 3, kJoined_s);
  EXPECT_EQ(peers.controller(), nullptr);
}

TEST(PeerTable, HelloOfAnUnusedSessionIsARepetition) {
  PeerTable peers(2, 2);
  EXPECT_EQ(peers.greet("a", kDriver, 1, kJoined_s)->session, 1u);
  EXPECT_EQ(peers.greet("a", kDriver, 2, kJoined_s)->session, 1u);
  EXPECT_EQ(peers.all().size(), 1u);
}

TEST(PeerTable, FullTableReplacesASilentPeer) {
  PeerTable peers(2, 2);
  joined(peers, "a", 1, kDriver);
  joined(peers, "b", 2, kDriver, kJoined_s + 1.0);
  EXPECT_EQ(peers.greet("c", kDriver, 3, kJoined_s + kControlLost_s), nullptr);
  EXPECT_NE(peers.greet("c", kDriver, 3, kJoined_s + kControlLost_s + 0.5), nullptr);
  EXPECT_EQ(peers.find("a"), nullptr);
  EXPECT_NE(peers.find("b"), nullptr);
}

TEST(PeerTable, ForgettingTheControllerFreesControl) {
  PeerTable peers(2, 2);
  joined(peers, "a", 1, kDriver);
  peers.forget_lost(kJoined_s + 5.0, 5.0);
  EXPECT_NE(peers.controller(), nullptr);
  peers.forget_lost(kJoined_s + 5.1, 5.0);
  EXPECT_EQ(peers.controller(), nullptr);
  EXPECT_TRUE(peers.has_control(joined(peers, "b", 2, kDriver)));
  peers.forget(2);
  EXPECT_EQ(peers.controller(), nullptr);
}

TEST(PeerTable, ChangingRoleDoesNotBypassAFullTable) {
  PeerTable table(1, 1);
  ASSERT_NE(table.greet("controller", {"", true}, 1, 0.0), nullptr);
  ASSERT_NE(table.greet("watcher", {"", false}, 2, 0.0), nullptr);
  EXPECT_EQ(table.greet("watcher", {"", true}, 3, 0.0), nullptr);
  EXPECT_NE(table.greet("controller", {"", true}, 4, 0.0), nullptr);
}

}  // namespace
}  // namespace trocar::link::detail
