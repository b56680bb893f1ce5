#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/live/live_schedule.h"

namespace trocar {
namespace {

constexpr std::array kWork{1.0, 2.0, 4.0};

/// A machine that needs so long per unit of work, after the costs have been learned.
FrameCost learned(double ms_per_work) {
  FrameCost cost(kWork.size());
  for (int n = 0; n < 50; ++n) cost.note(0, kWork[0], ms_per_work * kWork[0]);
  return cost;
}

TEST(FrameCost, ExpectsNothingBeforeTheFirstMeasurement) {
  FrameCost cost(3);
  EXPECT_FALSE(cost.expected_ms(1, 2.0));
  EXPECT_EQ(cost.select_level(kWork, 1e9), 0U);
  cost.note(0, 1.0, 0.0);
  cost.note(0, 1.0, std::nan(""));
  EXPECT_FALSE(cost.expected_ms(1, 2.0)) << "no times";
}

TEST(FrameCost, LearnsTheTimePerWorkOfEachLevel) {
  FrameCost cost(3);
  // Level 2 takes 1.5 times the time that its nominal work says.
  for (int n = 0; n < 400; ++n) {
    cost.note(0, kWork[0], 10.0);
    cost.note(2, kWork[2], 60.0);
  }
  EXPECT_NEAR(*cost.expected_ms(2, kWork[2]) / *cost.expected_ms(0, kWork[0]), 6.0, 0.75);
}

TEST(FrameCost, SelectsTheFinestLevelWithinTheTarget) {
  EXPECT_EQ(learned(5.0).select_level(kWork, 50.0), 2U);
  EXPECT_EQ(learned(15.0).select_level(kWork, 50.0), 1U);
  EXPECT_EQ(learned(40.0).select_level(kWork, 50.0), 0U);
  EXPECT_EQ(learned(400.0).select_level(kWork, 50.0), 0U) << "the coarsest in any case";
}

TEST(FrameCost, KeepsALevelNearTheTarget) {
  // 90 % of the target: too close to begin with a level, good enough to stay at it.
  FrameCost cost = learned(0.9 * 50.0 / kWork[2]);
  EXPECT_EQ(cost.select_level(kWork, 50.0), 1U);
  FrameCost quick = learned(0.7 * 50.0 / kWork[2]);
  EXPECT_EQ(quick.select_level(kWork, 50.0), 2U);
  for (int n = 0; n < 50; ++n) quick.note(0, kWork[0], 0.9 * 50.0 / kWork[2]);
  EXPECT_EQ(quick.select_level(kWork, 50.0), 2U);
  for (int n = 0; n < 50; ++n) quick.note(0, kWork[0], 1.1 * 50.0 / kWork[2]);
  EXPECT_EQ(quick.select_level(kWork, 50.0), 1U);
}

TEST(FrameCost, OneInterruptedFrameChangesLittle) {
  FrameCost cost = learned(10.0);
  cost.note(0, kWork[0], 5000.0);
  // The ratio is limited to 3, of which the load takes the square root and the correction a tenth power.
  EXPECT_LT(*cost.expected_ms(0, kWork[0]), 10.0 * std::sqrt(3.0) * 1.2);
}

}  // namespace
}  // namespace trocar
