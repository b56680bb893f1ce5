#include <gtest/gtest.h>

#include "scene/detail_policy.h"

namespace trocar::scene {
namespace {

TEST(FrameTimes, GivesLastMedianAndTail) {
  FrameTimes times;
  EXPECT_EQ(times.p50_ms(), 0.0);
  for (int i = 1; i <= 100; ++i) times.add(i);
  EXPECT_EQ(times.last_ms(), 100.0);
  EXPECT_EQ(times.p50_ms(), 50.0);
  EXPECT_EQ(times.p99_ms(), 99.0);
}

TEST(FrameTimes, ForgetsOldFrames) {
  FrameTimes times;
  times.add(1e6);
  for (std::size_t i = 0; i < FrameTimes::kKept; ++i) times.add(5.0);
  EXPECT_EQ(times.percentile_ms(1.0), 5.0);
  EXPECT_EQ(times.count(), FrameTimes::kKept + 1);
}

}  // namespace
}  // namespace trocar::scene
