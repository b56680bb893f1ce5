#include "haptics/insertion/insertion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

constexpr double kPeakTolerance = 0.01;  // the bar for a recorded peak

double peak_at_puncture(const std::vector<telemetry::TickSample>& samples, int layer) {
  for (const telemetry::TickSample& sample : samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind == telemetry::EventKind::kPuncture && event.id == layer) return -sample.f_prepuncture_n;
    }
  }
  return 0.0;
}

struct Drive {
  double speed_mm_per_s;
  double rate_hz;
};
class PuncturePeaks : public ::testing::TestWithParam<Drive> {};

TEST_P(PuncturePeaks, AreThePunctureForcesInOrder) {
  Driver driver(make_scene(liver_way()), GetParam().rate_hz);
  const auto samples = driver.move(60.0, GetParam().speed_mm_per_s);
  EXPECT_EQ(punctures(samples), (std::vector<int>{0, 1, 2}));
  EXPECT_NEAR(peak_at_puncture(samples, 0), 2.8, 2.8 * kPeakTolerance);
  EXPECT_NEAR(peak_at_puncture(samples, 1), 2.5, 2.5 * kPeakTolerance);
  EXPECT_NEAR(peak_at_puncture(samples, 2), 1.5, 1.5 * kPeakTolerance);
}
INSTANTIATE_TEST_SUITE_P(Speeds, PuncturePeaks,
                         ::testing::Values(Drive{2, 1000}, Drive{10, 1000}, Drive{50, 1000}, Drive{10, 4000},
                                           Drive{50, 4000}, Drive{10, 250}));

TEST(Insertion, EntersATissueAfterItsLayerIsPierced) {
  using enum telemetry::EventKind;
  const std::vector<std::pair<telemetry::EventKind, int>> in_order{{kPuncture, 0},    {kEnter, kFat}, {kPuncture, 1},
                                                                   {kEnter, kMuscle}, {kPuncture, 2}, {kEnter, kLiver}};
  for (const double speed_mm_per_s : {2.0, 10.0, 50.0}) {
    Driver driver(make_scene(liver_way()));
    EXPECT_EQ(ways_in(driver.move(60.0, speed_mm_per_s)), in_order);
  }
  // A muscle so near below the skin that the needle has passed its resting surface when the skin gives way.
  Driver driver(make_scene({{0, kFat}, {3, kMuscle}, {24, kLiver}}));
  EXPECT_EQ(ways_in(driver.move(60.0, 10.0)), in_order);
  // Pulled back a little before the capsule gives way, then on.
  Driver again(make_scene(liver_way()));
  auto samples = again.move(25.0, 10.0);
  EXPECT_EQ(ways_in(samples).size(), 4U);
  samples = joined(joined(samples, again.move(20.0, 10.0)), again.move(60.0, 10.0));
  EXPECT_EQ(ways_in(samples), in_order);
}

TEST(Insertion, PeaksAreExactForATremblingHand) {
  for (const double phase : {0.0, 0.7, 1.4, 2.1, 2.8}) {
    Driver driver(make_scene(liver_way()));
    std::vector<telemetry::TickSample> samples;
    for (int i = 0; i < 3000; ++i)  // 30 mm/s with 0.4 mm of tremor at 11 Hz and encoder counts of 0.03 mm
      samples.push_back(
          driver.to({0, 0, 0.03 * std::round((-10 + 0.03 * i + 0.4 * std::sin(0.07 * i + phase)) / 0.03)}));
    ASSERT_EQ(punctures(samples), (std::vector<int>{0, 1, 2}));
    EXPECT_NEAR(peak_at_puncture(samples, 0), 2.8, 2.8 * kPeakTolerance);
    EXPECT_NEAR(peak_at_puncture(samples, 1), 2.5, 2.5 * kPeakTolerance);
    EXPECT_NEAR(peak_at_puncture(samples, 2), 1.5, 1.5 * kPeakTolerance);
  }
}

