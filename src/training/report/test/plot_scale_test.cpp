#include "report/plot_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"

namespace trocar::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Whether the step is 1, 2 or 5 times a power of ten.
bool is_nice(double step) {
  const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  return std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 || std::abs(mantissa - 5) < 1e-6;
}

TEST(PlotScale, StepsAreRoundAndModerateInNumber) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    const double size = std::pow(10.0, random.uniform(-6.0, 6.0));
    const double low = random.uniform(-10.0, 10.0) * size;
    const AxisRange range{low, low + size};
    const int at_most = 1 + static_cast<int>(random.uniform(0.0, 15.0));
    const double step = nice_step(range, at_most);
    EXPECT_TRUE(is_nice(step)) << step;
    EXPECT_LE((range.high - range.low) / step, at_most + 1e-6);
    EXPECT_GT((range.high - range.low) / step, at_most / 2.5 - 1e-6);  // The next smaller step would be too many.
  }
}

TEST(PlotScale, TicksAreAllMultiplesInsideTheRange) {
  Random random(4);
  for (int round = 0; round < 2000; ++round) {
    const double size = std::pow(10.0, random.uniform(-4.0, 4.0));
    const double low = random.uniform(-3.0, 3.0) * size;
    const AxisRange range{low, low + size};
    const double step = nice_step(range, 8);
    const auto ticks = ticks_in(range, step);
    ASSERT_FALSE(ticks.empty());
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      EXPECT_GE(ticks[i], range.low - 1e-6 * step);
      EXPECT_LE(ticks[i], range.high + 1e-6 * step);
      EXPECT_NEAR(std::remainder(ticks[i], step), 0.0, 1e-6 * step);
      if (i > 0) {
        EXPECT_NEAR(ticks[i] - ticks[i - 1], step, 1e-6 * step);
      }
    }
    EXPECT_LT(ticks.front() - range.low, step);
    EXPECT_LT(range.high - ticks.back(), step);
  }
}

TEST(PlotScale, RoundedRangeContainsTheRangeAndEndsOnTicks) {
  for (const AxisRange range : {AxisRange{0.0, 2.81}, AxisRange{-1.3, 0.0}, AxisRange{0.0, 0.3}, AxisRange{-7, 12}}) {
    const double step = nice_step(range, 6);
    const AxisRange nice = nice_range(range, step);
    EXPECT_LE(nice.low, range.low);
    EXPECT_GE(nice.high, range.high - 1e-9);
    EXPECT_LT(range.low - nice.low, step);
    EXPECT_LT(nice.high - range.high, step);
    EXPECT_NEAR(std::remainder(nice.low, step), 0.0, 1e-9);
    EXPECT_NEAR(std::remainder(nice.high, step), 0.0, 1e-9);
  }
}

TEST(PlotScale, TickLabelsMatchTheirStep) {
  EXPECT_EQ(tick_text(0.5, 0.5), "0.5");
  EXPECT_EQ(tick_text(2.0, 0.5), "2.0");
  EXPECT_EQ(tick_text(20.0, 20.0), "20");
  EXPECT_EQ(tick_text(-0.05, 0.05), "−0.05");
  EXPECT_EQ(tick_text(0.0, 0.1), "0.0");
}

TEST(PlotScale, EmptyAndConstantRangesAreDrawable) {
  for (const std::vector<double>& values :
       {std::vector<double>{}, {kNaN}, {3.0}, {0.0, 0.0}, {-1e9, -1e9}, {1e-300}, {kNaN, 2.0}}) {
    const AxisRange range = range_of(values);
    EXPECT_LT(range.low, range.high);
    EXPECT_GT(nice_step(range, 5), 0.0);
    for (const double value : values)
      if (std::isfinite(value)) {
        EXPECT_TRUE(range.low <= value && value <= range.high);
      }
  }
}

TEST(PlotScale, ThinningKeepsPeaksAndOrder) {
  Random random(5);
  std::vector<Point2> line;
  for (int i = 0; i < 20000; ++i) line.emplace_back(0.02 * i, random.normal());
  line[7777].y() = 99.0;
  line[12345].y() = -99.0;
  const auto thin = thin_out(line, 1.0);
  EXPECT_LE(thin.size(), 4u * 401u);
  EXPECT_GE(thin.size(), 400u);
  for (std::size_t i = 1; i < thin.size(); ++i) EXPECT_LE(thin[i - 1].x(), thin[i].x());
  EXPECT_TRUE(std::any_of(thin.begin(), thin.end(), [](const Point2& p) { return p.y() == 99.0; }));
  EXPECT_TRUE(std::any_of(thin.begin(), thin.end(), [](const Point2& p) { return p.y() == -99.0; }));
  EXPECT_EQ(thin.front(), line.front());
  EXPECT_EQ(thin.back(), line.back());
}

TEST(PlotScale, ThinningKeepsAShortLineUnchanged) {
  const std::vector<Point2> line{{0, 0}, {10, 3}, {5, 1}, {20, 2}};  // Also where it turns back.
  EXPECT_EQ(thin_out(line, 1.0), line);
  EXPECT_TRUE(thin_out({}, 1.0).empty());
}

TEST(PlotScale, LabelsMoveOnlyToAvoidOverlap) {
  const std::vector<double> wanted{10.0, 12.0, 14.0, 80.0, 99.0};
  const std::vector<double> widths{10.0, 10.0, 10.0, 10.0, 10.0};
  const auto centers = spread_labels(wanted, widths, {0.0, 100.0});
  for (std::size_t i = 1; i < centers.size(); ++i) EXPECT_GE(centers[i] - centers[i - 1], 10.0 - 1e-9);
  EXPECT_EQ(centers[3], 80.0);
  EXPECT_EQ(centers[4], 95.0);
  EXPECT_GE(centers[0], 5.0);
}

}  // namespace
}  // namespace trocar::report
