#include "core/live/live_schedule.h"

#include <gtest/gtest.h>

#include "core/live/test/live_test_traits.h"

namespace trocar {
namespace {

using testing::TestLevel;
using Schedule = LiveSchedule<testing::TestTraits>;
using Request = testing::TestTraits::Request;

/// A machine that needs `ms_per_work`, with a client that requests 60 times a second.
struct Machine {
  Schedule schedule;
  double ms_per_work = 5.0;
  double now_s = 10.0;
  int place = 0;
  int frames = 0;
  TestLevel last = TestLevel::kCoarse;

  void run(double seconds, bool is_moving) {
    for (const double end_s = now_s + seconds; now_s < end_s;) {
      if (is_moving) ++place;
      const double begun_s = now_s;
      const auto level = schedule.due({place}, now_s);
      now_s += 1.0 / 60.0;
      if (!level) continue;
      ++frames;
      last = *level;
      const double took_ms = ms_per_work * testing::TestTraits().work({place}, *level);
      schedule.note_frame({place}, *level, begun_s, took_ms);
      now_s = std::max(now_s, begun_s + 1e-3 * took_ms);
    }
  }
};

TEST(LiveSchedule, DetailFollowsTheCostWhileRequestsChange) {
  Machine machine;
  machine.run(1.0, true);
  EXPECT_EQ(machine.last, TestLevel::kFine);
  machine.ms_per_work = 18.0;
  machine.run(1.0, true);
  EXPECT_EQ(machine.last, TestLevel::kMiddle);
  machine.ms_per_work = 40.0;
  machine.run(1.0, true);
  EXPECT_EQ(machine.last, TestLevel::kCoarse);
  machine.ms_per_work = 5.0;
  machine.run(2.0, true);
  EXPECT_EQ(machine.last, TestLevel::kFine);
}

TEST(LiveSchedule, UsesFullDetailWhenRequestsStayEqual) {
  Machine machine;
  machine.ms_per_work = 40.0;
  machine.run(1.0, true);
  EXPECT_EQ(machine.last, TestLevel::kCoarse);
  machine.run(0.5, false);
  EXPECT_EQ(machine.last, TestLevel::kFine);
}

TEST(LiveSchedule, RefreshesWithinTheBusyShare) {
  Machine machine;
  machine.run(1.0, false);
  machine.frames = 0;
  machine.run(10.0, false);
  EXPECT_NEAR(machine.frames, 90, 11) << "each 0.1 s, at the client's next request";
  machine.ms_per_work = 100.0;  // full detail: 0.4 s
  machine.run(1.0, false);
  machine.frames = 0;
  machine.run(10.0, false);
  EXPECT_NEAR(machine.frames, 12, 2) << "half of the time";
}

TEST(LiveSchedule, RestartMakesTheNextRequestDueAndKeepsCosts) {
  Machine machine;
  machine.run(1.0, true);
  EXPECT_FALSE(machine.schedule.due({machine.place}, machine.now_s));
  machine.schedule.restart();
  EXPECT_EQ(machine.schedule.due({machine.place}, machine.now_s), TestLevel::kFine);
}

}  // namespace
}  // namespace trocar
