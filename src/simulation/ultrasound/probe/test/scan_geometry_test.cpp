#include "ultrasound/probe/scan_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/files/folders.h"

namespace trocar::ultrasound {
namespace {

constexpr double kRounding_mm = 1e-9;  // distances of up to 1e3 mm in double

std::vector<Transducer> shipped_transducers() {
  const auto transducers = load_transducers(data_dir() / "transducers.toml");
  EXPECT_TRUE(transducers) << transducers.error().text();
  return transducers.value_or(std::vector<Transducer>{});
}

/// Kinds of scans, also wider than half a circle.
std::vector<ScanGeometry> scans() {
  std::vector<ScanGeometry> scans;
  for (const Transducer& t : shipped_transducers()) scans.push_back(make_scan_geometry(t, t.depth_mm, 256, 1024));
  ScanGeometry wide = scans.front();
  wide.line_step = 3.0 / 255.0;
  scans.push_back(wide);
  wide.line_step = 4.0 / 255.0;
  scans.push_back(wide);
  return scans;
}

TEST(ScanGeometry, PolarAndCartesianAreInverse) {
  std::mt19937_64 random(1);
  for (const ScanGeometry& scan : scans()) {
    std::uniform_real_distribution<double> line(-3.0, scan.lines + 2.0);
    std::uniform_real_distribution<double> depth(0.01 - 0.5 * scan.radius_mm, 1.5 * scan.depth_mm);
    for (int i = 0; i < 2000; ++i) {
      const Polar place{line(random), depth(random)};
      const Polar back = scan.to_polar(scan.to_cartesian(place));
      // A scanline's distance from its neighbour shrinks towards the apex, so the error is held in mm.
      EXPECT_NEAR((back.line - place.line) * scan.line_spacing_mm(place.depth_mm), 0.0, kRounding_mm);
      EXPECT_NEAR(back.depth_mm, place.depth_mm, kRounding_mm);
    }
  }
}

TEST(ScanGeometry, OriginIsTheFaceCentreAndDepthRunsAlongY) {
  for (const ScanGeometry& scan : scans()) {
    EXPECT_LT(scan.to_cartesian({scan.middle_line(), 0.0}).norm(), kRounding_mm);
    EXPECT_LT((scan.to_cartesian({scan.middle_line(), 50.0}) - Vec2(0.0, 50.0)).norm(), kRounding_mm);
    EXPECT_LT(scan.to_cartesian({0.0, 50.0}).x(), 0.0);
    EXPECT_NEAR(scan.line_direction(7.3).norm(), 1.0, 1e-12);
  }
}

TEST(ScanGeometry, LineSpacingMatchesNeighbouringScanlines) {
  for (const ScanGeometry& scan : scans()) {
    for (const double depth_mm : {1.0, 40.0, 100.0}) {
      const Vec2 apart = scan.to_cartesian({11.0, depth_mm}) - scan.to_cartesian({10.0, depth_mm});
      // The chord is shorter than the arc by the third order of the step.
      EXPECT_NEAR(apart.norm(), scan.line_spacing_mm(depth_mm), 1e-4 * scan.line_spacing_mm(depth_mm));
    }
  }
}

TEST(ScanGeometry, ExtentIsTheTightestBox) {
  for (const ScanGeometry& scan : scans()) {
    ScanGeometry::Extent box{1e9, 1e9, -1e9, -1e9};
    for (int line = 0; line <= 2 * (scan.lines - 1); ++line) {
      for (const double depth_mm : {0.0, scan.depth_mm}) {
        const Vec2 p_T = scan.to_cartesian({0.5 * line, depth_mm});
        box = {std::min(box.x0, p_T.x()), std::min(box.y0, p_T.y()), std::max(box.x1, p_T.x()),
               std::max(box.y1, p_T.y())};
      }
    }
    const ScanGeometry::Extent extent = scan.extent();
    // Half scanlines miss the widest place of an arc by a quarter of a step at most.
    const double missed_mm = (scan.radius_mm + scan.depth_mm) * scan.line_step * scan.line_step;
    EXPECT_NEAR(extent.x0, box.x0, missed_mm);
    EXPECT_NEAR(extent.x1, box.x1, missed_mm);
    EXPECT_NEAR(extent.y0, box.y0, kRounding_mm);
    EXPECT_NEAR(extent.y1, box.y1, kRounding_mm);
  }
}

TEST(ScanGeometry, OutermostScanlinesMatchTheTransducer) {
  for (const Transducer& t : shipped_transducers()) {
    const ScanGeometry scan = make_scan_geometry(t, 100.0, 200, 500);
    EXPECT_EQ(scan.sample_mm(), 0.2);
    if (t.kind == TransducerKind::kLinear) {
      EXPECT_FALSE(scan.is_fan);
      EXPECT_NEAR(scan.line_origin(199.0).x() - scan.line_origin(0.0).x(), t.face_width_mm() - t.pitch_mm, 1e-9);
    } else {
      EXPECT_NEAR(scan.line_step * 199.0, t.field_of_view_rad, 1e-12);
      EXPECT_EQ(scan.radius_mm, t.kind == TransducerKind::kPhased ? 0.0 : t.radius_mm);
    }
  }
}

TEST(RasterGeometry, FitsTheScanCentredAndAsLargeAsPossible) {
  for (const ScanGeometry& scan : scans()) {
    for (const auto& [columns, rows] : {std::pair{640, 480}, std::pair{200, 900}, std::pair{1200, 300}}) {
      const RasterGeometry raster = fit_raster(scan, columns, rows);
      const ScanGeometry::Extent extent = scan.extent();
      const Vec2 first = raster.to_pixel({extent.x0, extent.y0});
      const Vec2 last = raster.to_pixel({extent.x1, extent.y1});
      EXPECT_NEAR(first.x() + last.x(), columns - 1.0, 1e-9);
      EXPECT_NEAR(first.y() + last.y(), rows - 1.0, 1e-9);
      const double fill = std::max((last.x() - first.x()) / columns, (last.y() - first.y()) / rows);
      EXPECT_LE(fill, 0.97);
      EXPECT_GE(fill, 0.95);
    }
  }
}

TEST(RasterGeometry, PixelsAndMillimetresAreInverse) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> any(-50.0, 700.0);
  for (const ScanGeometry& scan : scans()) {
    for (const bool is_mirrored : {false, true}) {
      const RasterGeometry raster = fit_raster(scan, 640, 480, is_mirrored);
      EXPECT_EQ(raster.to_T(0.0, 0.0), raster.first_T);
      for (int i = 0; i < 100; ++i) {
        const Vec2 pixel(any(random), any(random));
        EXPECT_LT((raster.to_pixel(raster.to_T(pixel.x(), pixel.y())) - pixel).norm(), kRounding_mm);
      }
    }
  }
}

TEST(RasterGeometry, MirrorSwapsLeftAndRight) {
  const ScanGeometry scan = scans().front();
  const RasterGeometry plain = fit_raster(scan, 641, 480);
  const RasterGeometry mirrored = fit_raster(scan, 641, 480, true);
  EXPECT_GT(plain.to_pixel({10.0, 50.0}).x(), 320.0);
  EXPECT_LT((mirrored.to_pixel({10.0, 50.0}) - plain.to_pixel({-10.0, 50.0})).norm(), kRounding_mm);
}

}  // namespace
}  // namespace trocar::ultrasound
