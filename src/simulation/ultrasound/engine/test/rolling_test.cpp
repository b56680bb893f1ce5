// Rolling acquisition: a frame renews some scanlines, the others keep their echoes.

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/live/picture_maker.h"
#include "ultrasound/scanner/scanner.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr int kRollingLines = 128;

ScenePtr make_rolling_scene(const Transducer& transducer) {
  const TestRod rods[] = {{0.0, 30.0, 9.0, TestTissue::kSlow, 1.0},
                          {-16.0, 34.0, 7.0, TestTissue::kFast, 3.0},
                          {-6.0, 52.0, 8.0, TestTissue::kPlus6, 2.0}};
  return plane_scene(box_for(transducer, 90.0, 1.0), TestTissue::kTissue, TestPlane{64.0, 0.1}, rods, {});
}

Acquisition coarse_rolling(const Transducer& transducer) {
  Acquisition acquisition = plain(transducer, Artefacts{});
  acquisition.depth_mm = 80.0;
  acquisition.lines = kRollingLines;
  acquisition.samples = 400;
  return acquisition;
}

const Pose kBefore = Pose::translation({0.0, 1.0, 0.0}), kNow = Pose::translation({2.0, 1.5, 1.0});

BModeInput renewing(const Pose& X_PT, const LineRange& lines) {
  BModeInput input;
  input.X_PT = X_PT;
  input.renewed = lines;
  return input;
}

/// Root mean square of a difference of scanlines, relative to the second frame's echoes.
double difference(const BasebandFrame& a, const BasebandFrame& b, const LineRange& lines) {
  double apart = 0.0, all = 0.0;
  const int samples = a.geometry.samples;
  for (auto n = static_cast<std::size_t>(lines.first * samples); n < static_cast<std::size_t>(lines.last * samples);
       ++n) {
    apart += std::pow(a.re[n] - b.re[n], 2) + std::pow(a.im[n] - b.im[n], 2);
    all += std::pow(b.re[n], 2) + std::pow(b.im[n], 2);
  }
  return std::sqrt(apart / all);
}

TEST(Rolling, KeepsEchoesOfOtherScanlines) {
  const Transducer transducer = convex();
  BMode engine(make_rolling_scene(transducer), transducer, coarse_rolling(transducer));
  const BasebandFrame before = engine.render(renewing(kBefore, {}));
  EXPECT_EQ(before.renewed, (LineRange{0, kRollingLines}));
  const BasebandFrame now = engine.render(renewing(kNow, {40, 72}));
  EXPECT_EQ(now.renewed, (LineRange{40, 72}));
  EXPECT_EQ(difference(now, before, {0, 40}), 0.0);
  EXPECT_EQ(difference(now, before, {72, kRollingLines}), 0.0);
  EXPECT_GT(difference(now, before, {40, 72}), 0.3);
}

TEST(Rolling, RenewedScanlinesMatchAFullFrame) {
  const Transducer transducer = convex();
  const ScenePtr scene = make_rolling_scene(transducer);
  BMode engine(scene, transducer, coarse_rolling(transducer)), whole(scene, transducer, coarse_rolling(transducer));
  const BasebandFrame wanted = whole.render(renewing(kNow, {}));
  engine.render(renewing(kBefore, {}));
  const BasebandFrame& now = engine.render(renewing(kNow, {30, 96}));
  // Old echoes of the neighbours are in the main lobe of the scanlines at the seams, their losses in the aperture's
  // sound and in refraction's averages.
  EXPECT_LT(difference(now, wanted, {50, 76}), 0.08);
  EXPECT_GT(difference(now, wanted, {0, 30}), 0.3);
  for (int round = 0; round < 2; ++round)
    for (int first = 0; first < kRollingLines; first += 31) engine.render(renewing(kNow, {first, first + 31}));
  // Groups of scanlines begin elsewhere: at their edges a scatterer reads the gain of the scanline beside it.
  EXPECT_LT(difference(now, wanted, {0, kRollingLines}), 0.08);
}

