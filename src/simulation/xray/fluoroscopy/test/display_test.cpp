#include "xray/fluoroscopy/display.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trocar::xray {
namespace {

constexpr int kPixels = 64;
constexpr std::size_t kCount = static_cast<std::size_t>(kPixels) * kPixels;

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row * kPixels + column);
}

CArm small_arm(double columns = 1.0, double rows = 1.0) {
  CArm arm;
  arm.pixels = kPixels;
  arm.collimation = {columns, rows};
  return arm;
}

DisplaySettings plain() {
  DisplaySettings settings;
  settings.edge_gain = 0.0;
  settings.range_compression = 0.0;
  return settings;
}

/// Attenuation that rises evenly from 1 to 3 along the columns.
std::vector<float> ramp() {
  std::vector<float> signal(kCount);
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column)
      signal[at(column, row)] = static_cast<float>(std::exp(-1.0 - 2.0 * column / (kPixels - 1.0)));
  return signal;
}

TEST(Display, ShowsAttenuationLinearlyWithDenseDark) {
  const auto signal = ramp();
  const auto values = shown_values(signal, kPixels, kPixels, plain(), field_pixels(small_arm()));
  const image::GrayImage image = to_gray(values, kPixels, kPixels, {1.0F, 3.0F}, false, field_pixels(small_arm()));
  for (int column = 0; column < kPixels; ++column)
    EXPECT_NEAR(image.pixels[at(column, 9)], 255.0 * (0.95 - 0.9 * column / 63.0), 1.0);
  const image::GrayImage inverted = to_gray(values, kPixels, kPixels, {1.0F, 3.0F}, true, field_pixels(small_arm()));
  for (std::size_t n = 0; n < kCount; ++n) EXPECT_NEAR(inverted.pixels[n] + image.pixels[n], 255, 1);
}

TEST(Display, KeepsDifferencesBeyondTheWindow) {
  const auto signal = ramp();
  const FieldPixels field = field_pixels(small_arm());
  const auto values = shown_values(signal, kPixels, kPixels, plain(), field);
  const image::GrayImage image = to_gray(values, kPixels, kPixels, {1.8F, 2.2F}, false, field);
  for (int column = 1; column < kPixels; ++column)
    EXPECT_LE(image.pixels[at(column, 9)], image.pixels[at(column - 1, 9)]);
  const auto darkest_in = at(static_cast<int>(0.6 * 63), 9);  // at 2.2
  EXPECT_GT(image.pixels[darkest_in], image.pixels[darkest_in + 2]) << "a wire in contrast agent";
  EXPECT_EQ(image.pixels[at(0, 9)], 255);
  EXPECT_EQ(image.pixels[at(63, 9)], 0);
}

TEST(Display, ShowsTheSignalIfLinear) {
  DisplaySettings settings = plain();
  settings.is_logarithmic = false;
  std::vector<float> signal(kCount, 0.25F);
  signal[at(3, 3)] = 0.5F;
  const auto values = shown_values(signal, kPixels, kPixels, settings, field_pixels(small_arm()));
  const image::GrayImage image = to_gray(values, kPixels, kPixels, {-0.5F, 0.0F}, false, field_pixels(small_arm()));
  EXPECT_NEAR(image.pixels[at(3, 3)], 0.95 * 255.0, 1.0);
  EXPECT_NEAR(image.pixels[at(9, 9)], 127.5, 1.0);
}

TEST(Display, FindsTheWindowExcludingDirectRadiation) {
  auto signal = ramp();
  const CArm arm = small_arm(0.5, 0.5);
  const FieldPixels field = field_pixels(arm);
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column) {
      const bool is_inside =
          column >= field.first_column && column < field.last_column && row >= field.first_row && row < field.last_row;
      if (!is_inside) signal[at(column, row)] = 1e-5F;
    }
  for (int row = field.first_row; row < field.last_row; ++row) signal[at(field.first_column, row)] = 0.99F;
  const auto values = shown_values(signal, kPixels, kPixels, plain(), field_pixels(small_arm()));
  const GrayWindow window = window_of(values, signal, kPixels, field);
  EXPECT_NEAR(window.low, 1.0 + 2.0 * (field.first_column + 1) / 63.0, 0.07);
  EXPECT_NEAR(window.high, 1.0 + 2.0 * (field.last_column - 1) / 63.0, 0.07);
}

TEST(Display, LungsAtTheEdgeDoNotDarkenTheAbdomen) {
  // Abdomen with attenuations from 4 to 5, and a lung of 1 in a quarter of the field.
  std::vector<float> signal(kCount);
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column)
      signal[at(column, row)] = row < 16 ? std::exp(-1.0F) : std::exp(-4.0F - static_cast<float>(column) / 63.0F);
  const FieldPixels field = field_pixels(small_arm());
  const auto values = shown_values(signal, kPixels, kPixels, plain(), field);
  const image::GrayImage image =
      to_gray(values, kPixels, kPixels, window_of(values, signal, kPixels, field), false, field);
  EXPECT_EQ(image.pixels[at(32, 8)], 255);
  EXPECT_GT(image.pixels[at(0, 40)], 120);  // the thinnest part of the abdomen
  EXPECT_LT(image.pixels[at(63, 40)], 15);
}

TEST(Display, BlackensTheShutters) {
  const std::vector<float> values(kCount, 0.0F);
  const image::GrayImage image =
      to_gray(values, kPixels, kPixels, {1.0F, 2.0F}, false, field_pixels(small_arm(0.5, 0.25)));
  int lit = 0;
  for (int row = 0; row < kPixels; ++row)
    for (int column = 0; column < kPixels; ++column) {
      const bool is_inside = column >= 16 && column < 48 && row >= 24 && row < 40;
      EXPECT_EQ(image.pixels[at(column, row)], is_inside ? 255 : 0);
      lit += is_inside ? 1 : 0;
    }
  EXPECT_EQ(lit, 32 * 16);
}

