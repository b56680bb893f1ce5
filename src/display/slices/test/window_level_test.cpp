#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "slices/paint_slice.h"

namespace trocar::slices {
namespace {

TEST(WindowLevel, MapsTheWindowOntoTheGrays) {
  const std::vector<float> hu{-3000, -160, -159, 40, 140, 240, 3000, std::numeric_limits<float>::quiet_NaN()};
  std::vector<std::uint8_t> gray(hu.size(), 77);
  apply_window(hu, {40.0, 400.0}, gray);
  EXPECT_EQ(gray, (std::vector<std::uint8_t>{0, 0, 1, 128, 191, 255, 255, 0}));
}

TEST(WindowLevel, MatchesTheFormulaForEveryHuAndPreset) {
  std::vector<float> hu;
  for (int value = -1024; value <= 3071; ++value) hu.push_back(static_cast<float>(value));
  std::vector<std::uint8_t> gray(hu.size());
  for (const WindowPreset& preset : kWindowPresets) {
    apply_window(hu, preset.window, gray);
    for (std::size_t n = 0; n < hu.size(); ++n) {
      const double share = (static_cast<double>(hu[n]) - preset.window.center_hu) / preset.window.width_hu + 0.5;
      const double wanted = 255.0 * std::min(std::max(share, 0.0), 1.0);
      ASSERT_NEAR(gray[n], wanted, 0.501) << preset.name << ' ' << hu[n];  // rounded to whole steps
    }
  }
}

TEST(WindowLevel, FindsPresetsByName) {
  EXPECT_EQ(window_name({-600.0, 1500.0}), "Lung");
  EXPECT_EQ(window_name({-600.0, 1490.0}), "");
}

}  // namespace
}  // namespace trocar::slices
