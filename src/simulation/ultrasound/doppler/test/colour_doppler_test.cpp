#include "ultrasound/doppler/colour_doppler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/files/folders.h"
#include "core/testing/allocation_guard.h"
#include "ultrasound/doppler/test/tube_patient.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/tissue/test/make_block.h"

namespace trocar::ultrasound {
namespace {

using testing::make_steady_table;
using testing::make_tube_patient;

constexpr double kPlug = 20.0;  // a profile as blunt as rules allow

/// A straight tube along z with flow to the feet, that fast.
std::shared_ptr<const VesselFlow> tube_flow(double cm_per_s) {
  static const anatomy::VirtualPatient kPatient = make_tube_patient(
      Vec3(40, 40, 160), Vec3(1, 1, 1), {{"tube", [](const Vec3& p) { return std::hypot(p.x(), p.y()) < 10.0; }}});
  return *make_vessel_flow(kPatient, make_steady_table(cm_per_s, kPlug));
}

Transducer doppler_linear() {
  Transducer transducer;
  transducer.name = "linear";
  transducer.kind = TransducerKind::kLinear;
  transducer.frequency_mhz = 5.0;
  return transducer;
}

/// Looks at the middle of the tube from 50 mm away; the beam makes that angle with the flow (0: flow runs away).
DopplerInput look(double angle_rad, std::uint64_t seed = 1) {
  DopplerInput input;
  const Vec3 beam(0.0, std::sin(angle_rad), -std::cos(angle_rad));
  Mat3 R;
  R.col(0) = Vec3::UnitX().cross(beam);
  R.col(1) = beam;
  R.col(2) = R.col(0).cross(R.col(1));
  input.X_PT = Pose(R, -50.0 * beam);
  input.geometry = make_scan_geometry(doppler_linear(), 100.0, 64, 512);
  input.beam = make_beam(doppler_linear(), 5.0, 50.0);
  input.seed = seed;
  return input;
}

DopplerSettings quiet(double scale_cm_per_s) {
  DopplerSettings settings;
  settings.scale_cm_per_s = scale_cm_per_s;
  settings.frequency_mhz = 2.5;
  settings.wall_filter = 0.02;
  settings.persistence = 0.0;
  settings.box = {0.3, 0.7, 0.3, 0.7};
  return settings;
}

struct Measured {
  double mean_cm_per_s = 0.0;
  int cells = 0;
};

/// Cells within 3 mm of the tube's middle.
Measured measure_middle(const DopplerFrame& frame, const DopplerInput& input) {
  Measured measured;
  for (int line = 0; line < frame.lines; ++line)
    for (int gate = 0; gate < frame.gates; ++gate) {
      const Vec2 p_T = input.geometry.to_cartesian(
          {frame.first_line + frame.line_step * line, frame.first_mm + frame.gate_mm * gate});
      if ((p_T - Vec2(0.0, 50.0)).norm() > 3.0 || frame.has_flow[frame.at(line, gate)] == 0) continue;
      measured.mean_cm_per_s += static_cast<double>(frame.velocity_cm_per_s[frame.at(line, gate)]);
      ++measured.cells;
    }
  if (measured.cells > 0) measured.mean_cm_per_s /= measured.cells;
  return measured;
}

int shown_cells(const DopplerFrame& frame) {
  return static_cast<int>(std::count(frame.has_flow.begin(), frame.has_flow.end(), 1));
}

TEST(ColourDoppler, MeasuresTheCosineOfTheAngle) {
  const auto flow = tube_flow(40.0);
  for (const double angle_deg : {0.0, 30.0, 45.0, 60.0, 75.0, 105.0, 135.0, 180.0}) {
    const double angle = radians(angle_deg);
    ColourDoppler doppler(flow);
    doppler.settings = quiet(60.0);
    const DopplerInput input = look(angle);
    const Measured measured = measure_middle(doppler.render(input), input);
    EXPECT_GT(measured.cells, 20) << angle_deg;
    // Away from the face is negative. Half a percent of the speed is the grid's, the rest noise of some cells.
    EXPECT_NEAR(measured.mean_cm_per_s, -40.0 * std::cos(angle), 0.5) << angle_deg;
  }
}

TEST(ColourDoppler, MeasuresNothingAtARightAngle) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(60.0);
  const DopplerInput input = look(std::numbers::pi / 2.0);
  EXPECT_EQ(measure_middle(doppler.render(input), input).cells, 0);
}

TEST(ColourDoppler, WrapsAtTheNyquistVelocity) {
  const auto flow = tube_flow(40.0);
  for (const double scale : {50.0, 41.0, 39.0, 30.0, 19.0}) {
    ColourDoppler doppler(flow);
    doppler.settings = quiet(scale);
    const DopplerInput input = look(0.0);
    const double wrapped = -40.0 + 2.0 * scale * std::floor((40.0 + scale) / (2.0 * scale));
    EXPECT_NEAR(measure_middle(doppler.render(input), input).mean_cm_per_s, wrapped, 0.5) << scale;
  }
}

TEST(ColourDoppler, LosesFlowOfAWholePulseInterval) {
  // Twice the scale turns the phase once: it looks like standing tissue, and the wall filter takes it.
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(20.0);
  const DopplerInput input = look(0.0);
  EXPECT_EQ(measure_middle(doppler.render(input), input).cells, 0);
}

TEST(ColourDoppler, StopsSlowFlowByTheWallFilter) {
  const auto flow = tube_flow(3.0);
  const DopplerInput input = look(0.0);
  ColourDoppler doppler(flow);
  doppler.settings = quiet(30.0);
  EXPECT_GT(measure_middle(doppler.render(input), input).cells, 20);
  doppler.settings.wall_filter = 0.6;
  doppler.settings.gain_db = -15.0;
  EXPECT_EQ(measure_middle(doppler.render(input), input).cells, 0);
  doppler.settings.wall_filter = 0.02;
  EXPECT_GT(measure_middle(doppler.render(input), input).cells, 20);
}

TEST(ColourDoppler, ShowsNoiseOnlyWhenTurnedUp) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(60.0);
  DopplerInput input = look(0.0);
  input.X_PT = Pose(input.X_PT.R(), Vec3(500.0, 0.0, 0.0));  // far from any vessel
  const DopplerFrame& frame = doppler.render(input);
  EXPECT_LT(shown_cells(frame), 0.002 * static_cast<double>(frame.has_flow.size()));
  doppler.settings.gain_db = 30.0;
  EXPECT_GT(shown_cells(doppler.render(input)), 0.5 * static_cast<double>(frame.has_flow.size()));
}