TEST(Insertion, SkinPeakIsExactForASlidingTiltingNeedle) {
  for (const double slide_mm_per_s : {-40.0, 15.0, 40.0}) {
    Driver driver(make_scene(liver_way()));
    std::vector<telemetry::TickSample> samples;
    for (int i = 0; i < 1500 && punctures(samples).empty(); ++i) {
      const double t = 0.001 * i;
      const Vec3 axis = Vec3(0.5 + 0.2 * std::sin(9.0 * t), 0.7, 1.0).normalized();
      samples.push_back(driver.to({slide_mm_per_s * (t - 0.3), 3.0 * std::sin(50.0 * t), -8.0 + 25.0 * t}, axis));
    }
    ASSERT_EQ(punctures(samples), (std::vector<int>{0}));
    const telemetry::TickSample& last = samples.back();  // the force along the needle pierces
    constexpr double kDamper_n = 0.2;                    // of the tip's motion across the needle
    EXPECT_NEAR(-(last.f_total_n - last.f_weight_n).dot(last.axis), 2.8, kDamper_n);
  }
}

TEST(Insertion, RecordsTheInputsOfTheLaw) {
  Driver driver(make_scene(liver_way()));
  const anatomy::TissueTable table = paper_tissues();
  int loaded = 0;
  std::uint8_t layer = 0;
  for (const telemetry::TickSample& sample : driver.move(60.0, 10.0)) {
    if (sample.f_prepuncture_n != 0.0) {
      ++loaded;
      const anatomy::LayerParams& params = table.layers[layer];
      EXPECT_NEAR(
          -sample.f_prepuncture_n,
          haptics::prepuncture_force_n(sample.layer_displacement_mm, sample.axial_velocity_mm_s,
                                       {params.stiffness_n_per_mm, params.viscosity_ns_per_mm, params.delta_x_mm}),
          1e-9);
    }
    if (sample.events[0].kind == telemetry::EventKind::kPuncture) ++layer;
  }
  EXPECT_GT(loaded, 100);
}

TEST(Insertion, DropsAfterEachPuncture) {
  Driver driver(make_scene(liver_way()));
  const auto samples = driver.move(60.0, 10.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].events[0].kind != telemetry::EventKind::kPuncture) continue;
    constexpr std::size_t kAfter = 60;  // ms: several time constants of the coupling
    EXPECT_LT(-samples[i + kAfter].device_f_n.z(), 0.7 * -samples[i].device_f_n.z());
  }
}

TEST(Insertion, SumsFrictionPerTissueLength) {
  haptics::HapticOptions options;
  anatomy::TissueTable smooth = paper_tissues();
  for (anatomy::TissueParams& tissue : smooth.tissues) tissue.roughness_n = 0.0;
  Driver driver(make_scene(liver_way(), options, smooth));
  const auto samples = driver.move(60.0, 10.0);
  const telemetry::TickSample& last = samples.back();
  const double s = last.depth_mm;
  // Closed form: skin 0-2, fat 2-12, muscle 12-24, liver from 24 mm; nu v 2 pi r x with the area in cm^2.
  const double per_mm = 2 * std::numbers::pi * 0.635 / 100.0;
  const double expected =
      last.axial_velocity_mm_s * per_mm * (0.02 * 2.0 + 0.01 * 10.0 + 0.03 * 12.0 + 0.02 * (s - 24.0));
  constexpr double kHalfVoxel = 0.01;  // borders lie on voxel faces: 0.5 mm of 0.03 N s/mm at 10 mm/s
  EXPECT_NEAR(-last.f_friction_n, expected, kHalfVoxel);
  EXPECT_NEAR(last.axial_velocity_mm_s, 10.0, 0.5);  // the coupling stretches with the growing friction
}

TEST(Insertion, FluctuatesWithinDeltaMuOfThePenetratedTissues) {
  anatomy::TissueTable rough = paper_tissues();
  for (anatomy::TissueParams& tissue : rough.tissues) tissue.viscosity_ns_per_mm = 0.0;
  Driver driver(make_scene(liver_way(), {}, rough));
  double largest = 0.0;
  for (const telemetry::TickSample& sample : driver.move(60.0, 10.0))
    largest = std::max(largest, std::abs(sample.f_friction_n));
  const double bound = 0.1 * (0.18 + 0.1 + 0.15 + 0.58);
  EXPECT_LE(largest, bound + 1e-12);
  EXPECT_GT(largest, 0.3 * bound);
}

