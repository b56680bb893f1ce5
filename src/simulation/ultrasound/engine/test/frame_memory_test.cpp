// A frame depends on its input and on nothing that was rendered before it: other poses, settings, transducers,
// patients, needles, colour, details.

#include <algorithm>
#include <cmath>
#include <vector>

#include "ultrasound/doppler/test/tube_patient.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "ultrasound/live/picture_maker.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Rods, a bone and a plane of gas. Borders differ from plane to plane: some rods end within the beam.
ScenePtr make_rods_scene(const Transducer& transducer, double plane_tilt_rad) {
  const TestRod rods[] = {{0.0, 30.0, 9.0, TestTissue::kSlow, 1.0},
                          {-16.0, 34.0, 7.0, TestTissue::kFast, 3.0},
                          {15.0, 28.0, 6.0, TestTissue::kDense, 0.5},
                          {24.0, 40.0, 5.0, TestTissue::kBone},
                          {-6.0, 52.0, 8.0, TestTissue::kPlus6, 2.0}};
  const TestPlane plane{64.0, plane_tilt_rad};
  const std::vector<AcousticPoint> points = {{Vec3(4.0, 20.0, 0.5), 20.0}};
  return plane_scene(box_for(transducer, 90.0, 1.0), TestTissue::kTissue, plane, rods, points);
}

Acquisition coarse_frames(const Transducer& transducer) {
  Acquisition acquisition = plain(transducer, Artefacts{});
  acquisition.depth_mm = 80.0;
  acquisition.lines = 64;
  acquisition.samples = 256;
  return acquisition;
}

const std::vector<Vec3>& shaft() {
  static const std::vector<Vec3> points = {{-30.0, 2.0, 0.3}, {-5.0, 24.0, 0.1}, {8.0, 33.0, -0.2}};
  return points;
}

/// What one frame is asked for.
struct Shot {
  Pose X_PT;
  Acquisition acquisition;
  bool has_needle = false;
};

std::vector<Shot> make_shots(const Transducer& transducer) {
  const Acquisition usual = coarse_frames(transducer);
  Acquisition shallow = usual, fine = usual, bare = usual, thin = usual;
  shallow.depth_mm = 45.0;
  shallow.samples = 190;
  fine.lines = 97;
  fine.samples = 300;
  fine.steering_angles = 1;
  bare.artefacts = no_artefacts();
  thin.planes = 1;
  const auto turned = [](const Vec3& axis, double angle_rad, const Vec3& p_P) {
    return Pose(Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), p_P);
  };
  return {{Pose(), usual},
          {turned({1, 0, 0}, 0.2, {0.0, 1.0, 1.5}), usual},
          {turned({0, 1, 0}, 0.5, {4.0, 3.0, -2.0}), usual, true},
          {turned({0, 0, 1}, 0.15, {-3.0, 0.0, 4.0}), shallow},
          {turned({1, 1, 0}, -0.3, {0.0, 2.0, -1.0}), fine, true},
          {turned({1, 0, 1}, 0.1, {0.0, -2.0, 0.4}), usual},  // partly in air
          {Pose(), bare},
          {Pose(), thin},
          {turned({0, 1, 0}, 1.57, {0.0, 1.0, 0.0}), usual}};
}

/// All that an engine gives of a frame.
struct Taken {
  std::vector<float> re, im, contact, gain;
  bool operator==(const Taken&) const = default;
};

Taken take(BMode& engine, const Shot& shot) {
  if (!(engine.acquisition() == shot.acquisition)) engine.set_acquisition(shot.acquisition);
  NeedleEcho needle;
  needle.shaft_P = shaft();
  needle.displacement_mm = 2.0;
  const auto needles = shot.has_needle ? std::span<const NeedleEcho>(&needle, 1) : std::span<const NeedleEcho>{};
  const BasebandFrame& frame = engine.render({shot.X_PT, needles, 0.0});
  Taken taken{frame.re, frame.im, frame.contact, {}};
  for (int line = 0; line < frame.geometry.lines; ++line) {
    const SoundPath way = engine.sound_path(line);
    taken.gain.insert(taken.gain.end(), way.gain.begin(), way.gain.end());
    taken.gain.push_back(way.pressed_mm);
    taken.gain.push_back(way.mirror_depth_mm);
  }
  return taken;
}

std::size_t differences(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) count += a[n] == b[n] ? 0 : 1;
  return count;
}

