#include "ultrasound/scanner/scan_annotation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace trocar::ultrasound {
namespace {

ScanGeometry fan_of_depth(double depth_mm) {
  ScanGeometry scan;
  scan.lines = 128;
  scan.line_step = 1.1 / 127.0;
  scan.depth_mm = depth_mm;
  return scan;
}

ScanCaption caption() {
  ScanCaption result;
  result.transducer = "C5-2";
  result.focus_mm = 70.0;
  return result;
}

bool has_text(const ScanAnnotation& annotation, const std::string& text) {
  return std::any_of(annotation.texts.begin(), annotation.texts.end(),
                     [&](const ScanAnnotation::Text& t) { return t.text == text; });
}

TEST(ScanAnnotation, TicksLieAtTheirDepthBelowTheFace) {
  const ScanGeometry scan = fan_of_depth(160.0);
  const RasterGeometry raster = fit_raster(scan, 640, 480);
  const ScanAnnotation annotation = make_scan_annotation(raster, scan, caption());
  ASSERT_EQ(annotation.ticks.size(), 17U);
  for (std::size_t i = 0; i < annotation.ticks.size(); ++i) {
    EXPECT_NEAR(raster.to_T(0.0, annotation.ticks[i].row).y(), 10.0 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(annotation.ticks[i].length_px > annotation.ticks[1].length_px, i % 5 == 0);
  }
  EXPECT_NEAR(raster.to_T(0.0, annotation.focus_row).y(), 70.0, 1e-9);
  for (const char* label : {"0", "5", "10", "15", "C5-2", "Depth 16.0 cm"}) EXPECT_TRUE(has_text(annotation, label));
}

TEST(ScanAnnotation, ShallowImagesHaveAFinerScale) {
  const ScanGeometry scan = fan_of_depth(40.0);
  const ScanAnnotation annotation = make_scan_annotation(fit_raster(scan, 640, 480), scan, caption());
  EXPECT_EQ(annotation.ticks.size(), 9U);
  EXPECT_TRUE(has_text(annotation, "4"));
}

TEST(ScanAnnotation, MarkerFollowsItsEndWhenMirrored) {
  const ScanGeometry scan = fan_of_depth(160.0);
  for (const bool is_mirrored : {false, true}) {
    const RasterGeometry raster = fit_raster(scan, 640, 480, is_mirrored);
    const ScanAnnotation annotation = make_scan_annotation(raster, scan, caption());
    EXPECT_GT(raster.to_T(annotation.marker_pixel.x(), annotation.marker_pixel.y()).x(),
              scan.line_origin(scan.lines - 1).x());
    EXPECT_EQ(annotation.marker_pixel.x() < 320.0, is_mirrored);
  }
}

TEST(ScanAnnotation, MarkerFitsTheImageOfALinearArray) {
  ScanGeometry scan;
  scan.is_fan = false;
  scan.lines = 128;
  scan.line_step = 0.3;
  scan.depth_mm = 40.0;
  constexpr double kRadius = 3.0;
  for (const bool is_mirrored : {false, true}) {
    const RasterGeometry raster = fit_raster(scan, 200, 300, is_mirrored);  // the array fills its width
    const ScanAnnotation annotation = make_scan_annotation(raster, scan, caption());
    EXPECT_GE(annotation.marker_pixel.x(), kRadius);
    EXPECT_LE(annotation.marker_pixel.x(), 199.0 - kRadius);
    EXPECT_GE(annotation.marker_pixel.y(), kRadius);
    EXPECT_EQ(annotation.marker_pixel.x() < 100.0, is_mirrored);
  }
}

TEST(ScanAnnotation, NamesHarmonicImagingAndTheReceivedFrequency) {
  const ScanGeometry scan = fan_of_depth(160.0);
  ScanCaption harmonic = caption();
  harmonic.is_harmonic = true;
  harmonic.frequency_mhz = 4.0;
  const auto has_text = [&](const ScanCaption& shown, const std::string& text) {
    const ScanAnnotation annotation = make_scan_annotation(fit_raster(scan, 640, 480), scan, shown);
    return std::any_of(annotation.texts.begin(), annotation.texts.end(), [&](const auto& t) { return t.text == text; });
  };
  EXPECT_TRUE(has_text(harmonic, "THI 4.0 MHz"));
  harmonic.is_harmonic = false;
  EXPECT_TRUE(has_text(harmonic, "4.0 MHz"));
}

TEST(ScanAnnotation, WedgeShowsTheGrayMap) {
  const ScanGeometry scan = fan_of_depth(160.0);
  ScanCaption louder = caption();
  louder.settings.gain_db = 13.0;
  const ScanAnnotation annotation = make_scan_annotation(fit_raster(scan, 640, 480), scan, louder);
  ASSERT_GT(annotation.wedge.gray.size(), 50U);
  EXPECT_EQ(annotation.wedge.gray.front(), 255);
  EXPECT_EQ(annotation.wedge.gray.back(), 0);
  EXPECT_TRUE(std::is_sorted(annotation.wedge.gray.rbegin(), annotation.wedge.gray.rend()));
}

TEST(ScanAnnotation, DrawsWithinTheImage) {
  const ScanGeometry scan = fan_of_depth(160.0);
  const ScanAnnotation annotation = make_scan_annotation(fit_raster(scan, 640, 480), scan, caption());
  image::RgbImage image(640, 480);
  draw_annotation(image, annotation);
  const auto row = static_cast<int>(std::lround(annotation.ticks[5].row));
  EXPECT_NE(image.at(annotation.scale_column - 1, row), (image::Rgb{0, 0, 0}));
  EXPECT_EQ(image.at(320, 240), (image::Rgb{0, 0, 0}));
  image::RgbImage tiny(20, 16);
  draw_annotation(tiny, annotation);  // sanitizers watch
  image::RgbImage none;
  draw_annotation(none, annotation);
}

TEST(ScanAnnotation, ConvertsGrayToRgb) {
  const image::RgbImage image = image::to_rgb({2, 1, {7, 200}});
  EXPECT_EQ(image.at(0, 0), (image::Rgb{7, 7, 7}));
  EXPECT_EQ(image.at(1, 0), (image::Rgb{200, 200, 200}));
}

}  // namespace
}  // namespace trocar::ultrasound
