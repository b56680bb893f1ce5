#include "metrics/attempt_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using namespace testing;

AttemptMetrics measure_in_box(const std::vector<telemetry::TickSample>& samples, std::optional<std::size_t> fired) {
  static const anatomy::VirtualPatient patient = make_box_patient();
  const auto end_s = fired ? std::optional(samples[*fired].time_s) : std::nullopt;
  return measure_against(make_box_plan(), follow_attempt(patient, make_box_tissues(), samples, end_s));
}

TEST(AttemptTrack, APlannedAttemptHasNoDeviations) {
  for (const double dent_mm : {0.6, 4.5}) {  // skin that gives way late is no error of the entry
    const Attempt attempt = make_attempt(make_box_plan().line_P, dent_mm);
    const AttemptMetrics metrics = measure_in_box(attempt.samples, attempt.fired);
    ASSERT_TRUE(metrics.has_entered);
    EXPECT_EQ(metrics.entries, 1);
    EXPECT_LT(metrics.entry_offset_P.norm(), 1e-3) << dent_mm;
    EXPECT_LT(metrics.target_offset_P.norm(), 1e-9);
    EXPECT_LT(metrics.angle_deg, 1e-5);
    EXPECT_NEAR(metrics.travel_mm, 51.0, 1e-9);
    EXPECT_NEAR(metrics.time_s, 51.0 / 20.0, 0.002);
  }
}

TEST(AttemptTrack, OffsetsAreActualMinusPlannedPositions) {
  const double angle = radians(5.0);
  const Vec3 entry_P(53.0, 0.0, 46.0);
  const Attempt attempt = make_attempt({entry_P, entry_P + 40.0 * Vec3(std::sin(angle), std::cos(angle), 0.0)});
  const AttemptMetrics metrics = measure_in_box(attempt.samples, attempt.fired);
  EXPECT_LT((metrics.entry_offset_P - Vec3(3.0, 0.0, -4.0)).norm(), 1e-3);
  EXPECT_NEAR(metrics.angle_deg, 5.0, 1e-6);
  EXPECT_LT((metrics.target_offset_P - Vec3(3.0 + 40.0 * std::sin(angle), 40.0 * std::cos(angle) - 51.0, -4.0)).norm(),
            1e-6);
}

TEST(AttemptTrack, CountsPullingBackButNotTremorAsTravel) {
  std::vector<telemetry::TickSample> samples = make_attempt({{50.0, 0.0, 50.0}, {50.0, 40.0, 50.0}}).samples;
  samples.resize(45 * 50);  // up to a depth of 40 mm
  const auto add = [&](double depth_mm) {
    telemetry::TickSample sample = samples.back();
    sample.time_s += 0.001;
    sample.depth_mm = depth_mm;
    sample.tip_mm.y() = depth_mm;
    samples.push_back(sample);
  };
  for (int i = 0; i < 5000; ++i) add(40.0 - 0.4 + 0.4 * std::cos(0.1 * i));
  EXPECT_NEAR(measure_in_box(samples, {}).travel_mm, 40.0, 0.1);
  for (double depth_mm = 40.0; depth_mm > 25.0; depth_mm -= 0.05) add(depth_mm);
  for (double depth_mm = 25.0; depth_mm < 45.0; depth_mm += 0.05) add(depth_mm);
  EXPECT_NEAR(measure_in_box(samples, {}).travel_mm, 40.0 + 20.0, 0.2);
}

TEST(AttemptTrack, UsesDepthForEntryWithoutPunctureEvents) {
  Attempt attempt = make_attempt(make_box_plan().line_P);
  for (telemetry::TickSample& sample : attempt.samples) sample.events = {};
  const AttemptMetrics metrics = measure_in_box(attempt.samples, attempt.fired);
  EXPECT_TRUE(metrics.has_entered);
  EXPECT_EQ(metrics.entries, 1);
  EXPECT_LT(metrics.entry_offset_P.norm(), 1e-3);
}

TEST(AttemptTrack, FindsTheEntryOfARecordingWithFewMoments) {
  const anatomy::VirtualPatient patient = make_box_patient();
  AttemptTrack track({&patient, std::uint8_t{0}, {}, {}});
  const auto step = [&](double time_s, const Vec3& tip_P, double depth_mm, bool has_event) {
    Moment moment;
    moment.time_s = time_s;
    moment.tip_P = tip_P;
    moment.axis_P = Vec3::UnitY();
    moment.depth_mm = depth_mm;
    moment.events = telemetry::TickEvents{};
    if (has_event) (*moment.events)[0] = {telemetry::EventKind::kPuncture, 0};
    track.step(moment);
  };
  step(0.0, {20.0, -5.0, 50.0}, 0.0, false);
  step(1.0, {20.0, 10.0, 50.0}, 10.0, true);
  step(2.0, {60.0, -5.0, 50.0}, 0.0, false);
  step(3.0, {60.0, 50.0, 50.0}, 50.0, false);  // deeper than the skin is searched, and its event was lost
  ASSERT_TRUE(track.end() && track.end()->entry);
  EXPECT_EQ(track.end()->entry->moment.time_s, 3.0);
  EXPECT_LT((track.skin_crossing_A(*track.end()->entry) - Vec3(60.0, 0.0, 50.0)).norm(), 1e-9);
}

TEST(AttemptTrack, DistinguishesUntouchedFromUnpiercedSkin) {
  EXPECT_FALSE(measure_in_box({}, {}).has_touched_skin);
  const std::vector<telemetry::TickSample> whole = make_attempt(make_box_plan().line_P).samples;
  const std::vector<telemetry::TickSample> outside(whole.begin(), whole.begin() + 200);
  EXPECT_FALSE(measure_in_box(outside, {}).has_touched_skin);
  const std::vector<telemetry::TickSample> loading(whole.begin(), whole.begin() + 270);
  EXPECT_TRUE(measure_in_box(loading, {}).has_touched_skin);
  EXPECT_FALSE(measure_in_box(loading, {}).has_entered);
}

TEST(AttemptTrack, SkipsNonFiniteSamples) {
  Attempt attempt = make_attempt(make_box_plan().line_P);
  const AttemptMetrics clean = measure_in_box(attempt.samples, attempt.fired);
  for (std::size_t i = 3; i < attempt.samples.size(); i += 7)
    if (i != attempt.fired && attempt.samples[i].events[0].kind == telemetry::EventKind::kNone)
      attempt.samples[i].tip_mm.x() = attempt.samples[i].depth_mm = std::numeric_limits<double>::quiet_NaN();
  const AttemptMetrics metrics = measure_in_box(attempt.samples, attempt.fired);
  EXPECT_EQ(metrics.target_offset_P, clean.target_offset_P);
  EXPECT_NEAR(metrics.travel_mm, clean.travel_mm, 1e-9);
}

}  // namespace
}  // namespace trocar::metrics
