// Each artefact in a scene that shows it alone: measured with it, and gone without it.

#include "ultrasound/scanner/scanner.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

Artefacts only(bool Artefacts::*artefact) {
  Artefacts artefacts = no_artefacts();
  artefacts.*artefact = true;
  return artefacts;
}

double peak_db(const EchoPatch& patch) {
  return 20.0 * std::log10(peak_of(patch).amplitude + 1e-12);
}

/// Highest echo within `reach_mm` of a depth, in the middle scanlines, dB.
double echo_db(const BasebandFrame& frame, double depth_mm, double reach_mm = 1.0) {
  const int middle = frame.geometry.lines / 2;
  return peak_db(envelope_patch(frame, {middle - 8, middle + 8, depth_mm - reach_mm, depth_mm + reach_mm}));
}

TEST(Reverberation, RepeatsABorderAtMultiplesOfItsDepth) {
  const Transducer transducer = linear();
  constexpr double kDepth_mm = 9.0;
  const TestLayer layers[] = {{kDepth_mm, TestTissue::kWater}, {1e9, TestTissue::kGas}};
  const ScenePtr scene = layers_scene(box_for(transducer, transducer.depth_mm, 0.5), layers);
  BMode on(scene, transducer, plain(transducer, only(&Artefacts::reverberation)));
  BMode off(scene, transducer, plain(transducer));
  const BasebandFrame& with = on.render({});
  const double first_db = echo_db(with, kDepth_mm);
  double step_db = 0.0;
  for (const int multiple : {2, 3, 4}) {
    const double level_db_here = echo_db(with, multiple * kDepth_mm, 0.4);
    EXPECT_GT(level_db_here, echo_db(with, (multiple - 0.5) * kDepth_mm) + 20.0) << "a line, not a haze";
    EXPECT_LT(echo_db(off.render({}), multiple * kDepth_mm), -30.0) << "off";
    // Each turn loses the same.
    const double drop_db = (first_db - level_db_here) / (multiple - 1);
    if (multiple > 2) {
      EXPECT_NEAR(drop_db, step_db, 1.0);
    }
    step_db = drop_db;
  }
  EXPECT_GT(step_db, 8.0);
  EXPECT_LT(step_db, 26.0);
}

TEST(Reverberation, RingsDownBehindRoughGas) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 120.0);
  const TestRod rods[] = {{0.0, 40.0, 8.0, TestTissue::kGas}};
  const ScenePtr scene = with_table(rods_scene(box, TestTissue::kWater, rods), [](AcousticTable& table) {
    table.tissues[index_of(TestTissue::kGas)].roughness = 0.6;
  });
  Artefacts reverberation = only(&Artefacts::reverberation);
  reverberation.attenuation = true;
  Artefacts without = reverberation;
  without.reverberation = false;
  Acquisition acquisition = plain(transducer, reverberation);
  acquisition.depth_mm = 120.0;
  BMode on(scene, transducer, acquisition);
  acquisition.artefacts = without;
  BMode off(scene, transducer, acquisition);
  const auto behind_db = [](BMode& engine) { return level_db(patch_at(engine.render({}), 0.0, 6.0, 52.0, 80.0)); };
  EXPECT_GT(behind_db(on), -35.0);
  EXPECT_LT(behind_db(off), behind_db(on) - 20.0);
  EXPECT_LT(level_db(patch_at(on.render({}), 0.0, 6.0, 95.0, 118.0)), behind_db(on) - 3.0) << "it fades";
}

TEST(Mirror, ShowsALesionAgainBehindGas) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 150.0);
  const TestPlane plane{70.0, 0.25};
  const TestRod rods[] = {{-6.0, 45.0, 6.0, TestTissue::kPlus12}};
  const Vec3 image = mirrored(Vec3(-6.0, 45.0, 0.0), plane);
  Artefacts mirror = only(&Artefacts::mirror);
  Acquisition acquisition = plain(transducer, mirror);
  acquisition.depth_mm = 150.0;
  BMode on(plane_scene(box, TestTissue::kLossless, plane, rods), transducer, acquisition);
  BMode without_lesion(plane_scene(box, TestTissue::kLossless, plane), transducer, acquisition);
  acquisition.artefacts = no_artefacts();
  BMode off(plane_scene(box, TestTissue::kLossless, plane, rods), transducer, acquisition);
  const auto level_at = [&](BMode& engine, const Vec3& p) {
    const Polar at = polar_of(engine.render({}), p.x(), p.y());
    const int line = static_cast<int>(std::lround(at.line));
    return level_db(envelope_patch(engine.render({}), {line - 4, line + 5, at.depth_mm - 3.5, at.depth_mm + 3.5}));
  };
  EXPECT_NEAR(level_at(on, image) - level_at(without_lesion, image), 12.0, 2.0) << "the lesion's own contrast";
  EXPECT_GT(level_at(without_lesion, image), -15.0) << "the tissue before the mirror shows again";
  EXPECT_LT(level_at(off, image), -40.0);
  // Nothing is shown twice before the mirror.
  EXPECT_NEAR(level_at(on, Vec3(-6.0, 45.0, 0.0)), level_at(off, Vec3(-6.0, 45.0, 0.0)), 0.1);
}

