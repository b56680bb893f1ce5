#include "ultrasound/engine/detail/needle_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/engine/test/needle_alone.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Depth at which a scanline crosses a line of the picture's plane; negative: not at all.
double crossing_mm(const ScanGeometry& scan, int line, const Vec3& a, const Vec3& b) {
  const Vec2 origin = scan.line_origin(line), along = scan.line_direction(line);
  Eigen::Matrix2d m;
  m.col(0) = along;
  m.col(1) = Vec2(a.x() - b.x(), a.y() - b.y());
  const Vec2 at = m.inverse() * (Vec2(a.x(), a.y()) - origin);
  return at.y() >= 0.0 && at.y() <= 1.0 ? at.x() : -1.0;
}

double shaft_db(double tilt_rad) {
  const double smooth =
      std::pow(10.0, kShaftSmooth_db / 20.0) * std::exp(-0.5 * std::pow(tilt_rad / kShaftTilt_rad, 2));
  const double rough = std::pow(10.0, kShaftRough_db / 20.0) * std::cos(tilt_rad);
  return 10.0 * std::log10(smooth * smooth + rough * rough);
}

/// Mean level of a shaft that crosses the middle of the picture, over scanlines that meet it at much the same tilt.
double mean_level_db(NeedleAlone& engine, double angle_rad, double depth_mm = 60.0) {
  double power = 0.0;
  int n = 0;
  const int middle = engine.plan.lines / 2;
  for (int step = -8; step <= 8; ++step) {
    // Moved along itself, so that other grains of its surface are met.
    const Vec3 tip = Vec3(0.0, depth_mm, 0.0) + (40.0 + 2.5 * step) * in_plane(angle_rad);
    const auto shaft = shaft_to(tip, in_plane(angle_rad));
    const BasebandFrame frame = seen(engine, needle_of(shaft));
    for (int line = middle - 2; line <= middle + 2; line += 2, ++n) {
      const double at = crossing_mm(frame.geometry, line, shaft[0], shaft[1]) / frame.geometry.sample_mm() - 0.5;
      const int s = static_cast<int>(at);
      const double part = at - s;
      power += (1.0 - part) * std::pow(envelope(frame, line, s), 2) + part * std::pow(envelope(frame, line, s + 1), 2);
    }
  }
  return 10.0 * std::log10(power / n);
}

TEST(NeedleImage, ShowsALineWhereTheShaftLies) {
  NeedleAlone engine;
  for (const double angle_deg : {90.0, 75.0, 60.0, 40.0}) {
    const auto shaft = shaft_to({20.0, 75.0, 0.0}, in_plane(radians(angle_deg)), 50.0);
    const BasebandFrame frame = seen(engine, needle_of(shaft));
    int met = 0;
    for (int line = 4; line < frame.geometry.lines - 4; ++line) {
      const double at_mm = crossing_mm(frame.geometry, line, shaft[0], shaft[1]);
      if (at_mm < 10.0 || at_mm > 95.0) continue;
      ++met;
      const LinePeak peak = peak_of(frame, line);
      // 13 dB at a tilt of 50 degrees, 20 dB less in a gap.
      EXPECT_GT(peak.level_db, angle_deg > 50.0 ? 0.0 : -10.0) << angle_deg << " line " << line;
      // A tilted line's middle is as broad as the lateral point spread times the slope.
      EXPECT_NEAR(peak.depth_mm, at_mm, angle_deg > 80.0 ? 0.25 : 2.5) << angle_deg << " line " << line;
    }
    EXPECT_GT(met, 15) << angle_deg;
  }
}

TEST(NeedleImage, LevelFollowsTheTilt) {
  NeedleAlone engine(shallow(256, 1024));
  // Rough surfaces glint: 51 measurements of which a third are independent leave 1.1 dB. Gaps, some of which are in the
  // measured part, leave 3 dB.
  for (const double tilt_deg : {0.0, 8.0, 16.0, 24.0, 35.0, 50.0, 65.0, 80.0})
    EXPECT_NEAR(mean_level_db(engine, radians(90.0 - tilt_deg)), shaft_db(radians(tilt_deg)),
                tilt_deg < 20.0 ? 1.0 : 4.0)
        << tilt_deg;
}

