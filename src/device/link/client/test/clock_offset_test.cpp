#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "link/client/detail/client_session.h"

namespace trocar::link::detail {
namespace {

TEST(ClockOffset, IsExactForSymmetricDelays) {
  ClockOffset clock;
  EXPECT_FALSE(clock.best());
  EXPECT_TRUE(clock.add(10.0, 110.5, 11.0));
  ASSERT_TRUE(clock.best());
  EXPECT_DOUBLE_EQ(clock.best()->offset_s, 100.0);
  EXPECT_DOUBLE_EQ(clock.best()->round_trip_s, 1.0);
}

TEST(ClockOffset, UsesTheFastestRecentRoundTrip) {
  ClockOffset clock;
  clock.add(0.0, 0.25, 0.5);
  clock.add(1.0, 1.05, 1.1);
  clock.add(2.0, 2.25, 2.5);
  EXPECT_NEAR(clock.best()->round_trip_s, 0.1, 1e-12);
  // Five seconds later the fast one is of the past, and the next best of what is left counts.
  clock.add(6.0, 6.5, 7.0);
  EXPECT_NEAR(clock.best()->round_trip_s, 0.5, 1e-12);
}

TEST(ClockOffset, ErrorIsAtMostHalfTheRoundTrip) {
  constexpr double kOffset_s = -1234.5;
  Random random(1);
  ClockOffset clock;
  double now_s = 0.0;
  for (int i = 0; i < 5000; ++i) {
    now_s += 0.01;
    const double there_s = random.uniform(1e-5, 5e-3), back_s = random.uniform(1e-5, 5e-3);
    ASSERT_TRUE(clock.add(now_s, now_s + there_s + kOffset_s, now_s + there_s + back_s));
    const auto best = clock.best();
    ASSERT_LE(std::abs(best->offset_s - kOffset_s), best->round_trip_s / 2.0 + 1e-9);
    ASSERT_LE(best->round_trip_s, there_s + back_s + 1e-12);
  }
}

TEST(ClockOffset, IgnoresAnAnswerThatPrecedesItsRequest) {
  ClockOffset clock;
  EXPECT_FALSE(clock.add(2.0, 0.0, 1.0));
  EXPECT_FALSE(clock.add(std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0));
  EXPECT_FALSE(clock.best());
}

}  // namespace
}  // namespace trocar::link::detail
