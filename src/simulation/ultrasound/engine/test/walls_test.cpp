// Walls: sheets too thin for CT and labels, on the borders of two tissues.

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

constexpr double kPlane_mm = 25.0, kThickness_mm = 4.0, kLevel_db = 12.0;

SceneBox thick_box(const Transducer& transducer) {
  SceneBox box = box_for(transducer, 40.0, 0.5);
  box.half_thickness_mm = 24.0;
  return box;
}

/// Speckle in front of an echo-free fluid, whose border is tilted; with or without a wall.
ScenePtr make_walled_scene(const Transducer& transducer, double tilt_rad, bool has_wall) {
  const ScenePtr bare =
      plane_scene(thick_box(transducer), TestTissue::kLossless, TestPlane{kPlane_mm, tilt_rad, TestTissue::kWater});
  return with_table(bare, [&](AcousticTable& table) {
    if (has_wall)
      table.walls.push_back(
          {"wall", {index_of(TestTissue::kWater)}, {index_of(TestTissue::kLossless)}, kThickness_mm, kLevel_db});
  });
}

/// Mean level around x = 0 between two distances in front of the border, over frames with other scatterers.
double level_in_front_db(BMode& engine, double tilt_rad, double from_mm, double to_mm) {
  double power = 0.0;
  constexpr int kFrames = 8;
  for (int n = 0; n < kFrames; ++n) {
    const BasebandFrame& frame = engine.render({at_elevation(5.0 * (n - 0.5 * (kFrames - 1))), {}, 0.0});
    const double along = 1.0 / std::cos(tilt_rad);
    power +=
        std::pow(root_mean_square(patch_at(frame, 0.0, 0.6, kPlane_mm - to_mm * along, kPlane_mm - from_mm * along)),
                 2) /
        kFrames;
  }
  return 10.0 * std::log10(power);
}

TEST(Walls, ScatterInProportionToTheCosine) {
  const Transducer transducer = linear();
  for (const double tilt_rad : {0.5, 0.9}) {
    BMode engine(make_walled_scene(transducer, tilt_rad, true), transducer, plain(transducer));
    const double expected_db = kLevel_db + 20.0 * std::log10(std::cos(tilt_rad));
    EXPECT_NEAR(level_in_front_db(engine, tilt_rad, 0.8, 2.0), expected_db, 1.5) << tilt_rad;
    EXPECT_NEAR(level_in_front_db(engine, tilt_rad, kThickness_mm + 1.5, kThickness_mm + 5.0), 0.0, 1.5) << tilt_rad;
  }
}

TEST(Walls, EvenPartIsABandWithoutSpeckle) {
  const Transducer transducer = linear();
  constexpr double kTilt_rad = 0.5, kEven_db = 18.0;
  const ScenePtr scene = with_table(
      plane_scene(thick_box(transducer), TestTissue::kWater, TestPlane{kPlane_mm, kTilt_rad, TestTissue::kLossless}),
      [&](AcousticTable& table) {
        table.tissues[index_of(TestTissue::kLossless)].backscatter_db = -60.0;
        table.walls.push_back({"wall",
                               {index_of(TestTissue::kLossless)},
                               {index_of(TestTissue::kWater)},
                               kThickness_mm,
                               -40.0,
                               kEven_db});
      });
  BMode engine(scene, transducer, plain(transducer));
  const BasebandFrame& frame = engine.render({});
  // Its middle, along the border.
  std::vector<double> levels_db;
  for (double x_mm = -8.0; x_mm <= 8.0; x_mm += 0.5) {
    const double border_mm = kPlane_mm - x_mm * std::tan(kTilt_rad);
    const double along_mm = kThickness_mm / std::cos(kTilt_rad);
    levels_db.push_back(level_db(patch_at(frame, x_mm, 0.2, border_mm - 0.6 * along_mm, border_mm - 0.4 * along_mm)));
  }
  double mean_db = 0.0, spread_db = 0.0;
  for (const double level : levels_db) mean_db += level / static_cast<double>(levels_db.size());
  for (const double level : levels_db)
    spread_db += std::pow(level - mean_db, 2) / static_cast<double>(levels_db.size());
  // The level varies slowly along the surface by up to 3.5 dB.
  EXPECT_NEAR(mean_db, kEven_db + 10.0 * std::log10(std::cos(kTilt_rad)), 4.0);
  EXPECT_LT(std::sqrt(spread_db), 2.5) << "speckle has 5.6";
}

TEST(Walls, LieOutsideTheEnclosedTissue) {
  const Transducer transducer = linear();
  constexpr double kTilt_rad = 0.5;
  BMode walled(make_walled_scene(transducer, kTilt_rad, true), transducer, plain(transducer));
  BMode bare(make_walled_scene(transducer, kTilt_rad, false), transducer, plain(transducer));
  EXPECT_LT(level_in_front_db(walled, kTilt_rad, -4.0, -2.0), -30.0) << "the fluid stays dark";
  const BasebandFrame &a = walled.render({}), &b = bare.render({});
  const auto far_before = patch_at(a, 0.0, 3.0, 5.0, 15.0), same = patch_at(b, 0.0, 3.0, 5.0, 15.0);
  EXPECT_EQ(far_before.values, same.values);
}

TEST(Walls, AreEquallyThickOnBothSidesOfABorder) {
  const Transducer transducer = linear();
  const TestRod rod{0.0, 20.0, 6.0, TestTissue::kWater};
  const ScenePtr scene =
      with_table(rods_scene(thick_box(transducer), TestTissue::kLossless, {&rod, 1}), [](AcousticTable& table) {
        table.walls.push_back(
            {"wall", {index_of(TestTissue::kWater)}, {index_of(TestTissue::kLossless)}, 3.0, kLevel_db});
      });
  BMode engine(scene, transducer, plain(transducer));
  double front = 0.0, back = 0.0, beyond = 0.0;
  for (int n = 0; n < 8; ++n) {
    const BasebandFrame& frame = engine.render({at_elevation(5.0 * (n - 3.5)), {}, 0.0});
    front += std::pow(root_mean_square(patch_at(frame, 0.0, 1.0, 12.0, 13.2)), 2) / 8.0;
    back += std::pow(root_mean_square(patch_at(frame, 0.0, 1.0, 26.8, 28.0)), 2) / 8.0;
    beyond += std::pow(root_mean_square(patch_at(frame, 0.0, 1.0, 30.5, 34.0)), 2) / 8.0;
  }
  EXPECT_NEAR(10.0 * std::log10(front), kLevel_db, 2.0);
  EXPECT_NEAR(10.0 * std::log10(back), kLevel_db, 2.0);
  EXPECT_NEAR(10.0 * std::log10(beyond), 0.0, 1.5);
}

}  // namespace
}  // namespace trocar::ultrasound
