// Travel, time, damage, smoothness and actions on motions with a known answer.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "metrics/detail/uniform_sampler.h"
#include "metrics/testing/recording.h"

namespace trocar::metrics {
namespace {

using namespace testing;
using std::numbers::pi;

/// Position of a minimum-jerk motion from 0 to 1 over the share 0..1 of its time (Flash, Hogan 1985).
double minimum_jerk(double share) {
  const double u = std::clamp(share, 0.0, 1.0);
  return u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
}

TEST(MotionMetrics, MeasuresStraightMotionAtConstantSpeed) {
  // 20 mm/s along +y from 10 mm before the skin for 3 s: 60 mm, 50 mm and 2.5 s of them in the body.
  const Recording recording = record(3.0, 1000.0, [](double t, Moment& m) { set_depth(m, 20.0 * t - 10.0); });
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "path_length"), 60.0, 1e-9);
  EXPECT_NEAR(value_of(values, "elapsed_time"), 3.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_length_raw"), 60.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_in_tissue"), 50.0, 0.1) << "a mean of 40 ms that crosses the skin";
  EXPECT_NEAR(value_of(values, "path_in_tissue_raw"), 50.0, 1e-9);
  EXPECT_NEAR(value_of(values, "time_in_tissue"), 2.5, 1e-9);
  EXPECT_NEAR(value_of(values, "depth_max"), 50.0, 1e-9);
  EXPECT_NEAR(value_of(values, "tissue_damage"), 0.0, 1e-9);
  EXPECT_NEAR(value_of(values, "jerk_rms"), 0.0, 1e-3);
}

TEST(MotionMetrics, InterpolatesTheSkinCrossing) {
  // 7 moments a second do not fall on the skin at t = 0.5 s.
  const Recording recording = record(3.0, 7.0, [](double t, Moment& m) { set_depth(m, 20.0 * t - 10.0); });
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "path_in_tissue"), 50.0, 0.1);
  EXPECT_NEAR(value_of(values, "path_in_tissue_raw"), 50.0, 1e-9);
  EXPECT_NEAR(value_of(values, "time_in_tissue"), 2.5, 1e-9);
}

TEST(MotionMetrics, IgnoresRecordingNoiseInPathLength) {
  // 20 mm/s for 3 s, with 0.02 mm of noise on each axis at any rate: the raw value grows with the rate.
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise_mm(0.0, 0.02);
  for (const double rate_hz : {250.0, 1000.0, 4000.0}) {
    const Recording recording = record(3.0, rate_hz, [&](double t, Moment& m) {
      set_depth(m, 20.0 * t - 10.0);
      m.tip_P += Vec3(noise_mm(random), noise_mm(random), noise_mm(random));
      m.axis_P = (m.axis_P + Vec3(2e-4 * noise_mm(random), 0.0, 2e-4 * noise_mm(random))).normalized();
    });
    const auto values = measure(recording);
    EXPECT_NEAR(value_of(values, "path_length"), 60.0, 1.0) << rate_hz;
    EXPECT_NEAR(value_of(values, "path_in_tissue"), 50.0, 1.0) << rate_hz;
    EXPECT_GT(value_of(values, "path_length_raw"), rate_hz < 1000.0 ? 60.5 : 90.0) << rate_hz;
    EXPECT_LT(value_of(values, "tissue_damage"), 0.1 * value_of(values, "tissue_damage_raw")) << rate_hz;
  }
}

TEST(MotionMetrics, CountsGapsOfTheRecordingAsStraightLines) {
  Recording slow;  // a row every 2 s
  for (int n = 0; n < 100; ++n) {
    Moment& moment = slow.emplace_back();
    moment.time_s = 2.0 * n;
    moment.tip_P = {static_cast<double>(n), 0.0, 0.0};
    moment.axis_P = Vec3::UnitX();
    moment.depth_mm = n < 50 ? 0.0 : n - 49.0;
  }
  EXPECT_NEAR(measure_one("path_length", slow), 99.0, 1e-9);
  EXPECT_NEAR(measure_one("path_in_tissue", slow), 50.0, 0.501) << "half of the row at the skin";
  Recording gap = record(2.0, 100.0, [](double t, Moment& m) { m.tip_P = {10.0 * t, 0.0, 0.0}; });
  Moment after = gap.back();
  after.time_s += 4.0;
  after.tip_P.x() += 40.0;
  gap.push_back(after);
  EXPECT_NEAR(measure_one("path_length", gap), measure_one("path_length_raw", gap), 1e-6);
}

