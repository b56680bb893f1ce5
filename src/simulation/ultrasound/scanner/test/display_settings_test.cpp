#include "ultrasound/scanner/display_settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::ultrasound {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTgcDepth_mm = 160.0;
constexpr double kTgcFrequency_mhz = 3.5;

DisplaySettings without_automatic_tgc() {
  DisplaySettings settings;
  settings.automatic_tgc_db_per_cm_mhz = 0.0;
  return settings;
}

double slider_depth_mm(int slider) {
  return (slider + 0.5) / kTgcSliders * kTgcDepth_mm;
}

TEST(DisplaySettings, DefaultsAreInRange) {
  EXPECT_TRUE(check(DisplaySettings{}));
}

TEST(DisplaySettings, MarkedSideIsOnTheLeftByDefault) {
  EXPECT_TRUE(DisplaySettings{}.is_mirrored);
}

TEST(DisplaySettings, ErrorNamesTheInvalidSetting) {
  DisplaySettings settings;
  settings.dynamic_range_db = 10.0;
  ASSERT_FALSE(check(settings));
  EXPECT_NE(check(settings).error().text().find("dynamic range of 10 dB"), std::string::npos);
  EXPECT_EQ(check(settings).error().exit_status, 2);

  settings = {};
  settings.tgc_db[2] = kNan;
  ASSERT_FALSE(check(settings));
  EXPECT_NE(check(settings).error().text().find("slider 3"), std::string::npos);

  settings = {};
  settings.persistence = 1.0;  // nothing new would ever be seen
  EXPECT_FALSE(check(settings));
}

TEST(DisplaySettings, ClampsInvalidSettings) {
  DisplaySettings settings;
  settings.gain_db = 1e9;
  settings.dynamic_range_db = kNan;
  settings.tgc_db[7] = -std::numeric_limits<double>::infinity();
  const DisplaySettings held = within_ranges(settings);
  EXPECT_TRUE(check(held));
  EXPECT_EQ(held.gain_db, 40.0);
  EXPECT_EQ(held.dynamic_range_db, DisplaySettings{}.dynamic_range_db);
  EXPECT_EQ(held.tgc_db[7], -20.0);
}

TEST(DisplaySettings, GrayMapsAreFoundByName) {
  for (const GrayMap map : {GrayMap::kLinear, GrayMap::kSoft, GrayMap::kHighContrast}) {
    EXPECT_EQ(parse_gray_map(name_of(map)), map);
  }
  EXPECT_FALSE(parse_gray_map("sepia"));
}

TEST(Tgc, AutomaticPartCompensatesTheRoundTripLoss) {
  DisplaySettings settings;
  settings.automatic_tgc_limit_db = 120.0;
  const double near_db = tgc_gain_db(settings, 20.0, kTgcDepth_mm, kTgcFrequency_mhz);
  const double far_db = tgc_gain_db(settings, 60.0, kTgcDepth_mm, kTgcFrequency_mhz);
  EXPECT_NEAR(far_db - near_db, 2.0 * 0.5 * kTgcFrequency_mhz * 4.0, 0.02);
}

TEST(Tgc, AutomaticPartSaturatesSmoothlyAtItsLimit) {
  const DisplaySettings settings;
  EXPECT_NEAR(tgc_gain_db(settings, 300.0, 300.0, 15.0), settings.automatic_tgc_limit_db, 0.02);
  EXPECT_NEAR(tgc_gain_db(settings, 0.0, 300.0, 15.0), 0.0, 1e-9);
  double last_slope = 2.0 * 0.5 * kTgcFrequency_mhz * 0.1;
  for (double depth_mm = 1.0; depth_mm < kTgcDepth_mm; depth_mm += 1.0) {
    const double slope = tgc_gain_db(settings, depth_mm, kTgcDepth_mm, kTgcFrequency_mhz) -
                         tgc_gain_db(settings, depth_mm - 1.0, kTgcDepth_mm, kTgcFrequency_mhz);
    EXPECT_GE(slope, 0.0);
    EXPECT_LE(slope, last_slope + 1e-9);
    last_slope = slope;
  }
}

TEST(Tgc, EachSliderSetsTheGainAtItsDepth) {
  DisplaySettings settings = without_automatic_tgc();
  const double flat_db = tgc_gain_db(settings, 80.0, kTgcDepth_mm, kTgcFrequency_mhz);
  EXPECT_NEAR(flat_db, 0.0, 1e-4);
  settings.tgc_db = {-12.0, 3.0, 3.0, 20.0, -20.0, 0.0, 1.0, 7.0};
  for (int i = 0; i < kTgcSliders; ++i) {
    EXPECT_NEAR(tgc_gain_db(settings, slider_depth_mm(i), kTgcDepth_mm, kTgcFrequency_mhz),
                settings.tgc_db[static_cast<std::size_t>(i)], 1e-4);
  }
  EXPECT_NEAR(tgc_gain_db(settings, 0.0, kTgcDepth_mm, kTgcFrequency_mhz), -12.0, 1e-4);
  EXPECT_NEAR(tgc_gain_db(settings, kTgcDepth_mm, kTgcDepth_mm, kTgcFrequency_mhz), 7.0, 1e-4);
}

TEST(Tgc, NeverLeavesTheRangeOfNeighbouringSliders) {
  DisplaySettings settings = without_automatic_tgc();
  settings.tgc_db = {0.0, 0.0, 20.0, 20.0, -20.0, -19.0, 5.0, 5.0};
  for (int i = 0; i + 1 < kTgcSliders; ++i) {
    const double a = settings.tgc_db[static_cast<std::size_t>(i)];
    const double b = settings.tgc_db[static_cast<std::size_t>(i) + 1];
    for (double t = 0.0; t <= 1.0; t += 0.05) {
      const double depth_mm = slider_depth_mm(i) + t * kTgcDepth_mm / kTgcSliders;
      const double db = tgc_gain_db(settings, depth_mm, kTgcDepth_mm, kTgcFrequency_mhz);
      EXPECT_GE(db, std::min(a, b) - 1e-4);
      EXPECT_LE(db, std::max(a, b) + 1e-4);
    }
  }
}

TEST(GrayMap, RisesFromBlackToWhiteOverTheDynamicRange) {
  for (const GrayMap map : {GrayMap::kLinear, GrayMap::kSoft, GrayMap::kHighContrast}) {
    DisplaySettings settings;
    settings.gray_map = map;
    EXPECT_EQ(gray_of_level(kWhite_db, settings), 255);
    EXPECT_EQ(gray_of_level(kWhite_db - settings.dynamic_range_db, settings), 0);
    int last = -1;
    for (double db = -90.0; db < 60.0; db += 0.25) {
      const int gray = gray_of_level(db, settings);
      EXPECT_GE(gray, last);
      last = gray;
    }
  }
}

TEST(GrayMap, GainMovesLevels) {
  DisplaySettings louder;
  louder.gain_db = 7.0;
  for (double db = -40.0; db < 20.0; db += 1.0) {
    EXPECT_EQ(gray_of_level(db, louder), gray_of_level(db + 7.0, DisplaySettings{}));
  }
}

TEST(GrayMap, LinearIsProportionalToDecibels) {
  DisplaySettings settings;
  settings.gray_map = GrayMap::kLinear;
  settings.dynamic_range_db = 51.0;
  EXPECT_EQ(gray_of_level(kWhite_db - 10.0, settings), 205);
  EXPECT_EQ(gray_of_level(kWhite_db - 40.0, settings), 55);
}

}  // namespace
}  // namespace trocar::ultrasound