TEST(ColourDoppler, IsDeterministic) {
  const auto flow = tube_flow(40.0);
  const auto frame_of = [&](std::uint64_t seed) {
    ColourDoppler doppler(flow);
    doppler.settings = quiet(60.0);
    return doppler.render(look(0.5, seed));
  };
  EXPECT_EQ(frame_of(1).velocity_cm_per_s, frame_of(1).velocity_cm_per_s);
  EXPECT_NE(frame_of(1).velocity_cm_per_s, frame_of(2).velocity_cm_per_s);
}

TEST(ColourDoppler, PersistenceBlendsEarlierFrames) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(60.0);
  doppler.settings.persistence = 0.9;
  doppler.render(look(0.0));
  DopplerInput away = look(0.0);
  away.X_PT = Pose(away.X_PT.R(), Vec3(500.0, 0.0, 0.0));
  EXPECT_GT(measure_middle(doppler.render(away), away).cells, 20);
  doppler.reset();
  EXPECT_LT(measure_middle(doppler.render(away), away).cells, 3);
}

TEST(ColourDoppler, NeverAllocatesPerFrame) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(60.0);
  const DopplerInput input = look(0.5);
  const RasterGeometry raster = fit_raster(input.geometry, 320, 240);
  image::GrayImage gray{320, 240, std::vector<std::uint8_t>(320 * 240, 20)};
  doppler.render(input);
  doppler.overlay(gray, raster);
  doppler.settings.scale_cm_per_s = 30.0;
  const testing::AllocationGuard guard;
  doppler.render(input);
  doppler.overlay(gray, raster);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(ColourDoppler, SurvivesWildPoses) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings.scale_cm_per_s = std::numeric_limits<double>::quiet_NaN();
  doppler.settings.box = {0.9, 0.1, 0.0, 5.0};
  DopplerInput input = look(0.0);
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), 1e30, 0.0}) {
    input.X_PT = Pose(Mat3::Constant(value), Vec3::Constant(value));
    for (const float velocity : doppler.render(input).velocity_cm_per_s) ASSERT_TRUE(std::abs(velocity) <= 30.1F);
  }
}