TEST(Rolling, FirstFrameIsComplete) {
  const Transducer transducer = convex();
  BMode engine(make_rolling_scene(transducer), transducer, coarse_rolling(transducer));
  EXPECT_EQ(engine.render(renewing(kNow, {8, 16})).renewed, (LineRange{0, kRollingLines}));
  EXPECT_EQ(engine.render(renewing(kNow, {9, 16})).renewed, (LineRange{8, 16})) << "from an even scanline on";
  EXPECT_EQ(engine.render(renewing(kNow, {-5, 4000})).renewed, (LineRange{0, kRollingLines}));
  Acquisition other = coarse_rolling(transducer);
  other.frequency_mhz = 2.5;
  engine.set_acquisition(other);
  EXPECT_EQ(engine.render(renewing(kNow, {8, 16})).renewed, (LineRange{0, kRollingLines}));
}

TEST(Rolling, ScannerKeepsTheNoiseOfOtherScanlines) {
  const Transducer transducer = convex();
  BMode engine(make_rolling_scene(transducer), transducer, coarse_rolling(transducer));
  Scanner scanner(200, 160);
  scanner.show(engine.render(renewing(kBefore, {})), 1);
  const std::vector<std::uint8_t> before = scanner.polar();
  scanner.show(engine.render(renewing(kNow, {40, 72})), 2);
  const auto samples = static_cast<std::ptrdiff_t>(engine.geometry().samples);
  const auto same = [&](std::ptrdiff_t first, std::ptrdiff_t last) {
    return std::equal(before.begin() + first * samples, before.begin() + last * samples,
                      scanner.polar().begin() + first * samples);
  };
  EXPECT_TRUE(same(0, 40));
  EXPECT_FALSE(same(40, 72));
  EXPECT_TRUE(same(72, kRollingLines));
  scanner.settings.gain_db = 6.0;
  scanner.show(engine.render(renewing(kNow, {40, 72})), 3);
  EXPECT_FALSE(same(0, 40)) << "a new gain is that of the whole picture";
}

TEST(Rolling, ImagesRenewAllScanlinesInTurn) {
  const Transducer transducer = convex();
  const ScenePtr scene = make_rolling_scene(transducer);
  PictureMaker maker(scene, transducer);
  ScanRequest request;
  request.acquisition = coarse_rolling(transducer);
  request.columns = 160;
  request.rows = 120;
  request.renewed_share = 0.25;
  request.X_PT = kBefore;
  const ScanPicture before = maker.make(request, ScanDetail::kFull, 1);
  const auto samples = static_cast<std::size_t>(before.scan.samples);
  const auto changed = [&](const ScanPicture& picture) {
    std::vector<int> lines;
    for (int line = 0; line < kRollingLines; ++line) {
      const auto at = static_cast<std::size_t>(line) * samples;
      if (!std::equal(picture.levels.begin() + static_cast<std::ptrdiff_t>(at),
                      picture.levels.begin() + static_cast<std::ptrdiff_t>(at + samples),
                      before.levels.begin() + static_cast<std::ptrdiff_t>(at)))
        lines.push_back(line);
    }
    return lines;
  };
  for (int picture = 1; picture <= 4; ++picture) {
    request.X_PT = Pose::translation({0.5 * picture, 1.0, 0.0});
    const std::vector<int> lines = changed(maker.make(request, ScanDetail::kFull, 1));
    ASSERT_EQ(static_cast<int>(lines.size()), picture * kRollingLines / 4);
    EXPECT_EQ(lines.back(), picture * kRollingLines / 4 - 1);
  }
  const ScanPicture at_rest = maker.make(request, ScanDetail::kFull, 1);
  PictureMaker fresh(scene, transducer);
  EXPECT_TRUE(at_rest.levels == fresh.make(request, ScanDetail::kFull, 1).levels);
}

}  // namespace
}  // namespace trocar::ultrasound
