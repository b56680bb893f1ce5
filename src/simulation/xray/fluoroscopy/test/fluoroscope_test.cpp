#include "xray/fluoroscopy/fluoroscope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "anatomy/patient.h"
#include "core/parallel.h"
#include "motion/testing/sliding_motion.h"
#include "xray/detector/scatter.h"
#include "xray/fluoroscopy/testing/trunk_phantom.h"

namespace trocar::xray {
namespace {

constexpr int kFramePixels = 128;

std::size_t frame_index(int column, int row) {
  return static_cast<std::size_t>(row * kFramePixels + column);
}

FluoroscopyRequest small_request() {
  FluoroscopyRequest request;
  request.arm.pixels = kFramePixels;
  request.arm.field_mm = 200.0;
  request.is_pedal_down = true;
  return request;
}

ToolShape needle() {
  ToolShape tool;
  tool.line_P = {{-30.0, 0.0, 20.0}, {-30.0, 0.0, 0.0}};
  tool.outer_radius_mm = 1.5;
  return tool;
}

std::shared_ptr<const Iodine> duct() {
  auto iodine = std::make_shared<Iodine>();
  iodine->pieces.push_back({{25.0, 0.0, -20.0}, {25.0, 0.0, 20.0}, 3.0, 3.0, 150.0});
  return iodine;
}

/// Runs the pedal for some time; the last frame.
FluoroscopyFrame run(Fluoroscope& fluoroscope, FluoroscopyRequest& request, double seconds) {
  const double begun_s = request.time_s;
  FluoroscopyFrame frame;
  for (int n = 0; n <= static_cast<int>(std::lround(60.0 * seconds)); ++n) {
    request.time_s = begun_s + n / 60.0;
    frame = fluoroscope.frame(request, static_cast<std::uint64_t>(n)).value();
  }
  return frame;
}

/// Pixel on which a point falls.
std::size_t pixel_of(const CArm& arm, const Vec3& p_P) {
  const auto [column, row] = rays_of(arm).project(p_P);
  return frame_index(static_cast<int>(std::lround(column)), static_cast<int>(std::lround(row)));
}

TEST(Fluoroscope, CountsPulsesAndDoseWhileThePedalIsDown) {
  for (const double rate : kPulseRates_per_s) {
    Fluoroscope fluoroscope(testing::trunk());
    FluoroscopyRequest request = small_request();
    request.pulses_per_s = rate;
    const FluoroscopyFrame frame = run(fluoroscope, request, 2.0);
    EXPECT_EQ(frame.dose.pulses, static_cast<int>(2.0 * rate) + 1) << "one at once, then by the rate";
    EXPECT_NEAR(frame.dose.beam_on_s, 2.0, 1.0 / rate + 1e-9);
    EXPECT_GT(frame.dose.air_kerma_mgy, 0.0);
    request.is_pedal_down = false;
    EXPECT_EQ(run(fluoroscope, request, 3.0).dose.pulses, frame.dose.pulses);
  }
}

TEST(Fluoroscope, HasATypicalDoseRateForAnAbdomen) {
  Fluoroscope fluoroscope(testing::trunk());
  FluoroscopyRequest request = small_request();
  const FluoroscopyFrame frame = run(fluoroscope, request, 4.0);
  const double mgy_per_min = frame.dose.air_kerma_mgy / frame.dose.beam_on_s * 60.0;
  // Entrance air kerma of pulsed fluoroscopy behind 20 cm of tissue: some 5 to 30 mGy/min.
  EXPECT_GT(mgy_per_min, 2.0);
  EXPECT_LT(mgy_per_min, 40.0);
}

TEST(Fluoroscope, HoldsTheLastImage) {
  Fluoroscope fluoroscope(testing::trunk());
  FluoroscopyRequest request = small_request();
  FluoroscopyRequest up = request;
  up.is_pedal_down = false;
  const FluoroscopyFrame dark = fluoroscope.frame(up, 1).value();
  EXPECT_EQ(*std::max_element(dark.gray.pixels.begin(), dark.gray.pixels.end()), 0) << "before the first pulse";
  const FluoroscopyFrame live = run(fluoroscope, request, 0.5);
  EXPECT_FALSE(live.is_held);
  request.is_pedal_down = false;
  request.tools = {needle()};
  request.arm.lao_deg = 30.0;
  const FluoroscopyFrame held = run(fluoroscope, request, 0.5);
  EXPECT_TRUE(held.is_held);
  EXPECT_EQ(held.gray.pixels, live.gray.pixels);
  EXPECT_EQ(held.arm.lao_deg, 0.0);
  request.display.is_inverted = true;
  EXPECT_NE(run(fluoroscope, request, 0.1).gray.pixels, live.gray.pixels) << "its display may change";
  request.is_pedal_down = true;
  EXPECT_NE(run(fluoroscope, request, 0.1).gray.pixels, live.gray.pixels);
}

/// A box of fat (a material with a negative share of bone), 120 x 80 x 120 mm.
std::shared_ptr<const XrayVolume> fat() {
  auto patient = std::make_shared<anatomy::VirtualPatient>();
  patient->name = "fat";
  volume::GridGeometry geometry;
  geometry.size = {40, 30, 40};
  geometry.spacing_mm = Vec3::Constant(4.0);
  geometry.origin_P = -2.0 * Vec3(39, 29, 39);
  patient->ct = volume::CtGrid(geometry, -1000);
  patient->labels = volume::LabelGrid(geometry);
  patient->label_table.labels.push_back({1, "fat", "adipose", {}});
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
    if ((p_P.array().abs() >= Eigen::Array3d(60, 40, 60)).any()) continue;
    patient->ct.voxels[n] = -100;
    patient->labels.voxels[n] = 1;
  }
  return XrayVolume::make(patient).value();
}

TEST(Fluoroscope, HidesATraceOfContrastAgent) {
  FluoroscopyRequest request = small_request();
  request.arm.field_mm = 100.0;
  auto iodine = std::make_shared<Iodine>();
  iodine->pieces.push_back({{0.0, 0.0, -20.0}, {0.0, 0.0, 20.0}, 10.0, 10.0, 1e-6});
  Fluoroscope without(fat()), with(fat());
  const image::GrayImage expected = without.frame(request, 1).value().gray;
  request.iodine = iodine;
  const image::GrayImage traced = with.frame(request, 1).value().gray;
  for (std::size_t n = 0; n < expected.pixels.size(); ++n) EXPECT_NEAR(traced.pixels[n], expected.pixels[n], 1);
}

TEST(Fluoroscope, ShowsATubeOfSteelByBeersLaw) {
  DetectorParams params;
  params.scatter_per_g_per_cm2 = 0.0;
  params.focal_spot_mm = 0.0;
  Fluoroscope fluoroscope(testing::trunk(), params);
  FluoroscopyRequest request = small_request();
  const FluoroscopyFrame before = run(fluoroscope, request, 0.0);
  const std::size_t pixel = pixel_of(request.arm, {-30.0, 0.0, 10.0});
  const double without = fluoroscope.clean_signal()[pixel];
  ToolShape tube = needle();  // wide, so that the pixel's width does not matter
  tube.outer_radius_mm = 4.0;
  tube.density_g_per_cm3 = 2.0;
  request.tools = {tube};
  request.time_s = 1.0;
  const FluoroscopyFrame after = run(fluoroscope, request, 0.0);
  EXPECT_EQ(before.exposure, after.exposure);
  // 20 g/cm² of water in the middle, less at the needle: its chord there, by the ellipse.
  const double chord_cm = 20.0 * std::sqrt(1.0 - std::pow(30.0 / 140.0, 2));
  const Beam beam = Beam::make(tube_spectrum(after.exposure.tube).value()).value();
  const double ratio = beam.signal({chord_cm, 0.0, 0.0, 0.8 * 2.0}) / beam.signal({chord_cm, 0.0, 0.0, 0.0});
  EXPECT_NEAR(fluoroscope.clean_signal()[pixel] / without, ratio, 0.03 * ratio);
  EXPECT_LT(after.gray.pixels[pixel], before.gray.pixels[pixel]);
}

TEST(Fluoroscope, CachedMassesDoNotChangeTheSignal) {
  FluoroscopyRequest request = small_request();
  Fluoroscope used(testing::trunk());
  run(used, request, 0.2);
  request.arm.lao_deg = 20.0;
  run(used, request, 0.2);
  request.arm.lao_deg = 0.0;
  request.tools = {needle()};
  request.iodine = duct();
  request.dose_mode = DoseMode::kHigh;
  run(used, request, 0.2);
  Fluoroscope fresh(testing::trunk());
  run(fresh, request, 0.0);
  EXPECT_EQ(used.clean_signal(), fresh.clean_signal());
}

TEST(Fluoroscope, HasTheNoiseOfItsPhotons) {
  DetectorParams params;
  params.lag_share = 0.0;
  for (const DoseMode mode : {DoseMode::kLow, DoseMode::kHigh}) {
    Fluoroscope fluoroscope(testing::trunk(), params);
    FluoroscopyRequest request = small_request();
    request.dose_mode = mode;
    const FluoroscopyFrame frame = run(fluoroscope, request, 0.0);
    const Beam beam = Beam::make(tube_spectrum(frame.exposure.tube).value()).value();
    const double pixel_mm = request.arm.field_mm / kFramePixels;
    const double photons = at_distance(beam.detected_photons(), request.arm.source_detector_mm) * frame.exposure.mas *
                           pixel_mm * pixel_mm * params.grid_primary;
    // Blur by three weights in each direction keeps this share of the variance.
    const double v = std::pow(scintillator_sigma_mm(params) / pixel_mm, 2);
    const double kept = std::pow((1 - v) * (1 - v) + 0.5 * v * v, 2);
    double sum = 0.0;
    int count = 0;
    for (int row = 2; row < kFramePixels - 2; ++row)
      for (int column = 2; column < kFramePixels - 2; ++column, ++count) {
        const double clean = fluoroscope.clean_signal()[frame_index(column, row)];
        sum += std::pow(fluoroscope.signal()[frame_index(column, row)] - clean, 2) / clean;
      }
    const double expected = kept * beam.noise_factor() / photons;
    EXPECT_NEAR(sum / count, expected, 0.05 * expected);
  }
}

TEST(Fluoroscope, SubtractsAllButTheContrastAgent) {
  Fluoroscope fluoroscope(testing::trunk());
  FluoroscopyRequest request = small_request();
  request.mode = ImageMode::kSubtraction;
  request.dose_mode = DoseMode::kHigh;
  EXPECT_EQ(run(fluoroscope, request, 1.0).mask_frames, Fluoroscope::kMaskFrames);
  request.iodine = duct();
  const FluoroscopyFrame frame = run(fluoroscope, request, 0.5);
  ASSERT_TRUE(frame.is_subtracted);
  const auto mean = [&](const Vec3& p_P) {
    double sum = 0.0;
    const std::size_t middle = pixel_of(request.arm, p_P);
    for (int v = -1; v <= 1; ++v)
      for (int u = -1; u <= 1; ++u) sum += frame.gray.pixels[middle + static_cast<std::size_t>(v * kFramePixels + u)];
    return sum / 9.0;
  };
  const double duct_gray = mean({25, 0, 0}), water = mean({-40, 0, 0}), bone = mean({0, 40, 10});
  EXPECT_LT(duct_gray, water - 80.0);
  EXPECT_NEAR(bone, water, 25.0) << "bone is subtracted";
  // The map of this run lightens the duct over a live image.
  request.iodine.reset();
  request.mode = ImageMode::kRoadMap;
  request.display.window = GrayWindow{1.0F, 4.0F};  // the duct's place is gray
  const std::size_t pixel = pixel_of(request.arm, {25, 0, 0});
  const FluoroscopyFrame road = run(fluoroscope, request, 0.5);
  request.mode = ImageMode::kLive;
  const FluoroscopyFrame live = run(fluoroscope, request, 0.2);
  EXPECT_GT(road.gray.pixels[pixel], live.gray.pixels[pixel] + 30);
}

TEST(Fluoroscope, MovesThePatientButNotTheTools) {
  Fluoroscope fluoroscope(testing::trunk());
  FluoroscopyRequest request = small_request();
  request.iodine = duct();
  request.tools = {needle()};
  const auto model = motion::testing::uniform_model({8.0, 0.0, 0.0});
  request.motion = motion::PatientMotion(model.get(), {.drivers = {1.0}});
  run(fluoroscope, request, 0.0);
  const std::vector<float>& signal = fluoroscope.clean_signal();
  EXPECT_LT(signal[pixel_of(request.arm, {33.0, 0, 0})], 0.8 * signal[pixel_of(request.arm, {25.0, 0, 0})]);
  EXPECT_LT(signal[pixel_of(request.arm, {-30.0, 0, 10})], 0.8 * signal[pixel_of(request.arm, {-38.0, 0, 10})]);
}

TEST(Fluoroscope, ShuttersDarkenTheImageAndReduceTheAreaProduct) {
  Fluoroscope open(testing::trunk()), narrow(testing::trunk());
  FluoroscopyRequest request = small_request();
  const FluoroscopyFrame wide = run(open, request, 0.0);
  request.arm.collimation = {0.5, 0.5};
  const FluoroscopyFrame frame = run(narrow, request, 0.0);
  EXPECT_EQ(frame.gray.pixels[frame_index(5, 64)], 0);
  EXPECT_EQ(frame.gray.pixels[frame_index(64, 120)], 0);
  EXPECT_NEAR(frame.dose.area_product_mgy_cm2 / frame.dose.air_kerma_mgy,
              0.25 * wide.dose.area_product_mgy_cm2 / wide.dose.air_kerma_mgy, 1e-9);
  EXPECT_LT(narrow.clean_signal()[frame_index(64, 40)], open.clean_signal()[frame_index(64, 40)]) << "less scatter";
}

TEST(Fluoroscope, IsTheSameOnAnyNumberOfThreads) {
  FluoroscopyRequest request = small_request();
  request.tools = {needle()};
  request.iodine = duct();
  std::vector<float> one, many;
  run_on_threads(1, [&] {
    Fluoroscope fluoroscope(testing::trunk());
    run(fluoroscope, request, 0.0);
    one = fluoroscope.signal();
  });
  Fluoroscope fluoroscope(testing::trunk());
  run(fluoroscope, request, 0.0);
  many = fluoroscope.signal();
  EXPECT_EQ(one, many);
}

TEST(Fluoroscope, NamesImpossibleRequests) {
  Fluoroscope fluoroscope(testing::trunk());
  const auto what = [&](const FluoroscopyRequest& request) {
    const auto frame = fluoroscope.frame(request, 1);
    return frame ? std::string() : frame.error().text();
  };
  FluoroscopyRequest request = small_request();
  request.pulses_per_s = 12.0;
  EXPECT_NE(what(request).find("pulse rate"), std::string::npos);
  request = small_request();
  request.arm.isocentre_P = Vec3(0, -request.arm.source_isocentre_mm, 0);  // AP: the source is behind
  EXPECT_NE(what(request).find("source is inside"), std::string::npos);
  request = small_request();
  request.arm.isocentre_P = Vec3(0, request.arm.source_detector_mm - request.arm.source_isocentre_mm, 0);
  EXPECT_NE(what(request).find("detector is inside"), std::string::npos);
  request = small_request();
  request.filters.copper_mm = 7.0;
  EXPECT_FALSE(what(request).empty());
  EXPECT_EQ(what(small_request()), "");
}

}  // namespace
}  // namespace trocar::xray
