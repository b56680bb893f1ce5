#include "haptics/coupling/balance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace trocar::haptics {
namespace {

AxialBalance random_balance(Random& random) {
  AxialBalance balance;
  balance.s_previous_mm = random.uniform(-5, 60);
  balance.s_device_mm = balance.s_previous_mm + random.uniform(-4, 6);
  balance.v_device_mm_per_s = random.uniform(-100, 100);
  balance.dt_s = random.uniform(1e-5, 2e-3);
  balance.coupling = {random.uniform(0.1, 3.5), random.uniform(0.0, 0.02)};
  balance.loading = {random.uniform(0.01, 20.0), random.uniform(0.0, 0.05), random.uniform(0.05, 5.0)};
  balance.surface_mm = balance.s_previous_mm + random.uniform(-1, 2);
  balance.viscous_ns_per_mm = random.uniform(0.0, 0.1);
  balance.noise_n = random.uniform(-0.2, 0.2);
  balance.cutting_n = random.uniform(0.0, 1.0);
  balance.cut_to_mm = balance.s_previous_mm + random.uniform(-1, 1);
  return balance;
}

TEST(Solve, BalancesResistanceAndCoupling) {
  Random random(11);
  int balanced = 0;
  for (int i = 0; i < 20000; ++i) {
    const AxialBalance balance = random_balance(random);
    const AxialSolution solution = solve(balance);
    ASSERT_FALSE(solution.hit_bound);
    ASSERT_TRUE(std::isfinite(solution.s_mm));
    // At the step of the cutting force the balance jumps over zero: then both sides enclose it.
    constexpr double kTiny_mm = 1e-7;
    ASSERT_LE(balance.unbalance_n(solution.s_mm - kTiny_mm), 1e-6);
    ASSERT_GE(balance.unbalance_n(solution.s_mm + kTiny_mm), -1e-6);
    balanced += std::abs(balance.unbalance_n(solution.s_mm)) < 1e-6 ? 1 : 0;
  }
  EXPECT_GT(balanced, 17000);
}

TEST(Solve, FollowsTheDeviceWithoutResistance) {
  AxialBalance balance;
  balance.s_previous_mm = 1.0;
  balance.s_device_mm = 1.05;
  balance.v_device_mm_per_s = 50.0;
  EXPECT_NEAR(solve(balance).s_mm, 1.05, 1e-9);
}

TEST(Solve, FlagsInputWithoutABalance) {
  AxialBalance balance;
  balance.s_device_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(solve(balance).hit_bound);
  EXPECT_TRUE(std::isfinite(solve(balance).s_mm));
}

}  // namespace
}  // namespace trocar::haptics
