#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace trocar {
inline namespace core {
namespace {

constexpr int kSamples = 1'000'000;

/// Five standard errors: a wrong alarm once in a million seeds, and the seeds are fixed.
double tolerance(double standard_deviation) {
  return 5.0 * standard_deviation / std::sqrt(static_cast<double>(kSamples));
}

TEST(Mix64, IsSplitMix64) {
  // First outputs of the reference generator started at 0.
  EXPECT_EQ(mix64(0), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(mix64(0x9e3779b97f4a7c15ULL), 0x6e789e6aa1b965f4ULL);
}

TEST(Random, GivesTheSameSequenceForTheSameSeed) {
  Random a(42);
  Random b(42);
  Random c(43);
  int equal_to_c = 0;
  for (int n = 0; n < 1000; ++n) {
    const auto value = a.next();
    EXPECT_EQ(value, b.next());
    equal_to_c += value == c.next() ? 1 : 0;
  }
  EXPECT_EQ(equal_to_c, 0);
}

TEST(Random, UniformHasTheRightMomentsAndRange) {
  Random random(1);
  double sum = 0.0;
  double squares = 0.0;
  double products = 0.0;  // of neighbours
  double previous = 0.5;
  for (int n = 0; n < kSamples; ++n) {
    const double x = random.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sum += x;
    squares += (x - 0.5) * (x - 0.5);
    products += (x - 0.5) * (previous - 0.5);
    previous = x;
  }
  EXPECT_NEAR(sum / kSamples, 0.5, tolerance(std::sqrt(1.0 / 12.0)));
  EXPECT_NEAR(squares / kSamples, 1.0 / 12.0, tolerance(std::sqrt(1.0 / 180.0)));
  EXPECT_NEAR(products / kSamples, 0.0, tolerance(1.0 / 12.0));
}

TEST(Random, UniformFillsItsBinsEvenly) {
  Random random(2);
  constexpr int kBins = 1000;
  std::vector<int> counts(kBins, 0);
  for (int n = 0; n < kSamples; ++n) ++counts[static_cast<std::size_t>(random.uniform() * kBins)];
  double chi_squared = 0.0;
  const double expected = static_cast<double>(kSamples) / kBins;
  for (const int count : counts) chi_squared += (count - expected) * (count - expected) / expected;
  EXPECT_NEAR(chi_squared, kBins - 1, 5.0 * std::sqrt(2.0 * (kBins - 1)));
}

TEST(Random, UniformKeepsToItsBounds) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const double x = random.uniform(-2.0, 3.0);
    EXPECT_GE(x, -2.0);
    EXPECT_LT(x, 3.0);
  }
}

TEST(Random, NormalHasTheRightMoments) {
  Random random(4);
  double sum = 0.0;
  double squares = 0.0;
  double cubes = 0.0;
  double fourth = 0.0;
  for (int n = 0; n < kSamples; ++n) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    cubes += x * x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / kSamples, 0.0, tolerance(1.0));
  EXPECT_NEAR(squares / kSamples, 1.0, tolerance(std::sqrt(2.0)));
  EXPECT_NEAR(cubes / kSamples, 0.0, tolerance(std::sqrt(15.0)));
  EXPECT_NEAR(fourth / kSamples, 3.0, tolerance(std::sqrt(96.0)));
}

TEST(Uniform01, IsAFunctionOfSeedAndCounter) {
  EXPECT_EQ(uniform01(7, 11), uniform01(7, 11));
  std::set<double> values;
  for (std::uint64_t seed = 0; seed < 30; ++seed)
    for (std::uint64_t counter = 0; counter < 30; ++counter) values.insert(uniform01(seed, counter));
  EXPECT_EQ(values.size(), 900u);
}

}  // namespace
}  // namespace core
}  // namespace trocar