/// Every shot once behind every other, in one engine that is used on; frames of other patients and transducers are
/// made between them.
TEST(FrameMemory, EngineIsIndependentOfEarlierFrames) {
  const Transducer transducers[] = {convex(), linear()};
  for (std::size_t t = 0; t < 2; ++t) {
    const Transducer &transducer = transducers[t], &other_transducer = transducers[1 - t];
    const ScenePtr scene = make_rods_scene(transducer, 0.2), other_scene = make_rods_scene(other_transducer, -0.3);
    const std::vector<Shot> shots = make_shots(transducer), other_shots = make_shots(other_transducer);
    std::vector<Taken> fresh;
    for (const Shot& shot : shots) {
      BMode engine(scene, transducer, shot.acquisition);
      fresh.push_back(take(engine, shot));
    }
    BMode used(scene, transducer, shots[0].acquisition);
    BMode other(other_scene, other_transducer, other_shots[0].acquisition);
    for (std::size_t before = 0; before < shots.size(); ++before) {
      take(other, other_shots[before]);
      for (std::size_t n = 0; n < shots.size(); ++n) {
        take(used, shots[before]);
        const Taken again = take(used, shots[n]);
        EXPECT_TRUE(again == fresh[n]) << transducer.name << ", shot " << n << " behind " << before << ": "
                                       << differences(again.re, fresh[n].re) << " of " << fresh[n].re.size()
                                       << " samples differ";
      }
    }
  }
}

/// Blood along z through the middle of the scenes.
std::shared_ptr<const VesselFlow> make_flow() {
  const anatomy::VirtualPatient patient =
      make_tube_patient({40.0, 80.0, 60.0}, {1.0, 1.0, 1.0},
                        {{"tube", [](const Vec3& p_P) { return std::hypot(p_P.x(), p_P.y() - 25.0) < 4.0; }}});
  auto flow = make_vessel_flow(patient, make_steady_table(60.0, 2.0));
  EXPECT_TRUE(flow);
  return flow ? *std::move(flow) : nullptr;
}

/// What a live scanner is asked for, and how finely.
struct Ask {
  Shot shot;
  ScanDetail detail = ScanDetail::kFull;
  bool has_doppler = false;
  bool is_mirrored = false;
  int columns = 160;
};

std::vector<Ask> make_asks(const Transducer& transducer) {
  const std::vector<Shot> shots = make_shots(transducer);
  return {{shots[0], ScanDetail::kFull, true},
          {shots[1], ScanDetail::kFull},
          {shots[2], ScanDetail::kFast},
          {shots[4], ScanDetail::kMiddle, true},
          {shots[3], ScanDetail::kFull, false, true},
          {shots[5], ScanDetail::kFull, true, false, 200}};
}

ScanPicture picture_of(PictureMaker& maker, const std::shared_ptr<const VesselFlow>& flow, const Ask& ask,
                       std::uint64_t seed) {
  ScanRequest request;
  request.X_PT = ask.shot.X_PT;
  request.acquisition = ask.shot.acquisition;
  if (ask.shot.has_needle) request.needle_shaft_P = shaft();
  request.display.persistence = 0.0;
  request.display.is_mirrored = ask.is_mirrored;
  request.doppler.persistence = 0.0;
  if (ask.has_doppler) request.flow = flow;
  request.columns = ask.columns;
  request.rows = 120;
  return maker.make(request, ask.detail, seed);
}

TEST(FrameMemory, ImageWithoutPersistenceIgnoresEarlierFrames) {
  const Transducer transducer = convex();
  const ScenePtr scene = make_rods_scene(transducer, 0.2);
  const auto flow = make_flow();
  const std::vector<Ask> asks = make_asks(transducer);
  std::vector<ScanPicture> fresh;
  for (const Ask& ask : asks) {
    PictureMaker maker(scene, transducer);
    fresh.push_back(picture_of(maker, flow, ask, 7));
  }
  PictureMaker used(scene, transducer);
  for (std::size_t before = 0; before < asks.size(); ++before) {
    for (std::size_t n = 0; n < asks.size(); ++n) {
      picture_of(used, flow, asks[before], 3);
      const ScanPicture again = picture_of(used, flow, asks[n], 7);
      EXPECT_TRUE(again.gray.pixels == fresh[n].gray.pixels) << "gray.pixels " << n << " behind " << before;
      EXPECT_TRUE(again.levels == fresh[n].levels) << "levels " << n << " behind " << before;
      EXPECT_TRUE(again.colour.pixels == fresh[n].colour.pixels) << "colour.pixels " << n << " behind " << before;
    }
  }
}

TEST(FrameMemory, ReenabledColourContainsNoOldFrame) {
  const Transducer transducer = convex();
  const ScenePtr scene = make_rods_scene(transducer, 0.2);
  const auto flow = make_flow();
  Ask first = make_asks(transducer)[0];
  const auto colour_of = [&](PictureMaker& maker, bool has_doppler, const Pose& X_PT) {
    ScanRequest request;
    request.X_PT = X_PT;
    request.acquisition = first.shot.acquisition;
    request.doppler.persistence = 0.8;
    if (has_doppler) request.flow = flow;
    return maker.make(request, ScanDetail::kFull, 7).colour.pixels;
  };
  PictureMaker fresh(scene, transducer), used(scene, transducer);
  const Pose X_PT_now = Pose(Eigen::AngleAxisd(0.4, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero());
  colour_of(used, true, Pose(Eigen::AngleAxisd(-0.4, Vec3::UnitX()).toRotationMatrix(), Vec3::Zero()));
  colour_of(used, false, X_PT_now);
  EXPECT_TRUE(colour_of(used, true, X_PT_now) == colour_of(fresh, true, X_PT_now));
}

}  // namespace
}  // namespace trocar::ultrasound
