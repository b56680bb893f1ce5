// The patient moves below a transducer that is held still: every kind of echo comes from where the tissue is now.

#include "motion/testing/sliding_motion.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Strongest sample near a place (x, y of T), as a place; to a fraction of a sample by its neighbours' weight.
Vec2 brightest_T(const BasebandFrame& frame, const Vec2& near_T, double within_mm) {
  const Polar at = frame.geometry.to_polar(near_T);
  const double spacing_mm = frame.geometry.line_spacing_mm(at.depth_mm);
  const int lines = static_cast<int>(std::lround(within_mm / spacing_mm));
  PatchBounds bounds;
  bounds.first_line = std::max(static_cast<int>(std::lround(at.line)) - lines, 0);
  bounds.last_line = std::min(static_cast<int>(std::lround(at.line)) + lines + 1, frame.geometry.lines);
  bounds.near_mm = at.depth_mm - within_mm;
  bounds.far_mm = at.depth_mm + within_mm;
  const EchoPatch patch = envelope_patch(frame, bounds);
  double sum = 0.0, line = 0.0, sample = 0.0;
  const double most = peak_of(patch).amplitude;
  for (int l = 0; l < patch.lines; ++l)
    for (int s = 0; s < patch.samples; ++s) {
      const auto value = static_cast<double>(patch.at(l, s));
      if (value < 0.5 * most) continue;
      sum += value;
      line += value * l;
      sample += value * s;
    }
  const double first = std::ceil(bounds.near_mm / frame.geometry.sample_mm() - 0.5);
  return frame.geometry.to_cartesian(
      {bounds.first_line + line / sum, (first + sample / sum + 0.5) * frame.geometry.sample_mm()});
}

/// Turns the laboratory's motion into the image plane of the identity pose: tissue shears along the beam and bulges
/// across it.
std::shared_ptr<const motion::MotionModel> motion_in_plane(const Vec3& centre_A) {
  using namespace motion::testing;
  return made(whole_body({ramp({0.0, 9.0, 1.5}, centre_A - 30.0 * Vec3::UnitX(), Vec3::UnitX(), 40.0),
                          bump({6.0, 0.0, 0.0}, centre_A, 30.0)},
                         lattice_around(centre_A, 160.0, 5.0)));
}

TEST(MovingTissue, MatchesAnOppositeTransducerShift) {
  const Transducer transducer = convex();
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  box.half_thickness_mm = 30.0;
  const ScenePtr scene = homogeneous_scene(box, TestTissue::kLossless);
  BMode engine(scene, transducer, plain(transducer));
  const Vec3 shift(4.3, 0.0, 7.1);
  const auto model = motion::testing::uniform_model(shift);
  const PatchBounds bounds{40, 216, 30.0, 110.0};
  const EchoPatch expected = envelope_patch(engine.render({Pose::translation(-shift), {}, 0.0}), bounds);
  BModeInput input;
  input.motion = {model.get(), {.drivers = {1.0}}};
  const EchoPatch moved = envelope_patch(engine.render(input), bounds);
  EXPECT_GT(normalised_correlation(moved.values, expected.values), 0.995);
}

TEST(MovingTissue, ShowsAPointAtItsMovedPosition) {
  const Transducer transducer = linear();
  const Vec3 point_A(3.0, 22.0, 0.0);
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  BMode engine(points_scene(box, TestTissue::kWater, {{point_A, 10.0F}}), transducer, plain(transducer));
  const auto model = motion_in_plane({0.0, 25.0, 0.0});
  const motion::MotionClock clock{model.get(), motion::testing::sliding_drive()};
  for (int n = 0; n < 10; ++n) {
    BModeInput input;
    input.motion = clock.at(0.4 * n);
    const Vec3 now_P = input.motion.to_now(point_A);
    const Vec2 found_T = brightest_T(engine.render(input), now_P.head<2>(), 1.5);
    EXPECT_LT((found_T - now_P.head<2>()).norm(), 0.1) << n;
  }
}

