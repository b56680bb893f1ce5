#include <gtest/gtest.h>

#include <vector>

#include "core/random.h"
#include "ultrasound/scanner/display_settings.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {
namespace {

/// Speckle about one level, in part of the scan; the rest has no echo.
std::vector<std::uint8_t> speckle(int level, double share) {
  std::vector<std::uint8_t> levels(20000, 0);
  Random random(7);
  const auto count = static_cast<std::size_t>(share * static_cast<double>(levels.size()));
  for (std::size_t n = 0; n < count; ++n)
    levels[n] = static_cast<std::uint8_t>(level + static_cast<int>(random.uniform(-8.0, 8.0)));
  return levels;
}

TEST(AutomaticGain, BringsTissueToItsTargetGray) {
  for (const int level : {100, 120, 160, 180})
    for (const double before_db : {-20.0, 0.0, 15.0})
      for (const GrayMap map : {GrayMap::kSoft, GrayMap::kLinear, GrayMap::kHighContrast}) {
        DisplaySettings settings;
        settings.gain_db = before_db;
        settings.gray_map = map;
        const auto gain_db = automatic_gain_db(speckle(level, 0.8), settings);
        ASSERT_TRUE(gain_db);
        settings.gain_db = *gain_db;
        // The level itself is a few steps above the mean of its speckle.
        EXPECT_NEAR(gray_of_level(Scanner::level_db(static_cast<std::uint8_t>(level + 3)), settings), kAutomaticGray,
                    12)
            << level << ' ' << static_cast<int>(map);
      }
}

TEST(AutomaticGain, DoesNotDependOnTheShareWithoutEcho) {
  const DisplaySettings settings;
  EXPECT_NEAR(*automatic_gain_db(speckle(120, 0.9), settings), *automatic_gain_db(speckle(120, 0.3), settings), 0.5);
}

TEST(AutomaticGain, IsUnsetInAirAndStaysInRange) {
  const DisplaySettings settings;
  EXPECT_FALSE(automatic_gain_db({}, settings));
  EXPECT_FALSE(automatic_gain_db(speckle(120, 0.05), settings));
  EXPECT_LE(*automatic_gain_db(speckle(20, 0.9), settings), 40.0);
  EXPECT_GE(*automatic_gain_db(speckle(245, 0.9), settings), -40.0);
}

}  // namespace
}  // namespace trocar::ultrasound