TEST(MotionMetrics, CircleHasItsCircumference) {
  const Recording recording = record(2.0, 1000.0, [](double t, Moment& m) {
    m.tip_P = {30.0 * std::cos(pi * t), 30.0 * std::sin(pi * t), 0.0};
  });
  // Chords: relative error (pi/1000)²/24; means over 0.04 s shrink the circle by (0.04 pi)²/24.
  EXPECT_NEAR(measure_one("path_length_raw", recording), 2.0 * pi * 30.0, 1e-3);
  EXPECT_NEAR(measure_one("path_length", recording), 2.0 * pi * 30.0, 0.3);
}

TEST(MotionMetrics, PivotAboutTheSkinSweepsASector) {
  // The shaft turns by 0.3 rad about its crossing of the skin, 80 mm deep: a sector of r² angle / 2.
  const Recording recording = record(1.0, 500.0, [](double t, Moment& m) {
    m.axis_P = {std::sin(0.3 * t), std::cos(0.3 * t), 0.0};
    m.tip_P = 80.0 * m.axis_P;
    m.depth_mm = 80.0;
  });
  EXPECT_NEAR(measure_one("tissue_damage", recording), 0.5 * 80.0 * 80.0 * 0.3, 0.05);
}

TEST(MotionMetrics, SidewaysShiftSweepsARectangle) {
  const Recording recording = record(1.0, 100.0, [](double t, Moment& m) {
    set_depth(m, 40.0);
    m.tip_P.x() = 5.0 * t;
  });
  EXPECT_NEAR(measure_one("tissue_damage", recording), 200.0, 1e-9);
}

TEST(MotionMetrics, ExcludesInterruptions) {
  Recording recording = record(1.0, 100.0, [](double t, Moment& m) { set_depth(m, 10.0 * t); });
  Moment after;
  set_depth(after, 60.0);
  after.time_s = 31.0;
  after.is_paused = true;
  recording.push_back(after);
  after.is_paused = false;
  after.time_s = 32.0;
  set_depth(after, 61.0);
  recording.push_back(after);
  const auto values = measure(recording);
  EXPECT_NEAR(value_of(values, "elapsed_time"), 2.0, 1e-9);
  EXPECT_NEAR(value_of(values, "path_length"), 11.0, 1e-9);
}

TEST(MotionMetrics, KeepsAnInterruptionBeforeAnInvalidMoment) {
  Recording recording = record(1.0, 10.0, [](double t, Moment& m) { set_depth(m, 10.0 * t); });
  Moment after;
  after.time_s = std::nan("");
  after.is_paused = true;
  recording.push_back(after);
  after.is_paused = false;
  after.time_s = 50.0;
  set_depth(after, 90.0);
  recording.push_back(after);
  EXPECT_NEAR(measure_one("elapsed_time", recording), 1.0, 1e-9);
}

TEST(MotionMetrics, MinimumJerkMotionMatchesTheory) {
  // The integral of jerk² is 720 A²/D⁵, the peak speed 15/8 A/D: 720 (8/15)² = 204.8 for any size A and duration D.
  for (const double duration_s : {8.0, 16.0})
    for (const double rate_hz : {100.0, 1000.0}) {
      const Recording recording = record(duration_s, rate_hz, [&](double t, Moment& m) {
        m.tip_P = Vec3(3.0, -4.0, 12.0) * 5.0 * minimum_jerk(t / duration_s);
      });
      const auto values = measure(recording);
      EXPECT_NEAR(value_of(values, "dimensionless_jerk"), 204.8, 204.8 * 0.01) << duration_s;
      EXPECT_NEAR(value_of(values, "log_dimensionless_jerk"), -std::log(204.8), 0.01);
      EXPECT_NEAR(value_of(values, "jerk_rms"), std::sqrt(720.0) * 65.0 / std::pow(duration_s, 3),
                  0.01 * std::sqrt(720.0) * 65.0 / std::pow(duration_s, 3));
    }
}

TEST(MotionMetrics, SineJerkMatchesItsThirdDerivative) {
  // x = 10 mm sin(2 pi f t): the root mean square of the jerk is 10 (2 pi f)³/sqrt(2).
  const Recording recording =
      record(20.0, 1000.0, [](double t, Moment& m) { m.tip_P.x() = 10.0 * std::sin(2.0 * pi * 0.5 * t); });
  const double wanted = 10.0 * std::pow(pi, 3) / std::sqrt(2.0);
  EXPECT_NEAR(measure_one("jerk_rms", recording), wanted, 0.01 * wanted);
}