TEST(Insertion, IsIndependentOfTheTickRate) {
  const auto slow = Driver(make_scene(liver_way()), 1000.0).move(60.0, 10.0);
  const auto fast = Driver(make_scene(liver_way()), 4000.0).move(60.0, 10.0);
  double worst = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 3; i < slow.size(); ++i) {
    const telemetry::TickSample& a = slow[i];
    const telemetry::TickSample& b = fast[4 * i + 3];
    ASSERT_NEAR(a.device_mm.z(), b.device_mm.z(), 1e-9);
    if (std::abs(a.axial_velocity_mm_s - 10.0) > 1.0) continue;  // not in the milliseconds after a puncture
    worst = std::max(worst, std::abs(a.f_total_n.dot(a.axis) - b.f_total_n.dot(b.axis)));
    ++compared;
  }
  EXPECT_GT(compared, slow.size() / 2);
  EXPECT_LT(worst, 0.05);  // N: below the just noticeable 7 % of a puncture
}

TEST(Insertion, CutsOnlyFreshLiverAndOnlyForward) {
  Driver driver(make_scene(liver_way()));
  const auto in = driver.move(60.0, 10.0);
  EXPECT_NEAR(in.back().f_cutting_n, -0.6, 1e-9);
  for (const telemetry::TickSample& sample : driver.move(40.0, 10.0)) {
    if (sample.axial_velocity_mm_s <= 0.0) {
      EXPECT_EQ(sample.f_cutting_n, 0.0);
    }
  }
  const auto again = driver.move(70.0, 10.0);
  for (const telemetry::TickSample& sample : again) {
    if (sample.depth_mm < in.back().depth_mm - 0.1) {
      EXPECT_EQ(sample.f_cutting_n, 0.0);
    }
  }
  EXPECT_NEAR(again.back().f_cutting_n, -0.6, 1e-9);
}

TEST(Insertion, ReentersItsHoleWithoutPunctureOrCutting) {
  anatomy::TissueTable smooth = paper_tissues();
  for (anatomy::TissueParams& tissue : smooth.tissues) tissue.roughness_n = 0.0;
  Driver driver(make_scene(liver_way(), {}, smooth));
  const auto first = driver.move(60.0, 10.0);
  const auto out = driver.move(-10.0, 10.0);
  EXPECT_EQ(out.back().phase, telemetry::InsertionPhase::kOutside);
  const auto second = driver.move(55.0, 10.0);
  EXPECT_TRUE(punctures(second).empty());
  const auto at = [](const std::vector<telemetry::TickSample>& samples, double depth) {
    return *std::find_if(samples.begin(), samples.end(),
                         [&](const telemetry::TickSample& s) { return s.depth_mm >= depth; });
  };
  const double before = -at(first, 50.0).f_total_n.z();
  const double after = -at(second, 50.0).f_total_n.z();
  EXPECT_NEAR(before - after, 0.6, 0.01);  // the cutting term (Azar & Hayward 2008)
}

TEST(Insertion, StartsANewHoleElsewhere) {
  Driver driver(make_scene(liver_way()));
  driver.move(40.0, 20.0);
  driver.move(-10.0, 20.0);
  std::vector<telemetry::TickSample> samples;
  for (int i = 0; i < 3000; ++i) samples.push_back(driver.to({8.0, 0.0, -10.0 + 0.02 * i}));
  EXPECT_EQ(punctures(samples), (std::vector<int>{0, 1, 2}));
}

TEST(Insertion, TreatsMuscleBehindAFatPlaneAsTheSameLayer) {
  Driver driver(make_scene({{0, kFat}, {10, kMuscle}, {16, kFat}, {20, kMuscle}, {28, kLiver}}));
  EXPECT_EQ(punctures(driver.move(60.0, 10.0)), (std::vector<int>{0, 1, 2}));
}