TEST(RangeDistortion, ShowsAPointTooDeepBehindASlowLayer) {
  const Transducer transducer = linear();
  const SceneBox box = box_for(transducer, transducer.depth_mm, 0.5);
  constexpr double kPoint_mm = 30.0, kThick_mm = 12.0;
  for (const auto& [tissue, speed] : {std::pair{TestTissue::kSlow, 1450.0}, std::pair{TestTissue::kFast, 1640.0}}) {
    const TestLayer layers[] = {{10.0, TestTissue::kWater}, {10.0 + kThick_mm, tissue}, {1e9, TestTissue::kWater}};
    const ScenePtr scene =
        with_table(layers_scene(box, layers, {{Vec3(0.0, kPoint_mm, 0.0), 60.0}}),
                   [&](AcousticTable& table) { table.tissues[index_of(tissue)].backscatter_db = -80.0; });
    const auto shown_at = [&](const Artefacts& artefacts) {
      BMode engine(scene, transducer, plain(transducer, artefacts));
      const EchoPatch patch = envelope_patch(engine.render({}), {100, 156, 26.0, 34.0});
      return patch.depth_mm + peak_of(patch).sample * patch.sample_mm;
    };
    const double expected_mm = kPoint_mm + kThick_mm * (1540.0 / speed - 1.0);
    EXPECT_NEAR(shown_at(only(&Artefacts::range_distortion)), expected_mm, 1.1 * transducer.depth_mm / 1024.0);
    EXPECT_NEAR(shown_at(no_artefacts()), kPoint_mm, 0.6 * transducer.depth_mm / 1024.0);
  }
}

/// Level against x behind a cylinder, against the same scatterers without it, dB; from -20 to 20 mm by 1 mm.
std::vector<double> profile_behind(TestTissue tissue, const Artefacts& artefacts) {
  const Transducer transducer = convex();
  const SceneBox box = box_for(transducer, 110.0, 0.5);
  const TestRod rods[] = {{0.0, 45.0, 10.0, tissue}};
  Acquisition acquisition = plain(transducer, artefacts);
  acquisition.depth_mm = 110.0;
  BMode with(rods_scene(box, TestTissue::kLossless, rods), transducer, acquisition);
  BMode without(homogeneous_scene(box, TestTissue::kLossless), transducer, acquisition);
  const BasebandFrame &a = with.render({}), &b = without.render({});
  std::vector<double> profile;
  for (int x = -25; x <= 25; ++x)
    profile.push_back(level_db(patch_at(a, x, 1.2, 70.0, 105.0)) - level_db(patch_at(b, x, 1.2, 70.0, 105.0)));
  return profile;
}

TEST(Refraction, DarkensBehindTheEdgesOfACylinder) {
  for (const TestTissue tissue : {TestTissue::kSlow, TestTissue::kFast}) {
    Artefacts both = only(&Artefacts::refraction);
    both.range_distortion = true;
    const std::vector<double> on = profile_behind(tissue, both);
    // Scanlines diverge: the edge at 10 mm throws its shadow to 10 * (61 + 87) / (61 + 45) = 14 mm.
    const auto lowest = [](const std::vector<double>& p, int from, int to) {
      return *std::min_element(p.begin() + 25 + from, p.begin() + 25 + to);
    };
    double middle = 0.0;
    for (int x = -4; x <= 4; ++x) middle += on[static_cast<std::size_t>(25 + x)] / 9.0;
    EXPECT_LT(lowest(on, -18, -9), middle - 2.5);
    EXPECT_LT(lowest(on, 10, 19), middle - 2.5);
    EXPECT_GT(lowest(on, 21, 25), -2.0) << "beside";
    for (const double value : profile_behind(tissue, no_artefacts())) ASSERT_NEAR(value, 0.0, 0.2) << "off";
  }
}

/// Scanlines of a phased array leave one point: what divides by their distance must not lose the picture.
TEST(Refraction, KeepsTheImageFiniteForEveryTransducer) {
  for (const char* name : {"C5-2", "L14-5", "P4-2", "liver-sweep", "4DC7-3"}) {
    const Transducer transducer = shipped(name);
    const TestRod rods[] = {{0.0, 12.0, 5.0, TestTissue::kSlow}};
    Acquisition bent = plain(transducer, only(&Artefacts::refraction));
    bent.depth_mm = 40.0;
    const ScenePtr scene = rods_scene(box_for(transducer, bent.depth_mm), TestTissue::kTissue, rods);
    Acquisition straight = bent;
    straight.artefacts.refraction = false;
    BMode bending(scene, transducer, bent), straight_on(scene, transducer, straight);
    const BasebandFrame& frame = bending.render({});
    for (const auto* samples : {&frame.re, &frame.im})
      EXPECT_TRUE(std::all_of(samples->begin(), samples->end(), [](float v) { return std::isfinite(v); })) << name;
    const double level = level_db(patch_at(frame, 0.0, 8.0, 25.0, 35.0));
    EXPECT_NEAR(level, level_db(patch_at(straight_on.render({}), 0.0, 8.0, 25.0, 35.0)), 6.0) << name;
  }
}

