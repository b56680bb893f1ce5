#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "attempt/live/attempt_view.h"

namespace trocar::attempt {
namespace {

TEST(ForceTrace, KeepsEveryPeakWithFewPoints) {
  ForceTrace trace;
  double highest_n = 0.0, lowest_n = 0.0;
  constexpr int kTicks = 5000;
  for (int i = 0; i < kTicks; ++i) {
    double force_n = std::sin(0.003 * i);
    if (i == 1237) force_n = 7.0;  // one tick
    if (i == 2001) force_n = -5.0;
    highest_n = std::max(highest_n, force_n);
    lowest_n = std::min(lowest_n, force_n);
    trace.add({0.001 * i, 0.0, force_n});
  }
  trace.flush();
  const std::vector<ForcePoint> points = trace.take();
  const auto by_force = [](const ForcePoint& a, const ForcePoint& b) { return a.force_n < b.force_n; };
  EXPECT_EQ(std::max_element(points.begin(), points.end(), by_force)->force_n, highest_n);
  EXPECT_EQ(std::min_element(points.begin(), points.end(), by_force)->force_n, lowest_n);
  EXPECT_LT(points.size(), 5.0 * 150.0);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end(),
                             [](const ForcePoint& a, const ForcePoint& b) { return a.time_s < b.time_s; }));
  EXPECT_EQ(points.back().time_s, 0.001 * (kTicks - 1));
  EXPECT_TRUE(trace.take().empty());
}

}  // namespace
}  // namespace trocar::attempt