TEST(Display, EnhancesEdgesAndKeepsUniformAreas) {
  std::vector<float> signal(kCount, std::exp(-1.0F));
  for (int row = 0; row < kPixels; ++row)
    for (int column = 32; column < kPixels; ++column) signal[at(column, row)] = std::exp(-2.0F);
  DisplaySettings settings = plain();
  settings.edge_gain = 1.0;
  const auto values = shown_values(signal, kPixels, kPixels, settings, field_pixels(small_arm()));
  EXPECT_NEAR(values[at(3, 32)], 1.0, 1e-3);
  EXPECT_NEAR(values[at(60, 32)], 2.0, 1e-3);
  EXPECT_GT(values[at(32, 32)], 2.3);
  EXPECT_LT(values[at(31, 32)], 0.7);
}

TEST(Display, CompressesSlowDifferencesAndKeepsDetail) {
  auto signal = ramp();
  signal[at(40, 20)] *= std::exp(-0.2F);
  DisplaySettings settings = plain();
  const auto before = shown_values(signal, kPixels, kPixels, settings, field_pixels(small_arm()));
  settings.range_compression = 0.6;
  const auto after = shown_values(signal, kPixels, kPixels, settings, field_pixels(small_arm()));
  const double slope = before[at(44, 32)] - before[at(20, 32)];
  EXPECT_NEAR(after[at(44, 32)] - after[at(20, 32)], 0.4 * slope, 0.04 * slope);
  EXPECT_NEAR(after[at(40, 20)] - after[at(40, 21)], 0.2, 0.02);
}

TEST(Display, KeepsRibsAtTheLungEdgeWithoutHalo) {
  constexpr int kBig = 256;
  std::vector<float> signal(static_cast<std::size_t>(kBig) * kBig);
  const auto place = [](int column, int row) { return static_cast<std::size_t>(row * kBig + column); };
  const auto is_rib = [](int row) { return row % 64 >= 32 && row % 64 < 40; };
  for (int row = 0; row < kBig; ++row)
    for (int column = 0; column < kBig; ++column)  // lung, then liver, and ribs across both
      signal[place(column, row)] = std::exp((column < kBig / 2 ? -2.0F : -4.0F) - (is_rib(row) ? 0.1F : 0.0F));
  CArm arm = small_arm();
  arm.pixels = kBig;
  DisplaySettings settings = plain();
  settings.range_compression = 0.6;
  const auto values = shown_values(signal, kBig, kBig, settings, field_pixels(arm));
  const auto rib_at = [&](int column) { return values[place(column, 100)] - values[place(column, 80)]; };
  EXPECT_NEAR(values[place(236, 80)] - values[place(20, 80)], 0.4 * 2.0, 0.1);
  for (const int column : {20, 236}) EXPECT_GT(rib_at(column), 0.09) << column;
  for (const int column : {120, 136}) EXPECT_GT(rib_at(column), 0.035) << column;
  for (int column = 1; column < kBig; ++column)  // no dark or bright seam along the edge
    EXPECT_GT(values[place(column, 80)] - values[place(column - 1, 80)], -0.01) << column;
}

TEST(Display, HasNoSeamAtTheShutters) {
  std::vector<float> signal(kCount, 0.0F);
  const FieldPixels field = field_pixels(small_arm(0.5, 0.5));
  for (int row = field.first_row; row < field.last_row; ++row)
    for (int column = field.first_column; column < field.last_column; ++column) signal[at(column, row)] = 0.1F;
  const auto values = shown_values(signal, kPixels, kPixels, DisplaySettings{}, field);
  for (const float value : values) EXPECT_NEAR(value, -std::log(0.1), 1e-4);
}

TEST(MaskSubtraction, ShowsTheAttenuationThatWasAdded) {
  MaskSubtraction subtraction;
  auto signal = ramp();
  EXPECT_EQ(subtraction.difference(signal)[7], 0.0F);
  for (int n = 0; n < 4; ++n) {
    auto mask = signal;
    for (float& value : mask) value *= n % 2 == 0 ? 1.1F : 0.9F;  // the mean is the signal
    subtraction.add_mask(mask);
  }
  EXPECT_EQ(subtraction.mask_frames(), 4);
  signal[at(20, 20)] *= std::exp(-0.3F);
  const auto difference = subtraction.difference(signal);
  for (std::size_t n = 0; n < kCount; ++n) EXPECT_NEAR(difference[n], n == at(20, 20) ? 0.3 : 0.0, 1e-5);
}

TEST(RoadMap, KeepsTheGreatestOpacificationAndLightensIt) {
  RoadMap map;
  std::vector<float> difference(kCount, 0.0F);
  difference[at(5, 5)] = 0.4F;
  map.add(difference);
  difference[at(5, 5)] = 0.1F;
  difference[at(6, 5)] = 0.2F;
  map.add(difference);
  EXPECT_FLOAT_EQ(map.greatest()[at(5, 5)], 0.4F);
  EXPECT_FLOAT_EQ(map.greatest()[at(6, 5)], 0.2F);
  image::GrayImage image{kPixels, kPixels, std::vector<std::uint8_t>(kCount, 100)};
  map.overlay(0.05F, 0.4F, image);
  EXPECT_GT(image.pixels[at(5, 5)], image.pixels[at(6, 5)]);
  EXPECT_GT(image.pixels[at(6, 5)], 100);
  EXPECT_EQ(image.pixels[at(9, 9)], 100);
}

}  // namespace
}  // namespace trocar::xray
