#include "lab/ultrasound/picture_figures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace trocar::ultrasound {
namespace {

struct Drawn {
  RasterGeometry raster;
  ScanGeometry scan;
  std::vector<std::uint8_t> pixels;
  FanPicture view() const { return {raster, scan, pixels}; }
};

template <class GrayAt>  // GrayAt(Polar) -> gray
Drawn draw(const GrayAt& gray_at) {
  Drawn drawn;
  drawn.scan.lines = 200;
  drawn.scan.samples = 512;
  drawn.scan.depth_mm = 120.0;
  drawn.scan.line_step = 1.0 / 199.0;
  drawn.raster = fit_raster(drawn.scan, 600, 480);
  drawn.pixels.assign(600 * 480, 0);
  for (int row = 0; row < 480; ++row)
    for (int column = 0; column < 600; ++column) {
      const Polar place = drawn.scan.to_polar(drawn.raster.to_T(column, row));
      // A rim beyond the fan's edge, so that the outermost samples lie between drawn pixels.
      if (place.line < -3.0 || place.line > 202.0 || place.depth_mm < -1.5 || place.depth_mm > 121.5) continue;
      drawn.pixels[static_cast<std::size_t>(row * 600 + column)] =
          static_cast<std::uint8_t>(std::lround(std::clamp(gray_at(place), 0.0, 255.0)));
    }
  return drawn;
}

TEST(PolarPicture, RecoversValuesByDepthAndScanline) {
  const Drawn drawn = draw([](const Polar& place) { return 20.0 + place.depth_mm + 0.3 * place.line; });
  const EchoPatch polar = polar_picture(drawn.view(), 100, 0.5);
  for (int line = 0; line < 100; line += 9)
    for (int sample = 0; sample < polar.samples; sample += 17)
      ASSERT_NEAR(polar.at(line, sample), 20.0 + (sample + 0.5) * 0.5 + 0.3 * line * 199.0 / 99.0, 0.6);
}

TEST(PictureStatistics, GiveLevelsAgainstDepth) {
  const Drawn drawn = draw([](const Polar& place) { return 200.0 - place.depth_mm; });
  PictureStatistics statistics;
  statistics.add(drawn.view());
  const PictureFigures figures = statistics.figures();
  ASSERT_EQ(figures.levels.size(), 12u);
  for (const auto& level : figures.levels) {
    EXPECT_NEAR(level.mean, 200.0 - level.depth_mm, 0.5);
    EXPECT_NEAR(level.median, 200.0 - level.depth_mm, 1.0);
  }
  EXPECT_NEAR(mean_gray(figures.histogram), 140.0, 0.5);
}

TEST(PictureStatistics, FindTheSpecklesWidthsAfterScanConversion) {
  constexpr double kAxialSigma_mm = 0.4, kLateralSigma_lines = 0.8;
  // Gray noise of a Gaussian autocovariance: a sum of random waves.
  Random random(5);
  struct Wave {
    double across, along, phase;
  };
  std::vector<Wave> waves(150);
  for (Wave& wave : waves)
    wave = {random.normal() / (kLateralSigma_lines * std::sqrt(2.0)),
            random.normal() / (kAxialSigma_mm * std::sqrt(2.0)), random.uniform(0.0, 6.28318530718)};
  const Drawn drawn = draw([&](const Polar& place) {
    double sum = 0.0;
    for (const Wave& wave : waves) sum += std::cos(wave.across * place.line + wave.along * place.depth_mm + wave.phase);
    return 100.0 + 8.0 * std::sqrt(2.0 / 150.0) * sum;
  });
  PictureStatistics statistics;
  statistics.add(drawn.view());
  const PictureFigures figures = statistics.figures();
  ASSERT_GE(figures.speckle.size(), 6u);
  // Waves' numbers of deviation 1/(sqrt2 s) give an autocovariance exp(-d^2 / 4 s^2): full width 3.33 s. Sampling the
  // picture twice, drawn at 0.4 mm a pixel, blurs it a little.
  for (const auto& speckle : figures.speckle) {
    const double line_mm = drawn.scan.line_spacing_mm(speckle.depth_mm);
    EXPECT_NEAR(speckle.mean, 100.0, 2.0);
    EXPECT_NEAR(speckle.standard_deviation, 8.0, 1.2);
    EXPECT_NEAR(speckle.axial_fwhm_mm, 3.33 * kAxialSigma_mm, 0.15 * 3.33 * kAxialSigma_mm) << speckle.depth_mm;
    EXPECT_NEAR(speckle.lateral_fwhm_mm, 3.33 * kLateralSigma_lines * line_mm, 0.2 * 2.66 * line_mm)
        << speckle.depth_mm;
  }
}

TEST(PictureStatistics, LeaveEdgesAndShadowsOut) {
  const Drawn drawn = draw([](const Polar& place) { return place.line < 100.0 ? 4.0 : 150.0; });
  PictureStatistics statistics;
  statistics.add(drawn.view());
  EXPECT_TRUE(statistics.figures().speckle.empty());
}

}  // namespace
}  // namespace trocar::ultrasound