TEST(ColourDoppler, ColoursTheVesselAndLeavesBrightTissueGray) {
  ColourDoppler doppler(tube_flow(40.0));
  doppler.settings = quiet(60.0);
  const DopplerInput input = look(0.0);
  const RasterGeometry raster = fit_raster(input.geometry, 320, 240);
  image::GrayImage gray{320, 240, std::vector<std::uint8_t>(320 * 240, 20)};
  doppler.render(input);
  const Vec2 middle = raster.to_pixel({0.0, 50.0});
  const auto pixel = [&](const image::RgbImage& image) {
    return image.at(static_cast<int>(middle.x()), static_cast<int>(middle.y()));
  };
  const image::Rgb away = pixel(doppler.overlay(gray, raster));
  EXPECT_GT(away[2], away[0] + 50);  // blue
  const image::Rgb beside = doppler.overlay(gray, raster).at(2, 2);
  EXPECT_EQ(beside, (image::Rgb{20, 20, 20}));
  doppler.settings.is_inverted = true;
  doppler.render(input);
  const image::Rgb inverted = pixel(doppler.overlay(gray, raster));
  EXPECT_GT(inverted[0], inverted[2] + 50);
  std::fill(gray.pixels.begin(), gray.pixels.end(), std::uint8_t{200});
  EXPECT_EQ(pixel(doppler.overlay(gray, raster)), (image::Rgb{200, 200, 200}));
}

TEST(ColourDoppler, ShowsNoFlowBehindBone) {
  // A vessel along x, 20 to 36 mm deep; before it bone on one side.
  anatomy::VirtualPatient patient = testing::make_block(Vec3(120, 90, 60), Vec3(1, 1, 1), [](const Vec3& p) {
    if (std::hypot(p.y() - 28.0, p.z()) < 8.0) return testing::BlockVoxel{testing::kVessel, 40};
    if (p.x() > 5.0 && p.y() > 8.0 && p.y() < 14.0) return testing::BlockVoxel{testing::kBone, 900};
    return testing::BlockVoxel{testing::kLiver, 60};
  });
  patient.label_table.labels[testing::kVessel - 1].name = "tube";
  FlowTable table = make_steady_table(40.0, kPlug);
  table.rules[0].near = {"the lung"};  // absent, so the head's end counts: any
  const auto flow = make_vessel_flow(patient, table);
  ASSERT_TRUE(flow.has_value()) << flow.error().text();
  const auto acoustics = load_acoustic_table(data_dir() / "acoustics.toml");
  const auto scene = make_acoustic_scene(patient, *acoustics);
  ASSERT_TRUE(scene.has_value()) << scene.error().text();
  const auto transducer = load_transducer(data_dir() / "transducers.toml", "C5-2");
  Acquisition acquisition = default_acquisition(*transducer);
  acquisition.depth_mm = 60.0;
  acquisition.lines = 128;
  acquisition.samples = 256;
  BMode engine(*scene, *transducer, acquisition);
  DopplerInput input;
  input.X_PT = Pose(Mat3::Identity(), Vec3(0.0, 1.0, 0.0));
  input.engine = &engine;
  const BasebandFrame& echoes = engine.render({input.X_PT, {}, 0.0});
  input.geometry = echoes.geometry;
  input.beam = echoes.beam;
  ColourDoppler doppler(*flow);
  doppler.settings = quiet(30.0);
  doppler.settings.box = {0.0, 1.0, 0.3, 0.7};
  const DopplerFrame& frame = doppler.render(input);
  int free = 0, behind = 0;
  for (int line = 0; line < frame.lines; ++line)
    for (int gate = 0; gate < frame.gates; ++gate) {
      const Vec2 p_T = frame.has_flow[frame.at(line, gate)] != 0
                           ? input.geometry.to_cartesian({frame.first_line + frame.line_step * line, 28.0})
                           : Vec2(0.0, 0.0);
      free += p_T.x() < -12.0 ? 1 : 0;
      behind += p_T.x() > 12.0 ? 1 : 0;
    }
  EXPECT_GT(free, 100);
  EXPECT_LT(behind, 3);
}

