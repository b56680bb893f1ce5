#include "attempt/record/xray_replay.h"

#include <gtest/gtest.h>

namespace trocar::attempt {
namespace {

constexpr double kInjectionStep_s = InjectionSteps::kStep_s;

tasks::XrayUse use_at(double time_s, double lao_deg, bool is_beam_on, double contrast_ml, double beam_s) {
  tasks::XrayUse use;
  use.time_s = time_s;
  use.lao_deg = lao_deg;
  use.is_beam_on = is_beam_on;
  use.contrast_ml = contrast_ml;
  use.beam_s = beam_s;
  return use;
}

/// The beam is on from 1 s to 2 s and, turned, from 4 s to 5 s; 2 ml are injected from 4.2 s to 4.7 s.
std::vector<tasks::XrayUse> two_exposures() {
  return {use_at(0.5, 0, false, 0, 0),      use_at(1.0, 0, true, 0, 0.1),    use_at(1.9, 0, true, 0, 1.0),
          use_at(2.0, 0, false, 0, 1.0),    use_at(3.0, 30, false, 0, 1.0),  use_at(4.0, 30, true, 0, 1.1),
          use_at(4.25, 30, true, 0.2, 1.3), use_at(4.3, 30, true, 0.4, 1.4), use_at(4.7, 30, true, 2.0, 1.8),
          use_at(5.0, 30, false, 2.0, 2.0)};
}

TEST(XrayReplay, ShowsNothingBeforeTheFirstExposure) {
  const auto uses = two_exposures();
  EXPECT_FALSE(xray_moment(uses, 0.4));
  const auto moment = xray_moment(uses, 0.99);
  ASSERT_TRUE(moment);
  EXPECT_FALSE(moment->image_s);
  EXPECT_FALSE(moment->is_held());
  EXPECT_FALSE(xray_moment({}, 1.0));
}

TEST(XrayReplay, ShowsTheCurrentMomentWhileTheBeamIsOn) {
  const auto moment = xray_moment(two_exposures(), 1.5);
  ASSERT_TRUE(moment && moment->image_s);
  EXPECT_EQ(*moment->image_s, 1.5);
  EXPECT_FALSE(moment->is_held());
  EXPECT_EQ(moment->use.beam_s, 0.1);
}

TEST(XrayReplay, HoldsTheLastExposureWithItsOwnProjection) {
  const auto moment = xray_moment(two_exposures(), 3.5);
  ASSERT_TRUE(moment && moment->image_s);
  EXPECT_TRUE(moment->is_held());
  EXPECT_EQ(*moment->image_s, 1.9);
  EXPECT_EQ(moment->image.lao_deg, 0.0);
  EXPECT_EQ(moment->use.lao_deg, 30.0) << "the C-arm was turned without X-rays";
  const auto end = xray_moment(two_exposures(), 100.0);
  ASSERT_TRUE(end && end->image_s);
  EXPECT_EQ(*end->image_s, 5.0) << "a pulse between the last two uses: the time with the beam on has grown";
  EXPECT_EQ(end->image.lao_deg, 30.0);
}

TEST(XrayReplay, PulseBetweenTwoSamplesIsAnExposure) {
  const std::vector<tasks::XrayUse> uses{use_at(1.0, 0, false, 0, 0), use_at(2.0, 0, false, 0, 0.067),
                                         use_at(3.0, 10, false, 0, 0.067)};
  EXPECT_FALSE(xray_moment(uses, 1.5)->image_s);
  EXPECT_EQ(xray_moment(uses, 4.0)->image_s.value_or(0.0), 2.0);
  EXPECT_TRUE(xray_moment(uses, 4.0)->is_held());
}

TEST(XrayReplay, ReportsWhenContrastAgentIsInjected) {
  const auto is_injecting = [](double time_s) { return xray_moment(two_exposures(), time_s)->is_injecting_then; };
  EXPECT_FALSE(is_injecting(4.1));
  EXPECT_TRUE(is_injecting(4.2));
  EXPECT_TRUE(is_injecting(4.27));
  EXPECT_TRUE(is_injecting(4.69));
  EXPECT_FALSE(is_injecting(4.8));
}

/// Volume of the steps up to a session time.
double volume_ml(const InjectionSteps& made, double to_s) {
  double ml = 0.0;
  for (std::size_t n = 0; n < made.steps.size(); ++n)
    if (made.start_s + static_cast<double>(n + 1) * kInjectionStep_s <= to_s + 1e-9)
      ml += made.steps[n].ml_per_s * kInjectionStep_s;
  return ml;
}

TEST(XrayReplay, ReproducesRecordedInjections) {
  const auto made = injection_steps(two_exposures(), [](double time_s) { return Vec3(time_s, 0.0, 0.0); });
  ASSERT_FALSE(made.steps.empty());
  EXPECT_NEAR(made.start_s, 4.15, kInjectionStep_s) << "0.1 s before the first use with contrast agent";
  EXPECT_NEAR(volume_ml(made, 1e9), 2.0, 1e-9);
  EXPECT_NEAR(volume_ml(made, 4.25), 0.2, 2.0 * kInjectionStep_s) << "at 2 ml/s within a step";
  EXPECT_NEAR(volume_ml(made, 4.3), 0.4, 4.0 * kInjectionStep_s);
  EXPECT_NEAR(volume_ml(made, 4.6), 0.4, 1e-9) << "the rest was injected within the last 0.1 s before 4.7 s";
  const double end_s = made.start_s + static_cast<double>(made.steps.size()) * kInjectionStep_s;
  EXPECT_NEAR(end_s, 4.7, kInjectionStep_s);
  for (std::size_t n = 0; n < made.steps.size(); ++n)
    EXPECT_NEAR(made.steps[n].tip_P.x(), made.start_s + (static_cast<double>(n) + 0.5) * kInjectionStep_s, 1e-9);
}

TEST(XrayReplay, SpreadsASuddenVolumeOverSteps) {
  const std::vector<tasks::XrayUse> uses{use_at(1.0, 0, false, 0, 0), use_at(1.016, 0, false, 5.0, 0)};
  const auto made = injection_steps(uses, [](double) { return Vec3(Vec3::Zero()); });
  EXPECT_NEAR(volume_ml(made, 1e9), 5.0, 1e-9);
  for (const InjectionStep& step : made.steps) EXPECT_LE(step.ml_per_s, kMostRate_ml_per_s + 1e-9);
}

TEST(XrayReplay, HasNoStepsWithoutContrastAgent) {
  const auto nowhere = [](double) { return Vec3(Vec3::Zero()); };
  EXPECT_TRUE(injection_steps({}, nowhere).steps.empty());
  EXPECT_TRUE(injection_steps(std::vector{use_at(1.0, 0, true, 0, 1.0)}, nowhere).steps.empty());
}

}  // namespace
}  // namespace trocar::attempt