TEST(Insertion, PiercesAThinLayerWithinTheDentOfAnother) {
  // Muscle indents by several mm in the tented profile: deeper than the 2 mm of muscle in front of the liver.
  anatomy::TissueTable tented = paper_tissues();
  tented.layers[0].delta_x_mm = 4.0;
  tented.layers[1].delta_x_mm = 1.35;
  tented.layers[2].delta_x_mm = 4.6;
  Driver driver(make_scene({{0, kFat}, {4, kMuscle}, {6, kLiver}}, {}, tented));
  EXPECT_EQ(punctures(driver.move(60.0, 10.0)), (std::vector<int>{0, 1, 2}));
}

TEST(Insertion, BoneStopsTheNeedle) {
  Driver driver(make_scene({{0, kFat}, {10, kBone}}));
  const auto samples = driver.move(20.0, 5.0);
  EXPECT_EQ(punctures(samples), (std::vector<int>{0}));
  EXPECT_LT(samples.back().depth_mm, 12.0);
  EXPECT_GT(samples.back().device_f_n.norm(), 7.0);
}

TEST(Insertion, NeverPullsOnRetreatFromALoadedLayer) {
  Driver driver(make_scene(liver_way()));
  driver.move(2.0, 10.0);  // skin loaded, not pierced
  for (const telemetry::TickSample& sample : driver.move(-5.0, 30.0)) {
    EXPECT_LE(sample.f_prepuncture_n, 0.0);
    EXPECT_NE(sample.phase, telemetry::InsertionPhase::kInserted);
  }
  EXPECT_EQ(driver.state().needle.insertion.phase, telemetry::InsertionPhase::kOutside);
}

TEST(Insertion, HoldsAReleasedNeedle) {
  Driver driver(make_scene(liver_way()));
  driver.move(50.0, 10.0);
  driver.hold(1.0);
  const double before = driver.state().needle.insertion.s_mm;
  EXPECT_GT(std::abs(driver.state().last.f_stick_n), 0.01);  // the stretch that the stop left
  // A pull below the holding force (0.1 N: 0.1 mm of the coupling) does not move it …
  telemetry::TickSample held;
  for (double z = 50.0; z > before - 0.1; z -= 0.0004) held = driver.to({0, 0, z});
  EXPECT_NEAR(driver.state().needle.insertion.s_mm, before, 1e-9);
  EXPECT_NEAR(held.f_stick_n, 0.1, 0.005);
  EXPECT_EQ(held.axial_velocity_mm_s, 0.0);
  // … a strong one does.
  driver.move(40.0, 10.0);
  EXPECT_LT(driver.state().needle.insertion.s_mm, before - 5.0);
}

TEST(Insertion, PhasesFollowTheNeedle) {
  Driver driver(make_scene(liver_way()));
  EXPECT_EQ(driver.move(-1.0, 10.0).back().phase, telemetry::InsertionPhase::kOutside);
  EXPECT_EQ(driver.move(1.0, 10.0).back().phase, telemetry::InsertionPhase::kLoading);
  EXPECT_EQ(driver.move(8.0, 10.0).back().phase, telemetry::InsertionPhase::kInserted);
  EXPECT_EQ(driver.move(4.0, 10.0).back().phase, telemetry::InsertionPhase::kRetracting);
  EXPECT_EQ(driver.move(-5.0, 10.0).back().phase, telemetry::InsertionPhase::kOutside);
}

TEST(Insertion, FrictionNeverActsAlongTheMotion) {
  anatomy::TissueTable tissues = paper_tissues();
  for (anatomy::TissueParams& tissue : tissues.tissues) tissue.roughness_n = 2.0;
  Driver driver(make_scene(liver_way(), {}, tissues));
  int seen = 0;
  for (const double to_mm : {50.0, 20.0, 45.0, 5.0})
    for (const telemetry::TickSample& sample : driver.move(to_mm, 2.0)) {
      ASSERT_LE(sample.f_friction_n * sample.axial_velocity_mm_s, 0.0) << sample.depth_mm;
      seen += sample.f_friction_n != 0.0 ? 1 : 0;
    }
  EXPECT_GT(seen, 10000);
}

