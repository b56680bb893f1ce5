#include "ui_kit/frame_count.h"

#include <gtest/gtest.h>

namespace trocar::trainer {
namespace {

/// Frames of 16 ms for a time.
void draw(FrameCount& count, double& now_s, double for_s, bool is_judged) {
  for (const double end_s = now_s + for_s; now_s < end_s; now_s += 0.016) count.add(now_s, is_judged);
}

TEST(FrameCount, ReportsMeanSlowestAndLateFrames) {
  FrameCount count;
  double now_s = 5.0;
  draw(count, now_s, 2.0, true);
  now_s += 0.15;  // a stall
  draw(count, now_s, 0.7, true);
  const auto figures = count.figures();
  ASSERT_TRUE(figures);
  EXPECT_GT(figures->per_s, 45.0) << "a mean that looks well";
  EXPECT_NEAR(figures->slowest_ms, 166.0, 1.0);
  EXPECT_EQ(figures->late, 1U);
  EXPECT_NEAR(static_cast<double>(figures->judged), 2.7 / 0.016, 3.0);
  draw(count, now_s, 2.0, true);
  EXPECT_NEAR(count.figures()->slowest_ms, 16.0, 0.1);
  EXPECT_EQ(count.figures()->late, 1U) << "of the whole attempt";
}

TEST(FrameCount, CountsLateFramesPerAttempt) {
  FrameCount count;
  double now_s = 0.0;
  EXPECT_FALSE(count.figures());
  EXPECT_EQ(count.since_last_s(3.0), 0.0);
  draw(count, now_s, 1.0, false);
  now_s += 0.5;
  draw(count, now_s, 1.0, false);
  EXPECT_EQ(count.late(), 0U) << "no attempt was running";
  now_s += 0.5;
  draw(count, now_s, 1.0, true);
  EXPECT_EQ(count.late(), 1U);
  count.restart();
  EXPECT_EQ(count.figures()->late, 0U);
}

}  // namespace
}  // namespace trocar::trainer