/// Standard deviation along the shaft of the level, dB, over stretches of 2.5 mm.
double unevenness_db(NeedleAlone& engine, double angle) {
  const auto shaft = shaft_to({25.0, 80.0, 0.0}, in_plane(angle), 60.0);
  const BasebandFrame frame = seen(engine, needle_of(shaft));
  std::vector<double> levels;
  for (int line = 8; line + 6 < frame.geometry.lines - 8; line += 6) {
    double power = 0.0;
    int met = 0;
    for (int l = line; l < line + 6; ++l) {
      const double at_mm = crossing_mm(frame.geometry, l, shaft[0], shaft[1]);
      if (at_mm < 15.0 || at_mm > 75.0) continue;
      power += std::pow(10.0, 0.1 * peak_of(frame, l).level_db);
      ++met;
    }
    if (met == 6) levels.push_back(10.0 * std::log10(power / met));
  }
  double mean = 0.0, square = 0.0;
  for (const double level : levels) mean += level / static_cast<double>(levels.size());
  for (const double level : levels) square += std::pow(level - mean, 2) / static_cast<double>(levels.size());
  return std::sqrt(square);
}

TEST(NeedleImage, HasGapsAtObliqueAnglesOnly) {
  NeedleAlone engine(shallow(256, 1024));
  EXPECT_LT(unevenness_db(engine, radians(80.0)), 2.5);
  EXPECT_GT(unevenness_db(engine, radians(40.0)), 3.0);
}

TEST(NeedleImage, LevelFallsWithTheTilt) {
  NeedleAlone engine;
  double last_db = 1e9;
  for (const double tilt_deg : {0.0, 10.0, 20.0, 30.0, 50.0, 75.0}) {
    const double level_db = mean_level_db(engine, radians(90.0 - tilt_deg));
    EXPECT_LT(level_db, last_db) << tilt_deg;
    last_db = level_db;
  }
}

TEST(NeedleImage, LevelIsIndependentOfLinesSamplesAndDepth) {
  for (const double angle_deg : {90.0, 80.0})
    for (const auto& [lines, samples] : {std::pair{96, 640}, std::pair{256, 640}, std::pair{128, 1024}}) {
      NeedleAlone engine(shallow(lines, samples));
      for (const double depth_mm : {30.0, 60.0, 80.0})
        EXPECT_NEAR(mean_level_db(engine, radians(angle_deg), depth_mm), shaft_db(radians(90.0 - angle_deg)), 1.0)
            << angle_deg << " " << lines << " " << samples << " " << depth_mm;
    }
}

TEST(NeedleImage, ThickerNeedlesEchoMore) {
  Acquisition plain = shallow();
  plain.artefacts.reverberation = false;  // of so thin a needle it would lie within the first echo
  NeedleAlone engine(plain);
  const auto shaft = shaft_to({40.0, 60.0, 0.0}, in_plane(0.5 * kPi), 80.0);
  NeedleEcho needle = needle_of(shaft);
  const double level_db = peak_of(seen(engine, needle), 64).level_db;
  needle.diameter_mm = 0.3;
  EXPECT_NEAR(peak_of(seen(engine, needle), 64).level_db, level_db - 6.02, 0.3);
}

TEST(NeedleImage, DimsOutsideThePlaneLikeTheBeam) {
  NeedleAlone engine;
  const double sigma_mm = seen(engine, {}).beam.elevation_sigma_mm(60.0);
  const auto level_db = [&](double sigmas) {
    const auto shaft = shaft_to({40.0, 60.0, sigmas * sigma_mm}, in_plane(0.5 * kPi), 80.0);
    return peak_of(seen(engine, needle_of(shaft)), 64, 59.0, 61.0).level_db;
  };
  const double middle_db = level_db(0.0);
  for (const double sigmas : {-2.0, -1.0, 0.5, 1.0, 1.5, 2.0})
    EXPECT_NEAR(level_db(sigmas) - middle_db, db(std::exp(-0.5 * sigmas * sigmas)), 0.3) << sigmas;
  EXPECT_LT(level_db(3.0), -60.0);
}

TEST(NeedleImage, IsADotAcrossThePlane) {
  NeedleAlone engine(shallow(256));
  const int middle = engine.plan.lines / 2;
  const Vec2 at = engine.plan.geometry.to_cartesian({static_cast<double>(middle), 60.0});
  const auto shaft = shaft_to({at.x(), at.y(), 40.0}, Vec3::UnitZ(), 80.0);
  const BasebandFrame frame = seen(engine, needle_of(shaft));
  const LinePeak peak = peak_of(frame, middle);
  EXPECT_NEAR(peak.depth_mm, 60.0, 0.2);
  EXPECT_NEAR(peak.level_db, kShaftSmooth_db, 1.5);
  int bright = 0;
  for (int line = 0; line < frame.geometry.lines; ++line)
    bright += peak_of(frame, line, 58.0, 61.0).level_db > peak.level_db - 6.02 ? 1 : 0;
  const double width_mm = 2.355 * frame.beam.lateral_sigma_mm(60.0);
  EXPECT_NEAR(bright * frame.geometry.line_spacing_mm(60.0), width_mm, 2.0 * frame.geometry.line_spacing_mm(60.0));
}

