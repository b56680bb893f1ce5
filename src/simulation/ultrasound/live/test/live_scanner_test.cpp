#include "ultrasound/live/live_scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "lab/ultrasound/test_scenes.h"
#include "ultrasound/live/picture_maker.h"

namespace trocar::ultrasound {
namespace {

constexpr double kLiveDepth_mm = 60.0;

Transducer small_probe() {
  Transducer transducer;
  transducer.kind = TransducerKind::kLinear;
  transducer.elements = 80;
  transducer.pitch_mm = 0.5;
  transducer.greatest_depth_mm = 100.0;
  return transducer;
}

/// Tissue with a bright block at positive x.
ScenePtr scene() {
  static const ScenePtr made = [] {
    const TestRod rod{12.0, 30.0, 6.0, TestTissue::kPlus12};
    return rods_scene(box_for(small_probe(), kLiveDepth_mm), TestTissue::kMinus12, std::span(&rod, 1));
  }();
  return made;
}

ScanRequest small_request() {
  ScanRequest request;
  request.acquisition.depth_mm = kLiveDepth_mm;
  request.acquisition.focus_mm = 30.0;
  request.acquisition.lines = 64;
  request.acquisition.samples = 256;
  request.columns = 120;
  request.rows = 160;
  return request;
}

/// Mean gray around a place of the image plane.
double gray_at(const ScanPicture& picture, const Vec2& p_T, double half_mm = 3.0) {
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < picture.gray.rows; ++row)
    for (int column = 0; column < picture.gray.columns; ++column) {
      if ((picture.raster.to_T(column, row) - p_T).cwiseAbs().maxCoeff() > half_mm) continue;
      sum += picture.gray.pixels[static_cast<std::size_t>(row * picture.gray.columns + column)];
      ++count;
    }
  return sum / std::max(count, 1);
}

/// Asks again and again, as a window does, until a picture is as it should be; nullptr after a long time.
template <class Ready>
std::shared_ptr<const ScanPicture> ask_until(LiveScanner& scanner, ScanRequest request, const Ready& is_ready) {
  for (int n = 0; n < 10000; ++n) {
    request.time_s += 1.0 / 60.0;
    scanner.request(request);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const auto picture = scanner.pictures().value();
    if (picture && is_ready(*picture)) return picture;
  }
  return nullptr;
}

TEST(PictureMaker, ReportsTheImageCornersInThePatient) {
  PictureMaker maker(scene(), small_probe());
  ScanRequest request = small_request();
  Mat3 R_PT;
  R_PT.col(0) = Vec3(0, 0, 1);
  R_PT.col(1) = Vec3(0, 1, 0);
  R_PT.col(2) = Vec3(-1, 0, 0);
  request.X_PT = Pose(R_PT, {0, 0, 0});
  for (const bool is_mirrored : {false, true}) {
    request.display.is_mirrored = is_mirrored;
    const ScanPicture picture = maker.make(request, ScanDetail::kFull, 1);
    const Vec3 right = picture.corners_P[1] - picture.corners_P[0];
    const Vec3 down = picture.corners_P[2] - picture.corners_P[0];
    EXPECT_NEAR(right.norm(), picture.raster.columns * picture.raster.mm_per_pixel, 1e-9);
    EXPECT_NEAR(down.norm(), picture.raster.rows * picture.raster.mm_per_pixel, 1e-9);
    EXPECT_LT((right.normalized() - (is_mirrored ? Vec3(0, 0, -1) : Vec3(0, 0, 1))).norm(), 1e-9);
    EXPECT_LT((down.normalized() - Vec3(0, 1, 0)).norm(), 1e-9);
  }
}

TEST(PictureMaker, ShowsTheSameContentAtEveryDetail) {
  PictureMaker maker(scene(), small_probe());
  for (const ScanDetail detail : {ScanDetail::kFast, ScanDetail::kMiddle, ScanDetail::kFull}) {
    const ScanPicture picture = maker.make(small_request(), detail, 1);
    EXPECT_GT(gray_at(picture, {12.0, 30.0}), gray_at(picture, {-12.0, 30.0}) + 20.0);
    EXPECT_EQ(picture.detail, detail);
  }
  EXPECT_EQ(maker.cine()->size(), 3);
}

TEST(PictureMaker, RedisplaysKeptImagesWithNewGain) {
  PictureMaker maker(scene(), small_probe());
  ScanRequest request = small_request();
  const ScanPicture live = maker.make(request, ScanDetail::kFull, 1);
  const ScanPicture kept = maker.show_kept(request);
  // Levels have steps of half a dB, a gray map's steepest part some 5 grays a dB.
  double worst = 0.0;
  for (std::size_t n = 0; n < live.gray.pixels.size(); ++n)
    worst = std::max(worst, std::abs(static_cast<double>(live.gray.pixels[n]) - kept.gray.pixels[n]));
  EXPECT_LE(worst, 8.0);
  EXPECT_TRUE(kept.is_frozen);
  request.display.gain_db = 12.0;
  EXPECT_GT(gray_at(maker.show_kept(request), {-12.0, 30.0}), gray_at(kept, {-12.0, 30.0}) + 20.0);
}

TEST(PictureMaker, BeginsANewLoopAtAnotherDepth) {
  PictureMaker maker(scene(), small_probe());
  ScanRequest request = small_request();
  maker.make(request, ScanDetail::kFull, 1);
  maker.make(request, ScanDetail::kFast, 2);
  EXPECT_EQ(maker.cine()->size(), 2);
  request.acquisition.depth_mm = 40.0;
  maker.make(request, ScanDetail::kFull, 3);
  EXPECT_EQ(maker.cine()->size(), 1);
  EXPECT_EQ(maker.show_kept(request).scan.depth_mm, 40.0);
}

TEST(ResampleLevels, PreservesRampsAndIsExactForTheSameScan) {
  const Transducer probe = small_probe();
  const ScanGeometry coarse = make_scan_geometry(probe, kLiveDepth_mm, 32, 128);
  const ScanGeometry fine = make_scan_geometry(probe, kLiveDepth_mm, 64, 256);
  std::vector<std::uint8_t> from, same, to;
  for (int line = 0; line < 32; ++line)
    for (int s = 0; s < 128; ++s) from.push_back(static_cast<std::uint8_t>(2 * line + s));
  resample_levels(from, coarse, coarse, same);
  EXPECT_EQ(same, from);
  resample_levels(from, coarse, fine, to);
  for (int line = 0; line < 64; ++line)
    for (int s = 2; s < 254; ++s) {
      const double expected = 2.0 * line * 31.0 / 63.0 + (s + 0.5) / 2.0 - 0.5;
      EXPECT_NEAR(to[static_cast<std::size_t>(line * 256 + s)], expected, 1.0);
    }
}

TEST(ShownPlace, LiesDeeperUnderAPressedFace) {
  PictureMaker maker(scene(), small_probe());
  ScanRequest request = small_request();
  EXPECT_NEAR((shown_place_T(maker.make(request, ScanDetail::kFull, 1), {3.0, 30.0, 0.0}) - Vec2(3.0, 30.0)).norm(),
              0.0, 0.1);
  request.X_PT = Pose::translation({0.0, 5.0, 0.0});  // 5 mm into the skin
  const ScanPicture pressed = maker.make(request, ScanDetail::kFull, 2);
  const double shallow = shown_place_T(pressed, {3.0, 10.0, 0.0}).y();
  EXPECT_GT(shallow, 10.0 - 5.0 + 0.5) << "tissue is pushed ahead of the face";
  EXPECT_LT(shallow, 10.0);
  EXPECT_NEAR(shown_place_T(pressed, {3.0, 60.0, 0.0}).y(), 55.0, 0.05) << "beyond the reach nothing yields";
}

TEST(LiveScanner, ShowsTheNewestOfManyRequests) {
  LiveScanner scanner;
  EXPECT_EQ(scanner.pictures().value(), nullptr);
  scanner.open(scene(), small_probe());
  ScanRequest request = small_request();
  for (int n = 0; n < 200; ++n) {
    request.X_PT = Pose::translation({0.05 * n, 0.0, 0.0});
    scanner.request(request);
  }
  const double last_mm = request.X_PT.p().x();
  const auto picture =
      ask_until(scanner, request, [&](const ScanPicture& made) { return made.X_PT.p().x() == last_mm; });
  ASSERT_NE(picture, nullptr);
  EXPECT_LT(picture->number, 100U) << "requests that came before a newer one are left out";
  const auto full =
      ask_until(scanner, request, [](const ScanPicture& made) { return made.detail == ScanDetail::kFull; });
  ASSERT_NE(full, nullptr);
  EXPECT_EQ(full->scan.lines, request.acquisition.lines);
}

TEST(LiveScanner, KeepsTheFrozenImageWhileTheProbeMoves) {
  LiveScanner scanner;
  scanner.open(scene(), small_probe());
  ScanRequest request = small_request();
  scanner.set_frozen(true);
  EXPECT_FALSE(scanner.cine().is_frozen) << "there is nothing to freeze";
  ASSERT_NE(ask_until(scanner, request, [](const ScanPicture& made) { return made.detail == ScanDetail::kFull; }),
            nullptr);
  scanner.set_frozen(true);
  request.X_PT = Pose::translation({8.0, 0.0, 0.0});
  const auto frozen = ask_until(scanner, request, [](const ScanPicture& made) { return made.is_frozen; });
  ASSERT_NE(frozen, nullptr);
  EXPECT_EQ(frozen->X_PT.p().x(), 0.0);
  request.display.gain_db = 10.0;
  const auto brighter =
      ask_until(scanner, request, [](const ScanPicture& made) { return made.display.gain_db == 10.0; });
  ASSERT_NE(brighter, nullptr);
  EXPECT_EQ(brighter->X_PT.p().x(), 0.0);
  EXPECT_GT(gray_at(*brighter, {-12.0, 30.0}), gray_at(*frozen, {-12.0, 30.0}) + 10.0);
  scanner.set_frozen(false);
  EXPECT_NE(ask_until(scanner, request, [](const ScanPicture& made) { return made.X_PT.p().x() == 8.0; }), nullptr);
}

TEST(LiveScanner, StepsAndPlaysTheCineLoop) {
  LiveScanner scanner;
  scanner.open(scene(), small_probe());
  ScanRequest request = small_request();
  for (int n = 0; n < 5; ++n) {
    request.X_PT = Pose::translation({1.0 * n, 0.0, 0.0});
    const auto is_there = [&](const ScanPicture& made) { return made.X_PT.p().x() == 1.0 * n; };
    ASSERT_NE(ask_until(scanner, request, is_there), nullptr);
    request.time_s += 0.1;
  }
  scanner.set_frozen(true);
  ASSERT_NE(ask_until(scanner, request, [](const ScanPicture& made) { return made.is_frozen; }), nullptr);
  const CineState state = scanner.cine();
  EXPECT_GE(state.size, 5);
  EXPECT_EQ(state.position, state.size - 1);
  scanner.show_cine(0);
  EXPECT_NE(ask_until(scanner, request, [](const ScanPicture& made) { return made.X_PT.p().x() == 0.0; }), nullptr);
  EXPECT_EQ(scanner.cine().position, 0);
  scanner.step_cine(2);
  const auto is_at = [&](int position) {
    return [&scanner, position](const ScanPicture&) { return scanner.cine().position == position; };
  };
  EXPECT_NE(ask_until(scanner, request, is_at(2)), nullptr);
  scanner.play_cine(true);
  EXPECT_NE(ask_until(scanner, request, is_at(state.size - 1)), nullptr);
  EXPECT_NE(ask_until(scanner, request, is_at(0)), nullptr) << "begins again";
  EXPECT_TRUE(scanner.cine().is_playing);
  scanner.step_cine(1);
  EXPECT_FALSE(scanner.cine().is_playing);
}

TEST(LiveScanner, ForgetsAClosedPatient) {
  LiveScanner scanner;
  scanner.open(scene(), small_probe());
  const ScanRequest request = small_request();
  ASSERT_NE(ask_until(scanner, request, [](const ScanPicture&) { return true; }), nullptr);
  Transducer other = small_probe();
  other.elements = 60;
  scanner.open(scene(), other);
  EXPECT_EQ(scanner.pictures().value(), nullptr);
  EXPECT_EQ(scanner.cine().size, 0);
  const auto picture = ask_until(scanner, request, [](const ScanPicture&) { return true; });
  ASSERT_NE(picture, nullptr);
  EXPECT_NEAR(picture->scan.line_origin(0).x(), -0.5 * 59 * 0.5, 1e-9);
}

TEST(LiveScanner, IgnoresInvalidPoses) {
  LiveScanner scanner;
  scanner.open(scene(), small_probe());
  ScanRequest bad = small_request();
  bad.X_PT = Pose::translation(Vec3::Constant(std::nan("")));
  scanner.request(bad);
  bad = small_request();
  bad.needle_shaft_P = {Vec3::Zero(), Vec3::Constant(std::nan(""))};
  scanner.request(bad);
  ScanRequest wild = small_request();
  wild.acquisition.lines = 1 << 20;
  wild.acquisition.depth_mm = -3.0;
  wild.display.gain_db = std::nan("");
  const auto picture = ask_until(scanner, wild, [](const ScanPicture&) { return true; });
  ASSERT_NE(picture, nullptr);
  EXPECT_TRUE(picture->X_PT.is_finite());
}

}  // namespace
}  // namespace trocar::ultrasound
