#include "ultrasound/scanner/detail/scanner_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace trocar::ultrasound::detail {
namespace {

/// Of the logarithm (0.0004 dB) and half a fine level, dB; a gray value is never finer than 0.05 dB.
constexpr double kLogError_db = 0.002;

std::vector<std::uint16_t> detected(const std::vector<float>& re, const std::vector<float>& im) {
  const std::vector<float> zero(re.size(), 0.0F);
  const std::vector<float> offset(re.size(), static_cast<float>(-kLevelFloor_db * kFineLevels_per_db));
  std::vector<std::uint16_t> level(re.size());
  detect({re.data(), im.data(), zero.data(), zero.data(), 0.0F, nullptr, nullptr, 1, 0, 0, 0, nullptr, offset.data(),
          re.size()},
         level.data());
  return level;
}

double db_of(std::uint16_t level) {
  return kLevelFloor_db + level / kFineLevels_per_db;
}

TEST(Detect, LogarithmIsExactToOneLevel) {
  std::vector<float> re, im;
  for (double db = -79.9; db < 47.4; db += 0.003) {
    const double amplitude = std::pow(10.0, db / 20.0);
    const double phase = 11.0 * db;
    re.push_back(static_cast<float>(amplitude * std::cos(phase)));
    im.push_back(static_cast<float>(amplitude * std::sin(phase)));
  }
  const std::vector<std::uint16_t> level = detected(re, im);
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double exact_db = 20.0 * std::log10(std::hypot(static_cast<double>(re[i]), static_cast<double>(im[i])));
    ASSERT_NEAR(db_of(level[i]), exact_db, kLogError_db);
  }
}

TEST(Detect, ProcessesEveryLengthCompletely) {
  for (std::size_t n = kMostLanes; n < 3 * kMostLanes; ++n) {
    const std::vector<float> re(n, 1.0F), im(n, 0.0F);
    for (const std::uint16_t level : detected(re, im)) ASSERT_NEAR(db_of(level), 0.0, kLogError_db);
  }
}

TEST(Detect, ClampsLevelsToTheRange) {
  const std::vector<float> zero(kMostLanes, 0.0F), huge(kMostLanes, 1e15F);
  EXPECT_EQ(detected(zero, zero)[0], 0);
  EXPECT_EQ(detected(huge, zero)[0], 65535);
}

TEST(Detect, NonFiniteSampleIsBlackWithoutSpreading) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(), 3e38F};
  for (const float value : bad) {
    std::vector<float> re(40, 1.0F);
    const std::vector<float> im(40, 0.0F);
    re[7] = value;
    const std::vector<std::uint16_t> level = detected(re, im);
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i == 7) {
        EXPECT_EQ(level[i], 0) << value;
      } else {
        EXPECT_NEAR(db_of(level[i]), 0.0, kLogError_db);
      }
    }
  }
}

TEST(Detect, SumsEchoNoiseAndClutter) {
  constexpr std::size_t kCount = 20;
  const std::vector<float> echo(kCount, 1.0F), noise(kCount, 10.0F), clutter(kCount, 2.0F), zero(kCount, 0.0F);
  const std::vector<float> offset(kCount, static_cast<float>(-kLevelFloor_db * kFineLevels_per_db));
  std::vector<std::uint16_t> level(kCount);
  detect({echo.data(), zero.data(), noise.data(), zero.data(), 0.1F, zero.data(), clutter.data(), 1, 0, 0, 0, nullptr,
          offset.data(), kCount},
         level.data());
  EXPECT_NEAR(db_of(level[kCount - 1]), 20.0 * std::log10(std::hypot(2.0, 2.0)), kLogError_db);
}

TEST(Persist, BlendsWithTheLastImage) {
  std::vector<std::uint16_t> state(32, 1000);
  const std::vector<std::uint16_t> fresh(32, 51000);
  persist(fresh.data(), 0.75F, 30, state.data());
  EXPECT_EQ(state[0], 13500);
  EXPECT_EQ(state[29], 13500);
}

TEST(Persist, ConvergesToAStaticImage) {
  std::vector<std::uint16_t> state(kMostLanes, 65535);
  const std::vector<std::uint16_t> fresh(kMostLanes, 20000);
  for (int i = 0; i < 300; ++i) persist(fresh.data(), 0.95F, kMostLanes, state.data());
  // Rounding stops it half a fine level / (1 - 0.95) short: 0.02 dB.
  EXPECT_NEAR(state[0], 20000, 10);
}

TEST(Detect, WeighsTheAnglesNearTheFace) {
  constexpr std::size_t kCount = 40;
  std::vector<float> re(3 * kCount, 1.0F);  // one angle of power 1, two more of power 9
  std::fill(re.begin() + kCount, re.end(), 3.0F);
  const std::vector<float> zero(3 * kCount, 0.0F), offset(kCount, 30000.0F);
  std::vector<float> share(kCount, 0.0F);
  share[3] = 1.0F;
  share[4] = 0.5F;
  std::vector<std::uint16_t> level(kCount);
  detect({re.data(), zero.data(), zero.data(), zero.data(), 0.0F, nullptr, nullptr, 1, kCount, 0, 2, share.data(),
          offset.data(), kCount},
         level.data());
  const auto power = [&](std::size_t s) { return std::pow(10.0, 0.1 * (level[s] - 30000.0) / kFineLevels_per_db); };
  EXPECT_NEAR(power(2), 1.0, 0.001);
  EXPECT_NEAR(power(3), 19.0 / 3.0, 0.005);
  EXPECT_NEAR(power(4), 5.0, 0.005);
}

}  // namespace
}  // namespace trocar::ultrasound::detail
