#include "ultrasound/scanner/cine_loop.h"

#include <gtest/gtest.h>

#include "core/testing/allocation_guard.h"

namespace trocar::ultrasound {
namespace {

ScanGeometry cine_scan() {
  ScanGeometry scan;
  scan.lines = 4;
  scan.samples = 8;
  return scan;
}

/// Frame n has levels n, lies at x = n mm and was taken at n / 10 s.
void push_frame(CineLoop& loop, int n) {
  const std::vector<std::uint8_t> levels(32, static_cast<std::uint8_t>(n));
  DisplaySettings settings;
  settings.gain_db = n;
  loop.push(levels, Pose::translation({static_cast<double>(n), 0.0, 0.0}), 0.1 * n, settings);
}

CineLoop filled(int capacity, int frames) {
  CineLoop loop(cine_scan(), capacity);
  for (int n = 0; n < frames; ++n) push_frame(loop, n);
  return loop;
}

TEST(CineLoop, KeepsTheLastFramesInOrder) {
  const CineLoop loop = filled(5, 13);
  ASSERT_EQ(loop.size(), 5);
  for (int i = 0; i < 5; ++i) {
    const CineFrame frame = loop.frame(i);
    EXPECT_EQ(frame.levels[31], 8 + i);
    EXPECT_DOUBLE_EQ(frame.time_s, 0.1 * (8 + i));
    EXPECT_EQ(frame.settings.gain_db, 8.0 + i);
    EXPECT_EQ(frame.X_PT.p().x(), 8.0 + i);
  }
  EXPECT_EQ(loop.position(), 4);
}

TEST(CineLoop, NothingIsAddedWhileFrozen) {
  CineLoop loop = filled(5, 7);
  loop.freeze();
  push_frame(loop, 50);
  EXPECT_EQ(loop.frame(4).levels[0], 6);
  loop.thaw();
  push_frame(loop, 51);
  EXPECT_EQ(loop.frame(4).levels[0], 51);
}

TEST(CineLoop, AnEmptyLoopCannotBeFrozen) {
  CineLoop loop(cine_scan(), 3);
  loop.freeze();
  loop.step(1);
  loop.play(1.0);
  EXPECT_FALSE(loop.is_frozen());
  EXPECT_EQ(loop.position(), -1);
}

TEST(CineLoop, StepsStayWithinTheRange) {
  CineLoop loop = filled(8, 8);
  loop.freeze();
  EXPECT_EQ(loop.position(), 7);
  loop.step(-3);
  EXPECT_EQ(loop.position(), 4);
  loop.set_range(2, 5);
  EXPECT_EQ(loop.position(), 4);
  loop.step(2147483647);
  EXPECT_EQ(loop.position(), 5);
  loop.step(-2147483647);
  EXPECT_EQ(loop.position(), 2);
  loop.set_range(-9, 99);
  EXPECT_EQ(loop.first(), 0);
  EXPECT_EQ(loop.last(), 7);
  loop.set_range(6, 3);
  EXPECT_EQ(loop.first(), 6);
  EXPECT_EQ(loop.last(), 6);
  EXPECT_EQ(loop.position(), 6);
}

TEST(CineLoop, PlaysAtTheRecordedRateAndLoops) {
  CineLoop loop = filled(8, 8);
  loop.freeze();
  loop.set_range(2, 5);  // 0.1 s apart: a round is 0.4 s
  loop.step(-99);
  std::vector<int> shown;
  for (int i = 0; i < 10; ++i) {
    shown.push_back(loop.position());
    loop.play(0.0501);  // a little over half a frame, so that rounding does not matter
  }
  EXPECT_EQ(shown, (std::vector<int>{2, 2, 3, 3, 4, 4, 5, 5, 2, 2}));
  loop.play(0.4 * 1000.0);  // whole rounds
  EXPECT_EQ(loop.position(), 3);
}

TEST(CineLoop, PushNeverAllocates) {
  CineLoop loop = filled(3, 2);
  const std::vector<std::uint8_t> levels(32, 1);
  const testing::AllocationGuard guard;
  for (int i = 0; i < 10; ++i) loop.push(levels, Pose(), 10.0 + i, DisplaySettings{});
  loop.freeze();
  loop.play(0.5);
  EXPECT_EQ(loop.frame(loop.position()).levels.size(), 32U);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace trocar::ultrasound
