// The law of the needle's size against its sources: docs/physics.md P7.
#include <gtest/gtest.h>

#include "haptics/needle_geometry.h"
#include "haptics/test/layered_patient.h"

namespace trocar::testing {
namespace {

const anatomy::NeedleSizeLaw kLaw{1.27, 20.0, 61.0, 18.0, 0.255};

haptics::NeedleGeometry needle(double diameter_mm, double bevel_deg = 20.0) {
  haptics::NeedleGeometry geometry;
  geometry.radius_mm = 0.5 * diameter_mm;
  geometry.bevel_rad = radians(bevel_deg);
  return geometry;
}

double factor(double diameter_mm, double bevel_deg = 20.0) {
  return haptics::needle_size_factor(kLaw, 0.0, needle(diameter_mm, bevel_deg));
}

TEST(NeedleSize, IsOneForTheReferenceNeedleAndWithoutALaw) {
  EXPECT_DOUBLE_EQ(factor(1.27), 1.0);
  EXPECT_EQ(haptics::needle_size_factor({}, 0.0, needle(0.7)), 1.0);
  EXPECT_DOUBLE_EQ(haptics::needle_size_factor(kLaw, 0.718, needle(0.718)), 1.0);  // a layer's own needle
}

TEST(NeedleSize, GrowsBetweenLinearlyAndQuadratically) {
  // A sharp punch's pressure falls as its diameter grows (Shergold, Fleck 2005), its force grows.
  double before = 0.0;
  double pressure = std::numeric_limits<double>::infinity();
  for (double d = 0.3; d < 3.3; d += 0.1) {
    EXPECT_GT(factor(d), before);
    before = factor(d);
    EXPECT_LT(factor(d) / (d * d), pressure);
    pressure = factor(d) / (d * d);
  }
  constexpr double kTiny = 1e-6;  // tearing alone, and spreading alone
  EXPECT_NEAR(factor(kTiny) / kTiny, 61.0 / 79.0 / 1.27, 1e-6);
  EXPECT_NEAR(factor(1e6) / 1e12, 18.0 / 79.0 / (1.27 * 1.27), 1e-6);
}

TEST(NeedleSize, FineNeedlesMatchThePublishedSkinForce) {
  // 0.48-1.00 N for human abdominal skin and fine suture needles, more the thicker (Maloney, references.md).
  EXPECT_NEAR(2.8 * factor(0.27), 0.48, 0.03);
  EXPECT_NEAR(2.8 * factor(0.53), 1.00, 0.03);
}

TEST(NeedleSize, VariesLittleWithTheBevelAngle) {
  // 15 to 60 degrees: "the insertion force does not vary too much" (PMID 32791488).
  for (const double bevel_deg : {15.0, 30.0, 45.0, 60.0}) EXPECT_NEAR(factor(1.27, bevel_deg), 1.0, 0.05) << bevel_deg;
  EXPECT_GT(factor(1.27, 70.0), 1.1);                 // towards a blunt tip
  EXPECT_EQ(factor(1.27, 90.0), factor(1.27, 70.0));  // beyond the law
  EXPECT_GT(factor(1.27, 5.0), factor(1.27, 20.0));   // a long face rubs
}

TEST(NeedleSize, ScalesPuncturesAndCutting) {
  anatomy::TissueTable table = paper_tissues();
  table.needle_size = kLaw;
  for (const double diameter_mm : {0.718, 2.108}) {
    const auto scene = haptics::make_haptic_scene(layered_patient(liver_way()), table, needle(diameter_mm));
    ASSERT_TRUE(scene.has_value());
    const double g = factor(diameter_mm);
    Driver driver(*scene);
    const auto samples = driver.move(70.0, 5.0);
    EXPECT_EQ(punctures(samples), (std::vector<int>{0, 1, 2}));
    for (const telemetry::TickSample& sample : samples) {
      if (sample.events[0].kind != telemetry::EventKind::kPuncture) continue;
      const double peaks_n[] = {2.8, 2.5, 1.5};
      EXPECT_NEAR(-sample.f_prepuncture_n, g * peaks_n[sample.events[0].id], 0.002);
    }
    EXPECT_NEAR(samples.back().f_cutting_n, -0.6 * g, 1e-9);
  }
}

TEST(NeedleSize, ABluntBevelNeedsMoreForce) {
  anatomy::NeedleSizeLaw law = kLaw;
  law.bevel_power = 0.5;
  const auto of = [&](double bevel_deg) { return haptics::needle_size_factor(law, 0.0, needle(1.27, bevel_deg)); };
  EXPECT_NEAR(of(20.0), 1.0, 1e-12);
  double before = 0.0;
  for (const double bevel_deg : {10.0, 15.0, 25.0, 45.0, 60.0, 85.0}) {
    EXPECT_GT(of(bevel_deg), before) << bevel_deg;
    before = of(bevel_deg);
  }
  EXPECT_GT(of(45.0), 1.2 * of(15.0));
}

}  // namespace
}  // namespace trocar::testing
