#include "scene/detail_policy.h"

#include <gtest/gtest.h>

namespace trocar::scene {
namespace {

using std::chrono::milliseconds;
using Time = DetailPolicy::Time;

constexpr Time kStart{std::chrono::hours(1)};

/// Draws moving frames that cost what `cost_ms` says of their detail; returns the time after the last one.
template <class Cost>
Time play(DetailPolicy& policy, Time now, int frames, const Cost& cost_ms) {
  for (int i = 0; i < frames; ++i) {
    policy.note_motion(now);
    const Detail detail = policy.next(now);
    const double ms = cost_ms(detail);
    now += milliseconds(static_cast<int>(ms) + 1);
    policy.note_frame(detail, ms, now);
  }
  return now;
}

TEST(DetailPolicy, DrawsFullDetailWithAGraphicsCard) {
  DetailPolicy policy(true);
  const Time now = play(policy, kStart, 50, [](const Detail&) { return 200.0; });
  EXPECT_EQ(policy.next(now), DetailPolicy::full());
}

TEST(DetailPolicy, StartsAtFullDetail) {
  EXPECT_EQ(DetailPolicy(false).next(kStart), DetailPolicy::full());
}

TEST(DetailPolicy, ReducesDetailDuringMotion) {
  DetailPolicy policy(false);
  policy.note_motion(kStart);
  EXPECT_FALSE(policy.next(kStart).is_peeled);
  EXPECT_FALSE(policy.next(kStart + milliseconds(299)).is_peeled);
  EXPECT_EQ(policy.next(kStart + milliseconds(300)), DetailPolicy::full());
}

TEST(DetailPolicy, LowersDetailUntilFramesMeetTheTarget) {
  DetailPolicy policy(false);
  const auto cost = [](const Detail& detail) { return detail.mesh_level < 2 ? 90.0 : 30.0; };
  const Time now = play(policy, kStart, 10, cost);
  EXPECT_EQ(policy.next(now).mesh_level, 2);
  EXPECT_EQ(policy.next(now).resolution, 1.0);
}

TEST(DetailPolicy, IgnoresOneSlowFrame) {
  DetailPolicy policy(false);
  const int level = policy.moving_level();
  policy.note_motion(kStart);
  policy.note_frame(policy.next(kStart), 60.0, kStart);
  EXPECT_EQ(policy.moving_level(), level);
  policy.note_frame(policy.next(kStart), 60.0, kStart);
  EXPECT_EQ(policy.moving_level(), level + 1);
}

TEST(DetailPolicy, NeverLeavesItsLevels) {
  DetailPolicy policy(false);
  Time now = play(policy, kStart, 200, [](const Detail&) { return 500.0; });
  EXPECT_EQ(policy.moving_level(), DetailPolicy::kMovingLevels - 1);
  now = play(policy, now + std::chrono::minutes(1), 20'000, [](const Detail&) { return 1.0; });
  EXPECT_EQ(policy.moving_level(), 0);
}

TEST(DetailPolicy, RaisesDetailWithoutOscillating) {
  DetailPolicy policy(false);
  // The finest level is too slow for good: it is tried again at most every ten seconds.
  int fine_frames = 0;
  const auto cost = [&](const Detail& detail) {
    const bool is_fine = detail == DetailPolicy::moving(0);
    fine_frames += is_fine ? 1 : 0;
    return is_fine ? 120.0 : 15.0;
  };
  play(policy, kStart, 1000, cost);  // 16 s
  EXPECT_GE(fine_frames, 1);
  EXPECT_LE(fine_frames, 3);
}

TEST(DetailPolicy, IgnoresFullDetailFramesForTheMovingLevel) {
  DetailPolicy policy(false);
  const int level = policy.moving_level();
  for (int i = 0; i < 10; ++i) policy.note_frame(DetailPolicy::full(), 900.0, kStart);
  EXPECT_EQ(policy.moving_level(), level);
}

}  // namespace
}  // namespace trocar::scene
