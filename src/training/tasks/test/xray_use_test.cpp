#include <gtest/gtest.h>

#include "tasks/action.h"

namespace trocar::tasks {
namespace {

XrayUse use_of(double time_s, double contrast_ml) {
  XrayUse use;
  use.time_s = time_s;
  use.contrast_ml = contrast_ml;
  return use;
}

TEST(ContrastInjections, AreContinuousRises) {
  const std::vector<XrayUse> uses{use_of(0.0, 0.0), use_of(1.0, 0.5), use_of(1.3, 0.8), use_of(1.4, 0.8),
                                  use_of(3.0, 0.8), use_of(3.1, 1.0), use_of(3.2, 1.5)};
  const std::vector<ContrastInjection> found = find_injections(uses);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_DOUBLE_EQ(found[0].end_s, 1.3);
  EXPECT_NEAR(found[0].ml, 0.8, 1e-12);
  EXPECT_NEAR(found[1].ml, 0.7, 1e-12);
  EXPECT_DOUBLE_EQ(found[1].total_ml, 1.5);
  double all_ml = 0.0;
  for (const ContrastInjection& one : found) all_ml += one.ml;
  EXPECT_NEAR(all_ml, uses.back().contrast_ml, 1e-12);
}

TEST(ContrastInjections, AreNoneWithoutContrast) {
  EXPECT_TRUE(find_injections({}).empty());
  const std::vector<XrayUse> uses{use_of(0.0, 0.0), use_of(1.0, 0.0)};
  EXPECT_TRUE(find_injections(uses).empty());
}

}  // namespace
}  // namespace trocar::tasks
