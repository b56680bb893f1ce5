// Speckle belongs to the tissue: it moves with it, and a frame depends on nothing but its input.

#include <thread>

#include "core/testing/allocation_guard.h"
#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

ScenePtr lossless_block(const Transducer& transducer) {
  SceneBox box = box_for(transducer, transducer.depth_mm, 2.0);
  box.half_thickness_mm = 30.0;
  return homogeneous_scene(box, TestTissue::kLossless);
}

/// Best correlation of a patch with another frame's over shifts of whole scanlines and samples, and that shift.
struct Match {
  double correlation = -1.0;
  int lines = 0, samples = 0;
};
Match best_match(const EchoPatch& still, const BasebandFrame& moved, const PatchBounds& bounds, int lines,
                 int samples) {
  Match best;
  for (int l = -lines; l <= lines; ++l)
    for (int s = -samples; s <= samples; ++s) {
      const double shift_mm = s * moved.geometry.sample_mm();
      const EchoPatch patch = envelope_patch(
          moved, {bounds.first_line + l, bounds.last_line + l, bounds.near_mm + shift_mm, bounds.far_mm + shift_mm});
      if (patch.values.size() != still.values.size()) continue;
      const double correlation = normalised_correlation(still.values, patch.values);
      if (correlation > best.correlation) best = {correlation, l, s};
    }
  return best;
}

TEST(Motion, LateralMotionShiftsSpeckleOppositely) {
  const Transducer transducer = linear();
  BMode engine(lossless_block(transducer), transducer, plain(transducer));
  const PatchBounds bounds{80, 180, 12.0, 28.0};
  const EchoPatch still = envelope_patch(engine.render({}), bounds);
  for (const int by : {1, 3, 10}) {
    const double x_mm = by * engine.geometry().line_step;
    const Match match =
        best_match(still, engine.render({Pose::translation(Vec3(x_mm, 0.0, 0.0)), {}, 0.0}), bounds, 12, 1);
    EXPECT_EQ(match.lines, -by);
    EXPECT_EQ(match.samples, 0);
    EXPECT_GT(match.correlation, 0.98);
  }
}

TEST(Motion, AxialMotionShiftsSpeckleUp) {
  const Transducer transducer = linear();
  BMode engine(lossless_block(transducer), transducer, plain(transducer, no_artefacts()));
  const PatchBounds bounds{80, 180, 14.0, 24.0};
  // Along the beam the pattern keeps its shape only as far as the beam does. The dented skin is no part of this: the
  // scene has air behind it, so the transducer starts a little away.
  const EchoPatch still = envelope_patch(engine.render({Pose::translation(Vec3(0.0, 0.0, 0.0)), {}, 0.0}), bounds);
  const double y_mm = 10 * engine.geometry().sample_mm();
  const Match match =
      best_match(still, engine.render({Pose::translation(Vec3(0.0, -y_mm, 0.0)), {}, 0.0}), bounds, 2, 14);
  EXPECT_EQ(match.lines, 0);
  EXPECT_NEAR(match.samples, 10, 1);
  EXPECT_GT(match.correlation, 0.9);
}

TEST(Motion, ElevationMotionDecorrelatesWithBeamThickness) {
  const Transducer transducer = convex();
  Acquisition acquisition = plain(transducer);
  BMode engine(lossless_block(transducer), transducer, acquisition);
  for (const double depth_mm : {40.0, 60.0, 100.0}) {
    const PatchBounds bounds{10, 246, depth_mm - 6.0, depth_mm + 6.0};
    const EchoPatch still = intensity_of(envelope_patch(engine.render({}), bounds));
    const double sigma_mm = engine.render({}).beam.elevation_sigma_mm(depth_mm);
    for (const double shift : {0.3, 0.6, 1.0, 1.5, 2.5}) {
      const EchoPatch moved =
          intensity_of(envelope_patch(engine.render({at_elevation(shift * sigma_mm), {}, 0.0}), bounds));
      // Amplitude profiles of sigma overlap with exp(-d^2 / 4 sigma^2); intensity correlates with its square.
      const double expected = std::exp(-0.5 * shift * shift);
      const double measured = normalised_correlation(still.values, moved.values);
      EXPECT_NEAR(measured, expected, 0.07) << depth_mm << " " << shift;
    }
  }
}

TEST(Motion, ReturningReproducesTheFirstFrame) {
  const Transducer transducer = convex();
  BMode engine(lossless_block(transducer), transducer, plain(transducer, Artefacts{}));
  const BasebandFrame first = engine.render({});
  engine.render({at_elevation(7.0), {}, 0.0});
  const BasebandFrame& again = engine.render({});
  EXPECT_EQ(first.re, again.re);
  EXPECT_EQ(first.im, again.im);
}

TEST(Frame, IsIndependentOfThreadScheduling) {
  const Transducer transducer = convex();
  const ScenePtr scene = lossless_block(transducer);
  BMode engine(scene, transducer, plain(transducer, Artefacts{}));
  const BasebandFrame alone = engine.render({at_elevation(3.0), {}, 0.0});
  // Two engines at once share the threads: other parts fall to other threads.
  BMode a(scene, transducer, plain(transducer, Artefacts{})), b(scene, transducer, plain(transducer, Artefacts{}));
  std::thread beside([&] {
    for (int n = 0; n < 5; ++n) b.render({at_elevation(3.0), {}, 0.0});
  });
  for (int n = 0; n < 5; ++n) EXPECT_EQ(a.render({at_elevation(3.0), {}, 0.0}).re, alone.re);
  beside.join();
  EXPECT_EQ(b.render({at_elevation(3.0), {}, 0.0}).im, alone.im);
}

TEST(Frame, NeverAllocates) {
  const Transducer transducer = convex();
  const TestPlane plane{90.0, 0.2};
  const TestRod rods[] = {{0.0, 45.0, 8.0, TestTissue::kBone}, {25.0, 50.0, 8.0, TestTissue::kSlow}};
  BMode engine(plane_scene(box_for(transducer, transducer.depth_mm, 2.0), TestTissue::kTissue, plane, rods), transducer,
               plain(transducer, Artefacts{}));
  for (int n = 0; n < 3; ++n) engine.render({at_elevation(n), {}, 0.0});
  const AllocationGuard guard;
  for (int n = 0; n < 5; ++n) engine.render({at_elevation(0.7 * n), {}, 0.0});
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace
}  // namespace trocar::ultrasound