TEST(SideLobes, SurroundAStrongPoint) {
  const Transducer transducer = convex();
  const ScenePtr scene =
      points_scene(box_for(transducer, 120.0, 2.0), TestTissue::kWater, {{Vec3(0.0, 80.0, 0.0), 60.0}});
  Acquisition acquisition = plain(transducer, only(&Artefacts::side_lobes));
  acquisition.depth_mm = 120.0;
  BMode on(scene, transducer, acquisition);
  acquisition.artefacts = no_artefacts();
  BMode off(scene, transducer, acquisition);
  const double sigma_mm = on.render({}).beam.lateral_sigma_mm(80.0);
  const auto beside_db = [&](BMode& engine, double from_sigma, double to_sigma) {
    const BasebandFrame& frame = engine.render({});
    const double middle = frame.geometry.middle_line();
    const double per_line = frame.geometry.line_spacing_mm(80.0);
    return peak_db(envelope_patch(frame, {static_cast<int>(middle + from_sigma * sigma_mm / per_line),
                                          static_cast<int>(middle + to_sigma * sigma_mm / per_line) + 1, 78.0, 82.0})) -
           echo_db(frame, 80.0);
  };
  EXPECT_GT(beside_db(on, 6.0, 9.0), -50.0);
  EXPECT_LT(beside_db(on, 6.0, 9.0), -25.0);
  EXPECT_LT(beside_db(off, 6.0, 9.0), -70.0);
  EXPECT_NEAR(echo_db(on.render({}), 80.0), echo_db(off.render({}), 80.0), 0.1) << "the main lobe stays";
}

TEST(ContactLoss, BlackensScanlinesThatLookIntoAir) {
  const Transducer transducer = linear();
  const ScenePtr scene = gap_scene(box_for(transducer, transducer.depth_mm, 0.5), TestTissue::kLossless, 5.0, 3.0);
  BMode on(scene, transducer, plain(transducer, only(&Artefacts::contact_loss)));
  BMode off(scene, transducer, plain(transducer));
  const double touching_db = level_db(patch_at(on.render({}), -8.0, 6.0, 10.0, 35.0));
  const double lifted_db = level_db(patch_at(on.render({}), 12.0, 4.0, 10.0, 35.0));
  const double off_db = level_db(patch_at(off.render({}), 12.0, 4.0, 10.0, 35.0));
  EXPECT_NEAR(touching_db, 0.0, 1.0);
  EXPECT_LT(lifted_db, -20.0);
  EXPECT_GT(off_db, -3.0);
  const std::vector<float>& contact = on.render({}).contact;
  EXPECT_NEAR(contact.front(), 1.0F, 0.05F);
  EXPECT_LT(contact.back(), 0.2F);
}

/// Mean gray of a silent frame in a band of depth, with that back end.
double mean_gray_of_silence(const Artefacts& artefacts, double near_mm, double far_mm) {
  const Transducer transducer = convex();
  BMode engine(homogeneous_scene(box_for(transducer, transducer.depth_mm, 3.0), TestTissue::kWater), transducer,
               plain(transducer));
  Scanner scanner(640, 480);
  scanner.artefacts = artefacts;
  const BasebandFrame& frame = engine.render({});
  scanner.show(frame, 3);
  const auto samples = static_cast<std::size_t>(frame.geometry.samples);
  double sum = 0.0, count = 0.0;
  for (std::size_t at = 0; at < scanner.polar().size(); ++at) {
    const double depth_mm = (static_cast<double>(at % samples) + 0.5) * frame.geometry.sample_mm();
    if (depth_mm < near_mm || depth_mm > far_mm) continue;
    sum += scanner.polar()[at];
    count += 1.0;
  }
  return sum / count;
}

TEST(Noise, RisesWithDepthBecauseTheGainDoes) {
  const Artefacts noise = only(&Artefacts::noise);
  const double shallow = mean_gray_of_silence(noise, 20.0, 40.0);
  const double deep = mean_gray_of_silence(noise, 135.0, 155.0);
  EXPECT_GT(deep, shallow + 3.0);
  EXPECT_LT(mean_gray_of_silence(no_artefacts(), 135.0, 155.0), deep - 3.0) << "off";
}

TEST(Clutter, HazesTheNearFieldOnly) {
  const Artefacts clutter = only(&Artefacts::clutter);
  const double near = mean_gray_of_silence(clutter, 0.5, 5.0);
  EXPECT_GT(near, mean_gray_of_silence(clutter, 50.0, 70.0) + 5.0);
  EXPECT_GT(near, mean_gray_of_silence(no_artefacts(), 0.5, 5.0) + 5.0);
}

}  // namespace
}  // namespace trocar::ultrasound
