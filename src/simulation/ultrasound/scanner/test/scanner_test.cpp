#include "ultrasound/scanner/scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/random.h"
#include "core/testing/allocation_guard.h"

namespace trocar::ultrasound {
namespace {

constexpr int kFrameLines = 96;
constexpr int kSamples = 512;
constexpr double kFrequency_mhz = 3.5;

/// A frame without any echo.
BasebandFrame silent_frame() {
  BasebandFrame frame;
  frame.geometry.lines = kFrameLines;
  frame.geometry.samples = kSamples;
  frame.geometry.radius_mm = 55.0;
  frame.geometry.line_step = 1.1 / (kFrameLines - 1);
  frame.geometry.depth_mm = 160.0;
  frame.beam.frequency_mhz = kFrequency_mhz;
  frame.beam.axial_sigma_mm = 0.14;
  frame.re.assign(kFrameLines * kSamples, 0.0F);
  frame.im.assign(kFrameLines * kSamples, 0.0F);
  frame.contact.assign(kFrameLines, 1.0F);
  return frame;
}

/// Speckle of liver: complex Gaussian, root mean square 1 at the face, 0.5 dB/cm/MHz.
BasebandFrame liver_frame(std::uint64_t seed) {
  BasebandFrame frame = silent_frame();
  Random random(seed);
  for (std::size_t i = 0; i < frame.re.size(); ++i) {
    const double depth_mm = (static_cast<double>(i % kSamples) + 0.5) * frame.geometry.sample_mm();
    const double level = std::pow(10.0, -2.0 * 0.5 * kFrequency_mhz * depth_mm / 10.0 / 20.0) / std::sqrt(2.0);
    frame.re[i] = static_cast<float>(level * random.normal());
    frame.im[i] = static_cast<float>(level * random.normal());
  }
  return frame;
}

std::size_t sample_of_depth(double depth_mm) {
  return static_cast<std::size_t>(depth_mm / 160.0 * kSamples);
}

/// Mean power of the levels between two depths, dB.
double level_between_db(const Scanner& scanner, double from_mm, double to_mm) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t line = 0; line < kFrameLines; ++line) {
    for (std::size_t s = sample_of_depth(from_mm); s < sample_of_depth(to_mm); ++s, ++count) {
      sum += std::pow(10.0, Scanner::level_db(scanner.levels()[line * kSamples + s]) / 10.0);
    }
  }
  return 10.0 * std::log10(sum / static_cast<double>(count));
}

Scanner make_scanner(bool noise, bool clutter) {
  Scanner scanner(320, 240);
  scanner.artefacts.noise = noise;
  scanner.artefacts.clutter = clutter;
  return scanner;
}

TEST(Scanner, TgcFlattensAttenuatedLiver) {
  Scanner scanner = make_scanner(false, false);
  scanner.settings.automatic_tgc_limit_db = 120.0;
  scanner.show(liver_frame(1), 1);
  for (double depth_mm = 10.0; depth_mm < 80.0; depth_mm += 10.0) {
    EXPECT_NEAR(level_between_db(scanner, depth_mm, depth_mm + 10.0), 0.0, 0.5) << depth_mm;
  }
}

TEST(Scanner, LiverGrayMatchesTheRealSweep) {
  // Liver of the sweep (docs/validation.md): mean 40..48, standard deviation 10..13 gray values, skewed to the bright.
  Scanner scanner = make_scanner(true, true);
  scanner.settings.gain_db = -8.0;  // as behind an abdominal wall
  scanner.show(liver_frame(2), 1);
  std::vector<double> gray;
  for (std::size_t line = 0; line < kFrameLines; ++line) {
    for (std::size_t s = sample_of_depth(40.0); s < sample_of_depth(80.0); ++s)
      gray.push_back(scanner.polar()[line * kSamples + s]);
  }
  const double n = static_cast<double>(gray.size());
  const double mean = std::accumulate(gray.begin(), gray.end(), 0.0) / n;
  double second = 0.0, third = 0.0;
  for (const double g : gray) {
    second += (g - mean) * (g - mean) / n;
    third += std::pow(g - mean, 3.0) / n;
  }
  EXPECT_GT(mean, 38.0);
  EXPECT_LT(mean, 48.0);
  EXPECT_GT(std::sqrt(second), 10.0);
  EXPECT_LT(std::sqrt(second), 15.0);
  EXPECT_GT(third, 0.0);
}