TEST(MotionMetrics, MeasuresSpectralArcLengthOfAGaussianSpeed) {
  // The spectrum of a Gaussian speed of width s is exp(-(2 pi f s)²/2); it falls to 0.05 at f = sqrt(2 ln 20)/(2 pi s).
  const double width_s = 0.4, period_s = 0.04;
  std::vector<double> speed;
  for (int n = 0; n <= 200; ++n) {
    const double t = (n - 100) * period_s;
    speed.push_back(7.0 * std::exp(-0.5 * t * t / (width_s * width_s)));
  }
  const double highest = std::sqrt(2.0 * std::log(20.0));  // in units of 2 pi s
  double length = 0.0;                                     // of exp(-x²/2) over x/highest, by the midpoint rule
  const int pieces = 20000;
  for (int n = 0; n < pieces; ++n) {
    const double x = (n + 0.5) / pieces * highest;
    length += std::hypot(1.0, x * std::exp(-0.5 * x * x) * highest) / pieces;
  }
  const auto arc = detail::spectral_arc_length(speed, period_s);
  ASSERT_TRUE(arc);
  EXPECT_NEAR(*arc, -length, 0.005);  // the highest frequency falls on a step of the spectrum
}

TEST(MotionMetrics, SubmovementsAreLessSmoothThanOneMotion) {
  const auto motion = [](int parts) {
    return record(6.0, 500.0, [parts](double t, Moment& m) {
      const double part = std::min(std::floor(t / 6.0 * parts), parts - 1.0);
      m.tip_P.y() = 60.0 / parts * (part + minimum_jerk(t / 6.0 * parts - part));
    });
  };
  const auto one = measure(motion(1)), three = measure(motion(3));
  EXPECT_GT(value_of(one, "spectral_arc_length"), value_of(three, "spectral_arc_length") + 0.1);
  EXPECT_GT(value_of(one, "log_dimensionless_jerk"), value_of(three, "log_dimensionless_jerk") + 2.0);
}

TEST(MotionMetrics, SlowRecordingsHaveNoSmoothness) {
  const auto slow = record(10.0, 5.0, [](double t, Moment& m) { m.tip_P.y() = 10.0 * minimum_jerk(t / 10.0); });
  EXPECT_EQ(missing_of("spectral_arc_length", slow), "fewer than 24 moments a second");
  const auto resting = record(2.0, 100.0, [](double, Moment& m) { m.tip_P.y() = 10.0; });
  EXPECT_EQ(missing_of("dimensionless_jerk", resting), "the needle did not move");
}

TEST(MotionMetrics, CountsTranslationalActionsThatLast) {
  // Three motions of 0.5 s at 80 mm/s, 1 s apart; then one of 0.1 s, too short; then 2 s at 30 mm/s, too slow.
  double x_mm = 0.0, last_s = 0.0;
  const Recording recording = record(9.0, 1000.0, [&](double t, Moment& m) {
    double speed_mm_s = 0.0;
    if (t > 1.0 && t <= 5.5 && std::fmod(t - 1.0, 1.5) < 0.5) speed_mm_s = 80.0;
    if (t > 5.5 && t <= 5.6) speed_mm_s = 80.0;
    if (t > 6.5 && t <= 8.5) speed_mm_s = 30.0;
    x_mm += speed_mm_s * (t - last_s);
    last_s = t;
    m.tip_P.x() = x_mm;
  });
  const auto values = measure(recording);
  EXPECT_EQ(value_of(values, "translational_actions"), 3.0);
  EXPECT_EQ(value_of(values, "rotational_actions"), 0.0);
}

TEST(MotionMetrics, CountsRotationalActions) {
  // Twice 60 deg/s for 0.5 s, once 40 deg/s for 1 s.
  double angle_deg = 0.0, last_s = 0.0;
  const Recording recording = record(6.0, 200.0, [&](double t, Moment& m) {
    const double speed = (t > 1.0 && t <= 1.5) || (t > 3.0 && t <= 3.5) ? 60.0 : t > 4.5 && t <= 5.5 ? 40.0 : 0.0;
    angle_deg += speed * (t - last_s);
    last_s = t;
    m.axis_P = {std::sin(angle_deg * pi / 180.0), 0.0, std::cos(angle_deg * pi / 180.0)};
  });
  const auto values = measure(recording);
  EXPECT_EQ(value_of(values, "rotational_actions"), 2.0);
  EXPECT_EQ(value_of(values, "translational_actions"), 0.0);
}

}  // namespace
}  // namespace trocar::metrics