TEST(MovingTissue, ShowsARodOfOtherTissueAtItsMovedPosition) {
  const Transducer transducer = linear();
  const TestRod rod{3.0, 22.0, 1.2, TestTissue::kPlus12};
  SceneBox box = box_for(transducer, transducer.depth_mm, 0.3);
  const ScenePtr scene = rods_scene(box, TestTissue::kWater, std::span(&rod, 1));
  BMode engine(scene, transducer, plain(transducer));
  const auto model = motion_in_plane({0.0, 25.0, 0.0});
  const motion::MotionClock clock{model.get(), motion::testing::sliding_drive()};
  for (int n = 0; n < 10; ++n) {
    BModeInput input;
    input.motion = clock.at(0.4 * n);
    // Speckle fills the rod unevenly: the mean of frames with other scatterers.
    Vec2 mean_T = Vec2::Zero();
    constexpr int kFrames = 12;
    for (int frame = 0; frame < kFrames; ++frame) {
      input.X_PT = at_elevation(frame - 0.5 * kFrames);
      const Vec3 now_P = input.motion.to_now({rod.x_mm, rod.y_mm, 0.0});
      mean_T += brightest_T(engine.render(input), now_P.head<2>(), 2.5) / kFrames;
    }
    EXPECT_LT((mean_T - input.motion.to_now({rod.x_mm, rod.y_mm, 0.0}).head<2>()).norm(), 0.3) << n;
  }
}

TEST(MovingTissue, CarriesItsSpeckleAlong) {
  const Transducer transducer = linear();
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  box.half_thickness_mm = 30.0;
  BMode engine(homogeneous_scene(box, TestTissue::kLossless), transducer, plain(transducer));
  // A shear that does not turn the pattern much: the patch moves by many of its grains.
  using namespace motion::testing;
  const auto model = made(whole_body({ramp({2.5, 0.0, 0.0}, Vec3::Zero(), Vec3::UnitY(), 25.0)}));
  BModeInput input;
  const EchoPatch still = envelope_patch(engine.render(input), {100, 160, 19.0, 21.0});
  input.motion = {model.get(), {.drivers = {1.0}}};
  const BasebandFrame& moved = engine.render(input);
  const double shift_mm = input.motion.to_now({0.0, 20.0, 0.0}).x();
  const int expected = static_cast<int>(std::lround(shift_mm / moved.geometry.line_step));
  ASSERT_GT(expected, 5);
  int best_shift = 0;
  double best = -1.0;
  for (int shift = -20; shift <= 20; ++shift) {
    const double correlation =
        normalised_correlation(still.values, envelope_patch(moved, {100 + shift, 160 + shift, 19.0, 21.0}).values);
    if (correlation > best) best_shift = shift, best = correlation;
  }
  EXPECT_NEAR(best_shift, expected, 1);
  EXPECT_GT(best, 0.9);
}

TEST(MovingTissue, SlidesAlongTheBorderOfRegions) {
  // Left of x = 0 everything rests, on the right it moves down by 5 mm: a layer has a step there.
  const Transducer transducer = linear();
  const std::vector<TestLayer> layers{{20.0, TestTissue::kWater}, {60.0, TestTissue::kPlus12}};
  SceneBox box = box_for(transducer, transducer.depth_mm, 0.3);
  BMode engine(layers_scene(box, layers), transducer, plain(transducer));
  using namespace motion::testing;
  const auto model = made(sliding_parts(flat_border(Vec3::UnitX(), 0.0), {uniform({0.0, 5.0, 0.0})}));
  BModeInput input;
  input.motion = {model.get(), {.drivers = {1.0}}};
  const BasebandFrame& frame = engine.render(input);
  const auto level = [&](double x_mm, double y_mm) {
    return level_db(patch_at(frame, x_mm, 2.0, y_mm - 1.0, y_mm + 1.0));
  };
  for (const double x_mm : {-12.0, -4.0}) EXPECT_GT(level(x_mm, 22.0), 0.0) << x_mm;
  for (const double x_mm : {4.0, 12.0}) {
    EXPECT_LT(level(x_mm, 22.0), -20.0) << x_mm;
    EXPECT_GT(level(x_mm, 27.0), 0.0) << x_mm;
  }
}

}  // namespace
}  // namespace trocar::ultrasound