TEST(Scanner, NoiseEqualsLiverAtThePenetrationDepth) {
  Scanner scanner = make_scanner(true, false);
  scanner.settings.automatic_tgc_limit_db = 120.0;
  scanner.show(silent_frame(), 3);
  // 63 dB / (2 * 0.5 * 3.5 dB/cm) = 180 mm; over the 10 mm around 150 mm liver is 10.5 dB stronger.
  EXPECT_NEAR(level_between_db(scanner, 145.0, 155.0), -10.5, 0.6);
}

TEST(Scanner, NoiseRisesWithDepthAsTheGainDoes) {
  Scanner scanner = make_scanner(true, false);
  scanner.settings.automatic_tgc_limit_db = 120.0;
  scanner.show(silent_frame(), 3);
  const double near_db = level_between_db(scanner, 55.0, 65.0);
  const double far_db = level_between_db(scanner, 115.0, 125.0);
  EXPECT_NEAR(far_db - near_db, 2.0 * 0.5 * kFrequency_mhz * 6.0, 0.8);
}

TEST(Scanner, NoiseIsGaussianAndWithinThePulsesBand) {
  Scanner scanner = make_scanner(true, false);
  scanner.settings.automatic_tgc_db_per_cm_mhz = 0.0;
  BasebandFrame frame = silent_frame();
  frame.beam.axial_sigma_mm = 0.3;
  scanner.show(frame, 9);
  // |z|^2 of complex Gaussian noise is exponential: its mean over its median is 1 / ln 2.
  std::vector<double> power;
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i + 1 < scanner.levels().size(); ++i) {
    power.push_back(std::pow(10.0, (Scanner::level_db(scanner.levels()[i]) + 63.0) / 10.0));
  }
  const double mean = std::accumulate(power.begin(), power.end(), 0.0) / static_cast<double>(power.size());
  for (std::size_t i = 0; i + 1 < power.size(); ++i) {
    product += (power[i] - mean) * (power[i + 1] - mean);
    square += (power[i] - mean) * (power[i] - mean);
  }
  EXPECT_NEAR(mean, 1.0, 0.05);
  // Power correlates as the square of the filter's autocorrelation, exp(-(step / (2 sigma))^2); a step is 0.3125 mm.
  EXPECT_NEAR(product / square, std::exp(-2.0 * std::pow(0.3125 / (2.0 * 0.3), 2.0)), 0.03);
  std::nth_element(power.begin(), power.begin() + static_cast<std::ptrdiff_t>(power.size() / 2), power.end());
  EXPECT_NEAR(mean / power[power.size() / 2], 1.0 / std::log(2.0), 0.08);
}

TEST(Scanner, NoiseFollowsTheSeed) {
  Scanner scanner = make_scanner(true, false);
  const std::vector<std::uint8_t> first = (scanner.show(silent_frame(), 1), scanner.levels());
  const std::vector<std::uint8_t> other = (scanner.show(silent_frame(), 2), scanner.levels());
  const std::vector<std::uint8_t> again = (scanner.show(silent_frame(), 1), scanner.levels());
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(Scanner, ClutterHazesTheNearFieldAndMovesWithTheProbe) {
  Scanner scanner = make_scanner(false, true);
  scanner.show(silent_frame(), 1);
  const std::vector<std::uint8_t> first = scanner.levels();
  EXPECT_GT(level_between_db(scanner, 0.0, 2.0), -6.0);
  const double haze_db = level_between_db(scanner, 12.0, 16.0);
  EXPECT_LT(haze_db, -10.0);
  EXPECT_GT(haze_db, -30.0);
  EXPECT_LT(level_between_db(scanner, 30.0, 60.0), -70.0);
  scanner.show(silent_frame(), 2);  // another moment, another place: the same haze
  EXPECT_EQ(first, scanner.levels());
}

TEST(Scanner, NonFiniteSamplesAreBlackWithoutSpreading) {
  Scanner scanner = make_scanner(true, true);
  BasebandFrame frame = liver_frame(4);
  scanner.show(frame, 1);
  const std::vector<std::uint8_t> sound = scanner.polar();
  const std::size_t bad[] = {5 * kSamples + 3, 40 * kSamples + 200, 41 * kSamples, kFrameLines * kSamples - 1};
  frame.re[bad[0]] = std::numeric_limits<float>::quiet_NaN();
  frame.im[bad[1]] = std::numeric_limits<float>::infinity();
  frame.re[bad[2]] = -std::numeric_limits<float>::infinity();
  frame.im[bad[3]] = std::numeric_limits<float>::quiet_NaN();
  scanner.show(frame, 1);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const bool is_bad = std::find(std::begin(bad), std::end(bad), i) != std::end(bad);
    ASSERT_EQ(scanner.polar()[i], is_bad ? 0 : sound[i]) << i;
  }
  // With persistence they are gone after a while as well.
  scanner.settings.persistence = 0.5;
  for (int i = 0; i < 20; ++i) scanner.show(liver_frame(4), 1);
  EXPECT_NEAR(scanner.polar()[bad[1]], sound[bad[1]], 1);
}