TEST(DopplerSettings, TieScaleAndPulseRate) {
  // v = c PRF / (4 f): 1540 m/s · 4 kHz / (4 · 2.5 MHz) = 61.6 cm/s.
  EXPECT_NEAR(nyquist_cm_per_s(4000.0, 2.5), 61.6, 1e-9);
  EXPECT_NEAR(prf_hz(61.6, 2.5), 4000.0, 1e-6);
  // The shift at that velocity is half the pulse rate.
  EXPECT_NEAR(doppler_shift_hz(61.6, 0.0, 2.5), 2000.0, 1e-6);
  EXPECT_NEAR(doppler_shift_hz(61.6, std::numbers::pi / 3.0, 2.5), 1000.0, 1e-6);
  // From 154 mm echoes take 0.2 ms: at most 5 kHz.
  DopplerSettings settings;
  settings.scale_cm_per_s = 200.0;
  EXPECT_NEAR(usable_scale_cm_per_s(settings, 154.0), nyquist_cm_per_s(5000.0, 2.5), 1e-9);
}

TEST(DopplerSettings, RefuseOutOfRangeValues) {
  EXPECT_TRUE(check(DopplerSettings{}).has_value());
  DopplerSettings settings;
  settings.scale_cm_per_s = 1000.0;
  EXPECT_FALSE(check(settings).has_value());
  EXPECT_EQ(within_ranges(settings).scale_cm_per_s, 200.0);
  settings = {};
  settings.box.near = 0.95;
  EXPECT_FALSE(check(settings).has_value());
  EXPECT_EQ(within_ranges(settings).box, DopplerBox{});
}

TEST(FlowCaliper, CorrectsForTheAngle) {
  const ScanGeometry scan = make_scan_geometry(doppler_linear(), 100.0, 64, 512);
  const FlowCaliper caliper{{0.0, 50.0}, {std::sqrt(3.0), -1.0}};
  EXPECT_NEAR(caliper.angle_rad(scan), std::numbers::pi / 3.0, 1e-9);
  EXPECT_NEAR(caliper.corrected_cm_per_s(20.0, scan), 40.0, 1e-9);
  EXPECT_EQ((FlowCaliper{{0.0, 50.0}, {1.0, 0.0}}).corrected_cm_per_s(20.0, scan), 0.0);
}

TEST(DopplerColour, TurnsAtTheShiftedBaseline) {
  DopplerSettings settings;
  const auto is_red = [&](double share) {
    const image::Rgb colour = doppler_colour(share, settings);
    return colour[0] > colour[2];
  };
  EXPECT_TRUE(is_red(0.5));
  EXPECT_FALSE(is_red(-0.5));
  settings.baseline = 0.6;  // from -0.4 to 1.6: what was aliased from 1.4 is shown as such
  EXPECT_TRUE(is_red(-0.6));
  EXPECT_FALSE(is_red(-0.3));
}

}  // namespace
}  // namespace trocar::ultrasound
