#include <gtest/gtest.h>

#include "server/detail/shared.h"

namespace trocar::server {
namespace {

/// A period of the real-time thread in two halves, so that a test can put the control thread's steps between them.
class Period {
 public:
  explicit Period(DeviceLease& lease) : lease_(lease), seen_(lease.look()) {}
  /// true: the device is used in this period.
  bool end() {
    if (seen_.is_open) lease_.grant(seen_);
    return !seen_.is_open;
  }

 private:
  DeviceLease& lease_;
  DeviceLease::Request seen_;
};

TEST(DeviceLease, IsGrantedAfterAPeriodSawTheRequest) {
  DeviceLease lease;
  EXPECT_TRUE(Period(lease).end());
  const auto ticket = lease.ask();
  EXPECT_FALSE(lease.is_leased(ticket));
  EXPECT_FALSE(Period(lease).end());
  EXPECT_TRUE(lease.is_leased(ticket));
  EXPECT_FALSE(Period(lease).end()) << "as long as it is leased";
  lease.give_back(ticket);
  EXPECT_TRUE(Period(lease).end());
}

/// Two requests between two periods: with one flag a side the second saw the answer to the first.
TEST(DeviceLease, AnswerAppliesOnlyToItsOwnRequest) {
  DeviceLease lease;
  const auto first = lease.ask();
  Period(lease).end();
  ASSERT_TRUE(lease.is_leased(first));
  lease.give_back(first);
  Period between(lease);  // has seen that the device is its own again, and is about to use it
  const auto second = lease.ask();
  EXPECT_FALSE(lease.is_leased(second)) << "the real-time thread uses the device in this very period";
  EXPECT_TRUE(between.end());
  EXPECT_FALSE(lease.is_leased(second));
  EXPECT_FALSE(Period(lease).end());
  EXPECT_TRUE(lease.is_leased(second));
}

TEST(DeviceLease, LateAnswerToACancelledRequestGrantsNothing) {
  DeviceLease lease;
  const auto given_up = lease.ask();
  Period late(lease);
  lease.give_back(given_up);
  const auto next = lease.ask();
  EXPECT_FALSE(late.end());
  EXPECT_FALSE(lease.is_leased(next));
}

}  // namespace
}  // namespace trocar::server