TEST(Scanner, PersistenceSmoothsOverTimeAndResetForgets) {
  Scanner scanner = make_scanner(true, false);
  scanner.settings.automatic_tgc_db_per_cm_mhz = 0.0;
  const auto spread = [&] {
    double sum = 0.0, square = 0.0;
    for (const std::uint8_t level : scanner.levels()) {
      sum += level;
      square += static_cast<double>(level) * level;
    }
    const auto n = static_cast<double>(scanner.levels().size());
    return std::sqrt(square / n - sum / n * sum / n);
  };
  scanner.show(silent_frame(), 0);
  const double single = spread();
  scanner.settings.persistence = 0.8;
  for (std::uint64_t i = 1; i < 40; ++i) scanner.show(silent_frame(), i);
  // A running mean with p = 0.8 has a variance of (1 - p) / (1 + p) = 1/9.
  EXPECT_NEAR(spread() / single, 1.0 / 3.0, 0.03);
  scanner.reset();
  scanner.show(silent_frame(), 99);
  EXPECT_NEAR(spread() / single, 1.0, 0.03);
}

TEST(Scanner, FrozenFramesCanBeShownWithOtherSettings) {
  Scanner scanner = make_scanner(true, true);
  const BasebandFrame frame = liver_frame(5);
  scanner.show(frame, 1);
  const std::vector<std::uint8_t> kept = scanner.levels();

  scanner.settings.gain_db = 6.0;
  scanner.settings.dynamic_range_db = 70.0;
  scanner.settings.gray_map = GrayMap::kLinear;
  const std::vector<std::uint8_t> live = scanner.show(frame, 1).pixels;
  const std::vector<std::uint8_t> frozen = scanner.show_levels(kept, frame.geometry).pixels;
  // A step of half a dB of 70 is 1.8 gray values; half of it, and rounding.
  for (std::size_t i = 0; i < live.size(); ++i) ASSERT_NEAR(live[i], frozen[i], 3) << i;
}

TEST(Scanner, GeometryFollowsTheFrame) {
  Scanner scanner = make_scanner(false, false);
  scanner.show(liver_frame(6), 1);
  const double coarse_mm = scanner.raster().mm_per_pixel;
  BasebandFrame frame = silent_frame();
  frame.geometry.depth_mm = 80.0;
  frame.geometry.samples = 200;
  frame.re.assign(kFrameLines * 200, 0.0F);
  frame.im.assign(kFrameLines * 200, 0.0F);
  const image::GrayImage& image = scanner.show(frame, 1);
  EXPECT_LT(scanner.raster().mm_per_pixel, coarse_mm);
  EXPECT_EQ(scanner.polar().size(), static_cast<std::size_t>(kFrameLines * 200));
  EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), 0), std::ssize(image.pixels));
}

TEST(Scanner, MirrorSwapsLeftAndRight) {
  Scanner scanner = make_scanner(false, false);
  const BasebandFrame frame = liver_frame(7);
  scanner.settings.is_mirrored = false;
  const image::GrayImage straight = scanner.show(frame, 1);
  scanner.settings.is_mirrored = true;
  const image::GrayImage& mirrored = scanner.show(frame, 1);
  int differences = 0;
  for (int row = 0; row < straight.rows; ++row) {
    for (int column = 0; column < straight.columns; ++column) {
      const auto here = static_cast<std::size_t>(row * straight.columns + column);
      const auto there = static_cast<std::size_t>(row * straight.columns + straight.columns - 1 - column);
      // Weights are rounded, from either side; at the very edge of the scan a pixel may fall to the other side.
      differences += std::abs(straight.pixels[here] - mirrored.pixels[there]) > 2 ? 1 : 0;
    }
  }
  EXPECT_LT(differences, 10);
}

TEST(Scanner, ShowNeverAllocatesForConstantGeometry) {
  Scanner scanner = make_scanner(true, true);
  scanner.settings.persistence = 0.4;
  const BasebandFrame frame = liver_frame(8);
  scanner.show(frame, 0);
  const std::vector<std::uint8_t> kept = scanner.levels();
  const testing::AllocationGuard guard;
  for (std::uint64_t i = 1; i < 5; ++i) {
    scanner.settings.gain_db = static_cast<double>(i);
    scanner.settings.tgc_db[3] = -static_cast<double>(i);
    scanner.show(frame, i);
    scanner.show_levels(kept, frame.geometry);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace trocar::ultrasound