TEST(Insertion, ViscousFrictionGrowsWithSpeedUpToABound) {
  const auto friction_n = [](double speed_mm_per_s, double grows_to_mm_per_s) {
    anatomy::TissueTable tissues = paper_tissues();
    for (anatomy::TissueParams& tissue : tissues.tissues) tissue.roughness_n = 0.0;
    tissues.friction.grows_to_mm_per_s = grows_to_mm_per_s;
    Driver driver(make_scene({{0, kFat}}, {}, tissues));
    const auto samples = driver.move(60.0, speed_mm_per_s);
    return -samples[samples.size() - 2].f_friction_n;
  };
  constexpr double kNever = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(friction_n(5.0, 10.0), friction_n(5.0, kNever), 1e-12);  // paper A's law
  EXPECT_NEAR(friction_n(50.0, kNever) / friction_n(5.0, kNever), 10.0, 0.5);
  EXPECT_NEAR(friction_n(50.0, 10.0) / friction_n(5.0, 10.0), 2.0, 0.1);
}

TEST(Insertion, LateralForceMatchesTheDrawnBend) {
  const auto sideways = [](const anatomy::TissueTable& tissues, haptics::ForceModel model) {
    haptics::HapticOptions options;
    options.force_model = model;
    Driver driver(make_scene(liver_way(), options, tissues));
    driver.move(40.0, 20.0);
    telemetry::TickSample sample;
    for (int i = 1; i <= 600; ++i) sample = driver.to({0.01 * i, 0.0, 40.0});
    for (int i = 0; i < 300; ++i) sample = driver.to({6.0, 0.0, 40.0});
    return -sample.f_constraint_n.x();
  };
  using enum haptics::ForceModel;
  const double bent_n = sideways(paper_tissues(), kInsertion);
  EXPECT_NEAR(bent_n, sideways(paper_tissues(), kProxy), 0.1 * bent_n);  // the drawn beam's
  EXPECT_LT(bent_n, 0.5);
  EXPECT_NEAR(sideways(constrained_tissues(), kInsertion), 3.0, 1e-6);  // paper A's, where it is selected
}

TEST(Insertion, KeepsThePathThatPiercedTheSkin) {
  Driver driver(make_scene(liver_way(), {}, constrained_tissues()));
  driver.move(10.0, 10.0);
  telemetry::TickSample sample;
  const Vec3 tilted = Vec3(0.1, 0.0, 1.0).normalized();
  for (int i = 0; i < 100; ++i) sample = driver.to({0.02 * i, 0.0, 10.0 + 0.01 * i}, tilted);
  EXPECT_NEAR(sample.tip_mm.x(), 0.0, 1e-9);
  EXPECT_NEAR(sample.axis.z(), 1.0, 1e-12);
  EXPECT_GT(sample.f_constraint_n.x(), 0.5);  // the tilt has brought the stylus 13 mm to the other side
  EXPECT_GT(sample.tau_nmm.norm(), 10.0);
}

TEST(Insertion, RecordsTheDisplacementFromContactToPuncture) {
  Driver driver(make_scene(liver_way()));
  const telemetry::TickSample sample = driver.move(10.0, 10.0).back();
  constexpr double kTick_mm = 0.01;  // contact is noticed at the end of a tick
  EXPECT_NEAR(sample.contact_to_puncture_mm.z(), haptics::static_displacement_mm(2.8, {0.46, 0.02, 0.1}),
              0.15);  // and viscosity
  EXPECT_NEAR(sample.contact_to_puncture_mm.head<2>().norm(), 0.0, kTick_mm);
}

TEST(Insertion, ObliqueNeedleTouchesTheSkinAtItsAxis) {
  Driver driver(make_scene(liver_way()));
  const Vec3 axis = Vec3(1.0, 0.0, 1.0).normalized();
  std::vector<telemetry::TickSample> samples;
  for (int i = 0; i < 6000; ++i) samples.push_back(driver.to(Vec3(-10, 0, -10) + axis * 0.01 * i, axis));
  const auto pierced = std::find_if(samples.begin(), samples.end(), [](const telemetry::TickSample& s) {
    return s.events[0].kind == telemetry::EventKind::kPuncture;
  });
  ASSERT_NE(pierced, samples.end());
  EXPECT_NEAR(pierced->layer_displacement_mm * axis.z(), pierced->tip_mm.z(), 1e-6);  // counted from z = 0
}

}  // namespace
}  // namespace trocar::testing
