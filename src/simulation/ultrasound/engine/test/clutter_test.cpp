// Clutter fills what has no echoes of its own.

#include "ultrasound/engine/detail/clutter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/test/physics_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

/// Level of a cyst of 8 mm radius at 70 mm relative to the tissue beside it, dB.
double cluttered_cyst_db(bool has_clutter) {
  const Transducer transducer = convex();
  const TestRod cyst{0.0, 70.0, 8.0, TestTissue::kWater};
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = has_clutter;
  BMode engine(rods_scene(box_for(transducer, 120.0, 0.5), TestTissue::kLossless, {&cyst, 1}), transducer,
               plain(transducer, artefacts));
  const BasebandFrame& frame = engine.render({});
  return level_db(patch_at(frame, 0.0, 3.0, 67.0, 73.0)) - level_db(patch_at(frame, 25.0, 5.0, 62.0, 78.0));
}

TEST(TissueClutter, FillsAnAnechoicCyst) {
  EXPECT_LT(cluttered_cyst_db(false), -45.0);
  // The cyst itself is a part of what is around it.
  EXPECT_NEAR(cluttered_cyst_db(true), static_cast<double>(detail::kClutter_db), 3.0);
}

TEST(TissueClutter, IsStrongestBehindTheNearWallOfShallowFluid) {
  // A full bladder: fluid from 25 mm on behind the abdominal wall.
  const Transducer transducer = convex();
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = true;
  const TestLayer layers[] = {{25.0, TestTissue::kLossless}, {120.0, TestTissue::kWater}};
  BMode engine(layers_scene(box_for(transducer, 120.0, 0.5), layers), transducer, plain(transducer, artefacts));
  const BasebandFrame& frame = engine.render({});
  const double tissue_db = level_db(patch_at(frame, 0.0, 15.0, 15.0, 22.0));
  const double near_db = level_db(patch_at(frame, 0.0, 15.0, 28.0, 32.0)) - tissue_db;
  const double middle_db = level_db(patch_at(frame, 0.0, 15.0, 45.0, 50.0)) - tissue_db;
  EXPECT_GT(near_db, -26.0);
  EXPECT_LT(near_db, -16.0);
  EXPECT_LT(middle_db, near_db - 6.0);
}

TEST(TissueClutter, IsAbsentWithoutEchoes) {
  const Transducer transducer = convex();
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = true;
  BMode engine(homogeneous_scene(box_for(transducer, 120.0, 1.0), TestTissue::kWater), transducer,
               plain(transducer, artefacts));
  EXPECT_LT(level_db(patch_at(engine.render({}), 0.0, 20.0, 70.0, 100.0)), -60.0);
}

TEST(TissueClutter, IgnoresAStrongReflector) {
  // Bone across the image: its echo is 50 dB above the tissue, clutter stays below the tissue beside it.
  const Transducer transducer = convex();
  const TestSlab bone{10.0, 60.0, 70.0, TestTissue::kBone};
  Artefacts artefacts = no_artefacts();
  artefacts.clutter = true;
  const ScenePtr scene = slab_scene(box_for(transducer, 120.0, 0.5), TestTissue::kLossless, bone);
  BMode with(scene, transducer, plain(transducer, artefacts)), without(scene, transducer, plain(transducer));
  const double change_db = level_db(patch_at(with.render({}), 30.0, 5.0, 58.0, 63.0)) -
                           level_db(patch_at(without.render({}), 30.0, 5.0, 58.0, 63.0));
  EXPECT_NEAR(change_db, 0.0, 0.3);
}

}  // namespace
}  // namespace trocar::ultrasound
