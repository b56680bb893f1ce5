#include "server/detail/device_loan.h"

#include <gtest/gtest.h>

namespace trocar::server {
namespace {

/// A period of the real-time thread in two halves, so that a test can put the control thread's steps between them.
class Period {
 public:
  explicit Period(DeviceLoan& loan) : loan_(loan), seen_(loan.look()) {}
  /// true: the device is used in this period.
  bool end() {
    if (seen_.is_open) loan_.lend(seen_);
    return !seen_.is_open;
  }

 private:
  DeviceLoan& loan_;
  DeviceLoan::Request seen_;
};

TEST(DeviceLoan, LendsAfterAPeriodThatSawTheRequest) {
  DeviceLoan loan;
  EXPECT_TRUE(Period(loan).end());
  const auto ticket = loan.ask();
  EXPECT_FALSE(loan.is_lent(ticket));
  EXPECT_FALSE(Period(loan).end());
  EXPECT_TRUE(loan.is_lent(ticket));
  EXPECT_FALSE(Period(loan).end()) << "as long as it is lent";
  loan.give_back(ticket);
  EXPECT_TRUE(Period(loan).end());
}

/// Two requests between two periods: with one flag a side the second saw the answer to the first.
TEST(DeviceLoan, AnAnswerToAnEarlierRequestIsNoneToALaterOne) {
  DeviceLoan loan;
  const auto first = loan.ask();
  Period(loan).end();
  ASSERT_TRUE(loan.is_lent(first));
  loan.give_back(first);
  Period between(loan);  // has seen that the device is its own again, and is about to use it
  const auto second = loan.ask();
  EXPECT_FALSE(loan.is_lent(second)) << "the real-time thread uses the device in this very period";
  EXPECT_TRUE(between.end());
  EXPECT_FALSE(loan.is_lent(second));
  EXPECT_FALSE(Period(loan).end());
  EXPECT_TRUE(loan.is_lent(second));
}

TEST(DeviceLoan, ALateAnswerToARequestThatWasGivenUpLendsNothing) {
  DeviceLoan loan;
  const auto given_up = loan.ask();
  Period late(loan);
  loan.give_back(given_up);
  const auto next = loan.ask();
  EXPECT_FALSE(late.end());
  EXPECT_FALSE(loan.is_lent(next));
}

}  // namespace
}  // namespace trocar::server
