#include "ultrasound/scanner/detail/scan_conversion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace trocar::ultrasound::detail {
namespace {

/// Gray values: rounding of the value, of two weights and of a smoothed sample.
constexpr double kTolerance = 1.6;

ScanGeometry converted_fan() {
  ScanGeometry scan;
  scan.lines = 64;
  scan.samples = 300;
  scan.radius_mm = 50.0;
  scan.line_step = 1.1 / 63.0;
  scan.depth_mm = 120.0;
  return scan;
}

ScanGeometry parallel() {
  ScanGeometry scan = converted_fan();
  scan.is_fan = false;
  scan.line_step = 0.6;
  scan.depth_mm = 50.0;
  return scan;
}

std::vector<std::uint8_t> converted(const ScanGeometry& scan, const RasterGeometry& raster,
                                    double (*gray)(const ScanGeometry&, double line, double sample)) {
  ScanConversion conversion(raster.columns, raster.rows);
  conversion.set_geometry(scan, raster);
  std::vector<std::uint8_t> line(static_cast<std::size_t>(scan.samples));
  for (int l = 0; l < scan.lines; ++l) {
    for (int s = 0; s < scan.samples; ++s) {
      line[static_cast<std::size_t>(s)] = static_cast<std::uint8_t>(std::lround(gray(scan, l, s)));
    }
    conversion.set_line(static_cast<std::size_t>(l), line.data());
  }
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows));
  // In two parts, as threads do.
  conversion.convert_rows(0, 17, pixels.data());
  conversion.convert_rows(17, static_cast<std::size_t>(raster.rows), pixels.data());
  return pixels;
}

double slope_along(const ScanGeometry& scan, double /*line*/, double sample) {
  return 20.0 + 200.0 * sample / (scan.samples - 1);
}
double slope_across(const ScanGeometry& scan, double line, double /*sample*/) {
  return 20.0 + 200.0 * line / (scan.lines - 1);
}
double white(const ScanGeometry& /*scan*/, double /*line*/, double /*sample*/) {
  return 255.0;
}

void expect_reproduced(const ScanGeometry& scan, bool is_mirrored,
                       double (*gray)(const ScanGeometry&, double line, double sample)) {
  const RasterGeometry raster = fit_raster(scan, 203, 150, is_mirrored);  // no multiple of a vector
  const std::vector<std::uint8_t> pixels = converted(scan, raster, gray);
  int inside = 0;
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) {
      const Polar place = scan.to_polar(raster.to_T(column, row));
      const double sample = place.depth_mm / scan.sample_mm() - 0.5;
      if (place.line < 0.0 || place.line > scan.lines - 1 || sample < 0.0 || sample > scan.samples - 1) continue;
      ++inside;
      const auto pixel = static_cast<std::size_t>(row * raster.columns + column);
      ASSERT_NEAR(pixels[pixel], gray(scan, place.line, sample), kTolerance) << column << ' ' << row;
    }
  }
  EXPECT_GT(inside, 3000);
}

TEST(ScanConversion, ReproducesLinearGradients) {
  for (const ScanGeometry& scan : {converted_fan(), parallel()}) {
    for (const bool is_mirrored : {false, true}) {
      expect_reproduced(scan, is_mirrored, slope_along);
      expect_reproduced(scan, is_mirrored, slope_across);
    }
  }
}

TEST(ScanConversion, PixelsOutsideTheScanAreBlack) {
  for (const ScanGeometry& scan : {converted_fan(), parallel()}) {
    const RasterGeometry raster = fit_raster(scan, 203, 150);
    const std::vector<std::uint8_t> pixels = converted(scan, raster, white);
    int outside = 0;
    for (int row = 0; row < raster.rows; ++row) {
      for (int column = 0; column < raster.columns; ++column) {
        const Polar place = scan.to_polar(raster.to_T(column, row));
        const bool is_inside = place.line >= 0.0 && place.line <= scan.lines - 1 && place.depth_mm >= 0.0 &&
                               place.depth_mm <= scan.depth_mm;
        outside += is_inside ? 0 : 1;
        const auto pixel = static_cast<std::size_t>(row * raster.columns + column);
        ASSERT_EQ(pixels[pixel], is_inside ? 255 : 0) << column << ' ' << row;
      }
    }
    EXPECT_GT(outside, 500);
  }
}

TEST(ScanConversion, CoarsePixelsAverageNeighbouringSamples) {
  // Samples that change between black and white from one to the next would else be drawn as a moire.
  const ScanGeometry scan = converted_fan();  // 0.4 mm a sample
  const RasterGeometry raster = fit_raster(scan, 128, 100);
  ASSERT_GT(raster.mm_per_pixel, 2.0 * scan.sample_mm());
  const auto stripes = [](const ScanGeometry& /*scan*/, double /*line*/, double sample) {
    return static_cast<int>(sample) % 2 == 0 ? 0.0 : 200.0;
  };
  const std::vector<std::uint8_t> pixels = converted(scan, raster, stripes);
  const auto middle = static_cast<std::size_t>(50 * raster.columns + 64);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(pixels[middle + i * 128], 100.0, kTolerance);
}

}  // namespace
}  // namespace trocar::ultrasound::detail