TEST(NeedleImage, TipIsBrighterThanASteepShaft) {
  NeedleAlone engine;
  const Vec3 tip(0.0, 70.0, 0.0);
  const auto shaft = shaft_to(tip, in_plane(radians(15.0)));
  const BasebandFrame frame = seen(engine, needle_of(shaft));
  const double tip_db = peak_of(frame, frame.geometry.lines / 2, 66.0, 71.0).level_db;
  EXPECT_GT(tip_db, kTipPoint_db - 4.0);
  double power = 0.0;
  int n = 0;
  for (int line = 0; line < frame.geometry.lines; ++line) {
    const double at_mm = crossing_mm(frame.geometry, line, shaft[0], shaft[1]);
    if (at_mm < 20.0 || at_mm > 60.0) continue;
    power += std::pow(10.0, peak_of(frame, line, at_mm - 0.4, at_mm + 0.4).level_db / 10.0);
    ++n;
  }
  ASSERT_GT(n, 5);
  EXPECT_GT(tip_db, 10.0 * std::log10(power / n) + 8.0);
  EXPECT_LT(peak_of(frame, frame.geometry.lines / 2, 80.0, 99.0).level_db, -20.0) << "nothing beyond the tip";
}

TEST(NeedleImage, RepeatsEchoesAtTheBoresSpacing) {
  NeedleAlone engine;
  const auto shaft = shaft_to({40.0, 60.0, 0.0}, in_plane(0.5 * kPi), 80.0);
  NeedleEcho needle = needle_of(shaft);
  needle.diameter_mm = 3.0;
  needle.bore_share = 0.8;
  const double spacing_mm = repeat_spacing_mm(needle);
  EXPECT_NEAR(spacing_mm, 1.540 * (0.6 / 5.79 + 2.4 / 1.48), 1e-9);
  const BasebandFrame frame = seen(engine, needle);
  const LinePeak first = peak_of(frame, 64, 58.0, 61.0);
  for (int k = 1; k <= 3; ++k) {
    const double at_mm = first.depth_mm + k * spacing_mm;
    const LinePeak again = peak_of(frame, 64, at_mm - 0.8, at_mm + 0.8);
    EXPECT_NEAR(again.depth_mm, at_mm, 0.15) << k;
    EXPECT_NEAR(again.level_db, first.level_db + k * db(kRepeatShare), 1.5) << k;
  }
  Acquisition plain = shallow();
  plain.artefacts.reverberation = false;
  NeedleAlone deaf(plain);
  EXPECT_LT(peak_of(seen(deaf, needle), 64, 61.5, 75.0).level_db, first.level_db - 45.0);
}

TEST(NeedleImage, FollowsABentShaft) {
  NeedleAlone engine;
  std::vector<Vec3> shaft;
  for (int n = 0; n <= 24; ++n) {
    const double u = n / 24.0;
    shaft.push_back({-35.0 + 70.0 * u, 45.0 + 14.0 * u * u, 0.0});
  }
  const BasebandFrame frame = seen(engine, needle_of(shaft));
  for (std::size_t n = 4; n + 4 < shaft.size(); ++n) {
    const Vec3 p = 0.5 * (shaft[n] + shaft[n + 1]);
    const Polar at = frame.geometry.to_polar({p.x(), p.y()});
    const LinePeak peak = peak_of(frame, static_cast<int>(std::lround(at.line)));
    EXPECT_NEAR(peak.depth_mm, at.depth_mm, 0.6) << n;
    EXPECT_GT(peak.level_db, 10.0) << n;
  }
}

TEST(NeedleImage, LiesDeeperUnderSlowTissue) {
  const TestLayer layers[] = {{30.0, TestTissue::kSlow}, {1e9, TestTissue::kWater}};
  Transducer linear = default_convex();
  linear.kind = TransducerKind::kLinear;
  BMode engine(layers_scene(box_for(linear, 100.0, 2.0), layers), linear, shallow());
  const auto shaft = shaft_to({30.0, 60.0, 0.0}, in_plane(0.5 * kPi), 60.0);
  EXPECT_NEAR(peak_of(seen(engine, needle_of(shaft)), 64, 40.0, 80.0).depth_mm, 60.0 + 30.0 * (1540.0 / 1450.0 - 1.0),
              0.3);
}

}  // namespace
}  // namespace trocar::ultrasound
