#include "core/clock.h"

#include <gtest/gtest.h>

#include "core/testing/fake_clock.h"

namespace trocar {
namespace {

using namespace std::chrono_literals;

TEST(FakeClock, StandsStillUntilItIsAdvanced) {
  testing::FakeClock clock;
  const Clock::TimePoint begin = clock.now();
  EXPECT_EQ(clock.now(), begin);
  clock.sleep_for(250ms);
  EXPECT_EQ(clock.now() - begin, 250ms);
  EXPECT_DOUBLE_EQ(seconds_between(begin, clock.now()), 0.25);
}

TEST(FakeClock, CallsParticipantsEveryStepUntilTheyLeave) {
  testing::FakeClock clock;
  std::vector<Clock::Duration> at;
  const Clock::TimePoint begin = clock.now();
  auto participant = clock.attach([&] { at.push_back(clock.now() - begin); });
  clock.advance(2500us);
  participant.reset();
  clock.advance(1ms);
  EXPECT_EQ(at, (std::vector<Clock::Duration>{1ms, 2ms, 2500us}));
}

TEST(SteadyClock, DoesNotRunBackwards) {
  const SteadyClock clock;
  const Clock::TimePoint first = clock.now();
  EXPECT_GE(clock.now(), first);
}

}  // namespace
}  // namespace trocar
