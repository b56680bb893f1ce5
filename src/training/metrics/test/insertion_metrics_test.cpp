// Punctures, passes, redirections, forces.
#include <gtest/gtest.h>

#include <numbers>

#include "metrics/testing/recording.h"

namespace trocar::metrics {
namespace {

using namespace testing;
using std::numbers::pi;

void add_event(Moment& moment, std::uint8_t layer) {
  moment.events = telemetry::TickEvents{};
  (*moment.events)[0] = {telemetry::EventKind::kPuncture, layer};
}

MetricContext with_layers() {
  MetricContext context;
  context.layer_names = {"skin", "liver_capsule"};
  return context;
}

/// Depth along straight pieces between (time, depth) corners.
Recording polyline(const std::vector<std::pair<double, double>>& corners, double rate_hz = 100.0) {
  return record(corners.back().first, rate_hz, [&](double t, Moment& m) {
    std::size_t n = 1;
    while (n + 1 < corners.size() && corners[n].first < t) ++n;
    const auto [from_s, from_mm] = corners[n - 1];
    const auto [to_s, to_mm] = corners[n];
    set_depth(m, from_mm + (to_mm - from_mm) * (t - from_s) / (to_s - from_s));
  });
}

TEST(InsertionMetrics, VibrationAtTheSkinIsOnePuncture) {
  const Recording recording = record(5.0, 1000.0, [](double t, Moment& m) {
    set_depth(m, t < 1.0 ? -5.0 : t < 3.0 ? 1.5 * std::sin(2.0 * pi * 8.0 * t) : 10.0);
  });
  EXPECT_EQ(measure_one("skin_punctures", recording), 1.0);
}

TEST(InsertionMetrics, VibrationAtALayerIsOnePuncture) {
  Recording recording = polyline({{0.0, -5.0}, {1.0, 30.0}, {3.0, 30.0}, {4.0, 50.0}});
  for (Moment& m : recording) m.events = telemetry::TickEvents{};
  add_event(recording[20], 0);
  for (const std::size_t n : {100U, 120U, 140U, 160U}) add_event(recording[n], 1);
  const auto values = measure(recording, with_layers());
  EXPECT_EQ(value_of(values, "layer_punctures"), 2.0);
  EXPECT_EQ(find(values, "layer_punctures").note, "skin 1, liver_capsule 1");
  EXPECT_EQ(value_of(values, "skin_punctures"), 1.0);
}

TEST(InsertionMetrics, CountsARepuncturedLayerTwice) {
  Recording recording = polyline({{0.0, -5.0}, {1.0, 30.0}, {2.0, 25.0}, {3.0, 30.0}});
  for (Moment& m : recording) m.events = telemetry::TickEvents{};
  add_event(recording[100], 1);
  add_event(recording[300], 1);
  EXPECT_EQ(measure_one("layer_punctures", recording, with_layers()), 2.0);
}

TEST(InsertionMetrics, CountsPassesAndPullBacks) {
  // In to 40, back to 35 (pull-back), in to 50, back to 20 (pull-back, a new pass follows), in to 50, out.
  const Recording recording =
      polyline({{0.0, -5.0}, {2.0, 40.0}, {3.0, 35.0}, {4.0, 50.0}, {6.0, 20.0}, {8.0, 50.0}, {10.0, -5.0}});
  const auto values = measure(recording);
  EXPECT_EQ(value_of(values, "needle_passes"), 2.0);
  EXPECT_EQ(value_of(values, "pull_backs"), 2.0);
  EXPECT_EQ(value_of(values, "skin_punctures"), 1.0);
  EXPECT_NEAR(value_of(values, "inward_travel"), 40.0 + 15.0 + 30.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_in_tissue_raw"), 40.0 + 5.0 + 15.0 + 30.0 + 30.0 + 50.0, 1e-6);
}

TEST(InsertionMetrics, TremorIsNotAPullBack) {
  const Recording recording = record(5.0, 1000.0, [](double t, Moment& m) {
    set_depth(m, std::min(40.0, 20.0 * t) + 0.45 * std::sin(2.0 * pi * 9.0 * t));
  });
  const auto values = measure(recording);
  EXPECT_EQ(value_of(values, "pull_backs"), 0.0);
  EXPECT_EQ(value_of(values, "needle_passes"), 1.0);
  EXPECT_NEAR(value_of(values, "inward_travel"), 40.0, 1.0);
}

TEST(InsertionMetrics, CountsRedirectionsOnceEachAtAnySpeed) {
  // In to 30 mm, turn by 12 degrees and in to 45 mm, back to 35 mm, turn back and in to 50 mm. A tremor of 1 degree, a
  // turn outside the body and one without an advance do not count.
  for (const double pace : {0.1, 1.0, 10.0}) {
    const Recording recording = record(10.0 / pace, 500.0 * pace, [&](double time_s, Moment& m) {
      const double t = pace * time_s;
      const auto ramp = [&](double from, double to) { return std::clamp((t - from) / (to - from), 0.0, 1.0); };
      set_depth(m,
                -5.0 + 35.0 * ramp(1.0, 2.0) + 15.0 * ramp(3.0, 4.0) - 10.0 * ramp(4.0, 5.0) + 15.0 * ramp(6.0, 7.0));
      double deg = 20.0 * ramp(0.0, 0.5) + 12.0 * ramp(2.2, 2.9) - 12.0 * ramp(5.2, 5.9) + 15.0 * ramp(8.0, 9.0);
      deg += 0.3 * std::sin(2.0 * pi * 9.0 * t);
      m.axis_P = {std::sin(deg * pi / 180.0), std::cos(deg * pi / 180.0), 0.0};
    });
    EXPECT_EQ(measure_one("redirections", recording), 2.0) << pace;
  }
}

TEST(InsertionMetrics, MeasuresPeaksAndOvershootOfPunctures) {
  // At 1 s, 20 mm deep, the skin gives way at 3 N and the tip falls by 6 mm in 0.2 s, then stops; at 3 s, 30 mm deep,
  // the capsule at 1.5 N, by 2 mm.
  Recording recording =
      polyline({{0.0, 0.0}, {1.0, 20.0}, {1.2, 26.0}, {2.0, 26.0}, {3.0, 30.0}, {3.1, 32.0}, {5.0, 32.0}});
  for (Moment& m : recording) {
    m.events = telemetry::TickEvents{};
    const double t = m.time_s;
    m.resistance_n = t <= 1.0 ? 3.0 * t : t <= 3.0 ? std::max(0.0, 1.5 * (t - 2.0)) : 0.2;
  }
  add_event(recording[100], 0);
  add_event(recording[300], 1);
  const auto values = measure(recording, with_layers());
  EXPECT_NEAR(value_of(values, "force_peak"), 3.0, 1e-9);
  EXPECT_NEAR(*find(values, "force_peak").at_s, 1.0, 1e-9);
  EXPECT_NEAR(value_of(values, "puncture_force_peak"), 3.0, 1e-9);
  EXPECT_EQ(find(values, "puncture_force_peak").note, "skin 3.00 N, liver_capsule 1.50 N");
  EXPECT_NEAR(value_of(values, "puncture_overshoot"), 6.0, 1e-9);
  EXPECT_EQ(find(values, "puncture_overshoot").note, "skin 6.0 mm, liver_capsule 2.0 mm");
  EXPECT_NEAR(*find(values, "puncture_overshoot").at_s, 1.0, 1e-9);
}

TEST(InsertionMetrics, OvershootEndsWhenTheTipReturns) {
  Recording recording = polyline({{0.0, 0.0}, {1.0, 20.0}, {1.1, 24.0}, {1.2, 22.0}, {1.4, 29.0}});
  for (Moment& m : recording) m.events = telemetry::TickEvents{};
  add_event(recording[100], 0);
  EXPECT_NEAR(measure_one("puncture_overshoot", recording, with_layers()), 4.0, 1e-9);
}

TEST(InsertionMetrics, GivesTheReasonForMissingForces) {
  const Recording recording = polyline({{0.0, -5.0}, {1.0, 30.0}});
  EXPECT_EQ(missing_of("force_peak", recording), "the recording has no forces");
  EXPECT_EQ(missing_of("puncture_overshoot", recording), "the recording has no puncture events");
  Recording unpierced = recording;
  for (Moment& m : unpierced) m.events = telemetry::TickEvents{};
  EXPECT_EQ(missing_of("puncture_overshoot", unpierced), "nothing was punctured");
}

}  // namespace
}  // namespace trocar::metrics
