#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "xray/physics/materials.h"

namespace trocar::xray {
namespace {

// NIST, ICRU 44: skeletal muscle.
constexpr ElementShare kMuscle[] = {{1, 0.102},  {6, 0.143},  {7, 0.034},  {8, 0.710}, {11, 0.001},
                                    {15, 0.002}, {16, 0.003}, {17, 0.001}, {19, 0.004}};

TEST(Attenuation, MatchesTheTableAt60Kev) {
  // NIST's tables (Hubbell and Seltzer); 0.5 % is their stated spread between editions.
  EXPECT_NEAR(attenuation_cm2_per_g(composition_of(Basis::kWater), 60.0), 0.2059, 0.001);
  EXPECT_NEAR(attenuation_cm2_per_g(kMuscle, 60.0), 0.2048, 0.001);
  EXPECT_NEAR(attenuation_cm2_per_g(composition_of(Basis::kBone), 60.0), 0.3102, 0.0015);
  EXPECT_NEAR(attenuation_cm2_per_g(composition_of(Basis::kIodine), 60.0), 7.577, 0.04);
}

TEST(Attenuation, Halves60KevIn34MmOfWater) {
  const double per_mm = 0.1 * attenuation_cm2_per_g(composition_of(Basis::kWater), 60.0);
  EXPECT_NEAR(std::numbers::ln2 / per_mm, 33.66, 0.01 * 33.66);
}

TEST(Attenuation, RisesAtTheIodineEdge) {
  const auto iodine = composition_of(Basis::kIodine);
  EXPECT_GT(attenuation_cm2_per_g(iodine, 33.3), 4.0 * attenuation_cm2_per_g(iodine, 33.0));
}

TEST(AirEnergyAbsorption, FollowsItsTableSmoothly) {
  EXPECT_NEAR(air_energy_absorption_cm2_per_g(60.0), 0.03041, 1e-9);
  EXPECT_NEAR(air_energy_absorption_cm2_per_g(1000.0), 0.02672, 1e-9);
  // Below 20 keV photoelectric absorption rules: energy to the power of about -3.1.
  const double exponent =
      std::log(air_energy_absorption_cm2_per_g(17.0) / air_energy_absorption_cm2_per_g(12.0)) / std::log(17.0 / 12.0);
  EXPECT_NEAR(exponent, -3.12, 0.06);
  for (double kev = 11.0; kev < 90.0; kev += 1.0)
    EXPECT_LT(air_energy_absorption_cm2_per_g(kev), air_energy_absorption_cm2_per_g(kev - 1.0)) << kev;
}

TEST(Attenuation, CoversEveryMaterial) {
  for (const Basis basis : {Basis::kWater, Basis::kBone, Basis::kIodine, Basis::kSteel}) {
    double sum = 0.0;
    for (const ElementShare& element : composition_of(basis)) sum += element.share;
    EXPECT_NEAR(sum, 1.0, 1e-4);
  }
  EXPECT_EQ(attenuation_cm2_per_g(aluminium(), 1e4), 0.0);
  EXPECT_EQ(attenuation_cm2_per_g(aluminium(), std::nan("")), 0.0);
}

}  // namespace
}  // namespace trocar::xray
