// First-pass success and time to the target in the box patient of the tasks' tests: its lesion is 50 to 70 mm deep.
#include <gtest/gtest.h>

#include "metrics/testing/recording.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using namespace testing;

struct Box {
  anatomy::VirtualPatient patient = make_box_patient();
  tasks::Task task = make_box_task();

  MetricContext context() const {
    MetricContext context;
    context.task = &task;
    context.patient = &patient;
    return context;
  }
};
const Box& box() {
  static const Box one;
  return one;
}

/// Depth along straight pieces between (time, depth) corners, at (50, 50).
Recording depths(const std::vector<std::pair<double, double>>& corners, double rate_hz = 500.0, double x_mm = 50.0) {
  return record(corners.back().first, rate_hz, [&](double t, Moment& m) {
    std::size_t n = 1;
    while (n + 1 < corners.size() && corners[n].first < t) ++n;
    const auto [from_s, from_mm] = corners[n - 1];
    const auto [to_s, to_mm] = corners[n];
    set_depth(m, from_mm + (to_mm - from_mm) * (t - from_s) / (to_s - from_s));
    m.tip_P += Vec3(x_mm, 0.0, 50.0);
  });
}

TEST(FirstPassMetrics, OneStraightPassSucceeds) {
  const auto values = measure(depths({{0.0, -5.0}, {7.0, 65.0}}), box().context());  // 10 mm/s, at the skin at 0.5 s
  EXPECT_EQ(value_of(values, "first_pass_success"), 1.0);
  EXPECT_TRUE(find(values, "first_pass_success").note.empty());
  EXPECT_NEAR(value_of(values, "time_to_target"), 5.0, 0.1);
  EXPECT_NEAR(*find(values, "time_to_target").at_s, 5.5, 0.1);
}

TEST(FirstPassMetrics, UnpiercedWallIsNotTheTarget) {
  Recording pressing =
      depths({{0.0, -5.0}, {5.504, 50.04}, {6.0, 53.0}});  // in the lesion's first voxels before it loads
  for (Moment& moment : pressing) {
    if (moment.time_s <= 5.504) continue;
    moment.phase = telemetry::InsertionPhase::kLoading;
    moment.pressed_mm = *moment.depth_mm - 50.0;
  }
  EXPECT_EQ(measure_one("first_pass_success", pressing, box().context()), 0.0);
}

TEST(FirstPassMetrics, SmallCorrectionIsNotANewPass) {
  EXPECT_EQ(
      measure_one("first_pass_success", depths({{0.0, -5.0}, {4.0, 40.0}, {5.0, 31.0}, {8.0, 60.0}}), box().context()),
      1.0);
}

TEST(FirstPassMetrics, WithdrawalOrSecondPunctureFails) {
  auto values = measure(depths({{0.0, -5.0}, {4.0, 40.0}, {5.0, 29.0}, {8.0, 60.0}}), box().context());
  EXPECT_EQ(value_of(values, "first_pass_success"), 0.0);
  EXPECT_EQ(find(values, "first_pass_success").note, "the needle was withdrawn before");
  EXPECT_NEAR(value_of(values, "time_to_target"), 7.0 - 0.45, 0.2);
  values = measure(depths({{0.0, -5.0}, {1.0, 8.0}, {2.0, -5.0}, {3.0, -5.0}, {9.0, 60.0}}), box().context());
  EXPECT_EQ(value_of(values, "first_pass_success"), 0.0);
  EXPECT_EQ(find(values, "first_pass_success").note, "the skin was pierced again before");
}

TEST(FirstPassMetrics, IgnoresMotionAfterTheTarget) {
  const auto values =
      measure(depths({{0.0, -5.0}, {6.0, 60.0}, {9.0, -5.0}, {10.0, -5.0}, {12.0, 30.0}}), box().context());
  EXPECT_EQ(value_of(values, "first_pass_success"), 1.0);
}

TEST(FirstPassMetrics, MissedTargetHasNoSuccessAndNoTime) {
  const auto values = measure(depths({{0.0, -5.0}, {6.0, 60.0}}, 500.0, 75.0), box().context());
  EXPECT_EQ(value_of(values, "first_pass_success"), 0.0);
  EXPECT_EQ(missing_of("time_to_target", depths({{0.0, -5.0}, {6.0, 60.0}}, 500.0, 75.0), box().context()),
            "the target was not reached");
}

TEST(FirstPassMetrics, AttemptOutsideTheBodyHasNoValues) {
  EXPECT_EQ(missing_of("first_pass_success", depths({{0.0, -5.0}, {1.0, -1.0}}), box().context()),
            "the needle was never in the body");
}

TEST(FirstPassMetrics, InterruptionsAreNotCounted) {
  Recording recording = depths({{0.0, -5.0}, {7.0, 65.0}});
  for (std::size_t n = 1000; n < recording.size(); ++n) recording[n].time_s += 100.0;
  recording[1000].is_paused = true;
  EXPECT_NEAR(measure_one("time_to_target", recording, box().context()), 5.0, 0.1);
}

TEST(FirstPassMetrics, SlowRecordingDoesNotSkipTheTarget) {
  // Two moments a second: 35 mm apart, before and behind the lesion.
  EXPECT_EQ(measure_one("first_pass_success", depths({{0.0, -5.0}, {0.5, 1.5}, {1.0, 42.0}, {1.5, 77.0}}, 2.0),
                        box().context()),
            1.0);
}

TEST(FirstPassMetrics, IndentedSkinIsContactButNoPuncture) {
  Recording recording = depths({{0.0, -5.0}, {7.0, 65.0}});
  for (Moment& m : recording)
    if (*m.depth_mm > 0.0 && *m.depth_mm < 6.0) m.phase = telemetry::InsertionPhase::kLoading;
  EXPECT_EQ(measure_one("first_pass_success", recording, box().context()), 1.0);
  EXPECT_NEAR(measure_one("time_to_target", recording, box().context()), 5.0, 0.1);
  for (Moment& m : recording) m.phase = telemetry::InsertionPhase::kLoading;
  EXPECT_EQ(missing_of("first_pass_success", recording, box().context()), "the needle was never in the body");
}

TEST(FirstPassMetrics, UsesTheExpertPathEndWithoutAPatient) {
  MetricContext context = with_paths({{"plan", {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 50.0, 0.0)}}});
  context.task = &box().task;
  const auto recording = record(7.0, 500.0, [](double t, Moment& m) { set_depth(m, 10.0 * t - 5.0); });
  EXPECT_EQ(measure_one("first_pass_success", recording, context), 1.0);
  EXPECT_NEAR(measure_one("time_to_target", recording, context), 5.0 - 0.1 * box().task.target_tolerance_mm, 0.1);
  context.expert_paths.clear();
  EXPECT_EQ(missing_of("first_pass_success", recording, context), "no patient and no expert path was given");
  context.task = nullptr;
  EXPECT_EQ(missing_of("first_pass_success", recording, context), "no task was given");
}

TEST(FirstPassMetrics, BiopsyReachesTheTargetWithItsNotch) {
  MetricContext context = box().context();
  context.needle = make_gun();  // the notch's middle is 9.5 mm beyond the tip
  EXPECT_NEAR(measure_one("time_to_target", depths({{0.0, -5.0}, {7.0, 65.0}}), context), 4.05, 0.1);
}

}  // namespace
}  // namespace trocar::metrics
