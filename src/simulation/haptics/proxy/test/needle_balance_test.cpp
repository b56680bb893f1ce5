// The needle between device, shaft and tip; what tissue bears at the tip: docs/physics.md B2, B3.
#include <gtest/gtest.h>

#include "core/random.h"
#include "haptics/proxy/tip_law.h"

namespace trocar::testing {
namespace {

haptics::TipLaw border_law(double normal_n, double tangential_n) {
  haptics::TipLaw tip;
  tip.normal = Vec3::UnitZ();
  tip.border = 1.0;
  tip.law.normal_n = normal_n;
  tip.law.tangential_n = tangential_n;
  tip.law.resistance_n = 0.7;  // must not be felt on a border
  return tip;
}

/// The part of v that exceeds `threshold`.
Vec3 beyond(const Vec3& v, double threshold) {
  const double length = v.norm();
  return length > threshold && length > 0.0 ? Vec3(v * (1.0 - threshold / length)) : Vec3::Zero();
}

/// Equations (3) to (5) of paper B in space: the part of a force that the tissue does not bear. The library uses only
/// what they bear along the needle's path, threshold_along_n.
Vec3 residual_force(const Vec3& f, const haptics::TipLaw& tip) {
  const double f_normal = f.dot(tip.normal);
  const double normal = f_normal > 0.0 ? std::max(0.0, f_normal - tip.border * tip.law.normal_n) : f_normal;  // (3)
  const Vec3 tangential = beyond(f - f_normal * tip.normal, tip.border * tip.law.tangential_n);               // (4)
  return beyond(normal * tip.normal + tangential, (1.0 - tip.border) * tip.law.resistance_n);                 // (5)
}

TEST(NeedleBalance, DryFrictionHoldsTheNeedle) {
  const haptics::NeedleDrive drive{{}, {0.5, 0.0}, 0.4, 0.0, 0.001};
  const haptics::NeedleBalance held = haptics::balance_needle(drive, 1.0, 0.0);
  EXPECT_EQ(held.needle_mm, 0.0);
  EXPECT_NEAR(held.on_shaft_n, 0.4, 1e-12);  // k_c times the stretch
  EXPECT_EQ(held.on_tip_n, 0.0);
}

TEST(NeedleBalance, SetsTheSpringsInSeries) {
  stylus::CouplingParams coupling;
  coupling.damping_ns_per_mm = 0.0;
  const haptics::NeedleBalance balance = haptics::balance_needle({coupling, {}, 3.0, 0.0, 0.001}, 0.5, 0.0);
  EXPECT_NEAR(balance.on_tip_n, 3.0 * 0.5 / 1.5, 1e-12);
  EXPECT_NEAR(balance.tip_n_per_mm, 0.5 / 1.5, 1e-12);
}

TEST(TipLaw, ThresholdIsTheGreatestForceInItsDirection) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    haptics::TipLaw law = border_law(2.0, 0.5);
    law.border = random.uniform(0, 1);
    const Vec3 u = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    double greatest = 0.0;
    for (int j = 0; j < 4000; ++j) {
      const Vec3 f = 20.0 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Vec3 borne = f - residual_force(f, law);
      greatest = std::max(greatest, borne.dot(u));
    }
    EXPECT_LE(greatest, threshold_along_n(law, u) + 1e-9);
    EXPECT_GT(greatest, 0.93 * threshold_along_n(law, u));  // sampled: nearly reached
  }
}

}  // namespace
}  // namespace trocar::testing
