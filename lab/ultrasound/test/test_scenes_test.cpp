#include "lab/ultrasound/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ultrasound/probe/scan_geometry.h"

namespace trocar::ultrasound {
namespace {

Transducer plain_convex() {
  Transducer transducer;
  transducer.name = "convex";
  return transducer;
}

std::uint8_t tissue_number_at(const AcousticScene& scene, const Vec3& p_P) {
  const Vec3 index = scene.geometry.to_index(p_P);
  const volume::Index3 ijk{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())};
  return scene.geometry.contains(ijk) ? scene.tissue[scene.geometry.offset(ijk)] & ~kMixedCell : 255;
}

TEST(TestScenes, TableFollowsTheEnumeration) {
  const AcousticTable table = test_table();
  ASSERT_EQ(table.tissues.size(), static_cast<std::size_t>(index_of(TestTissue::kDenser)) + 1);
  EXPECT_EQ(table.tissues[index_of(TestTissue::kBone)].name, "bone");
  EXPECT_EQ(table.tissues[index_of(TestTissue::kFast)].speed_m_per_s, 1640.0);
  EXPECT_EQ(table.tissues[index_of(TestTissue::kPlus12)].backscatter_db, 12.0);
}

TEST(TestScenes, OnlyDensityBoneAndGasReflect) {
  const AcousticTable table = test_table();
  const double medium = table.tissues[index_of(TestTissue::kTissue)].impedance_mrayl();
  const auto reflected = [&](TestTissue tissue) {
    return reflection(medium, table.tissues[index_of(tissue)].impedance_mrayl());
  };
  for (const TestTissue tissue : {TestTissue::kWater, TestTissue::kLossless, TestTissue::kLossy, TestTissue::kMinus12,
                                  TestTissue::kPlus12, TestTissue::kFast, TestTissue::kSlow})
    EXPECT_NEAR(reflected(tissue), 0.0, 1e-12);
  EXPECT_NEAR(reflected(TestTissue::kDense), 1.0 / 11.0, 1e-12);
  EXPECT_NEAR(reflected(TestTissue::kDenser), 1.0 / 3.0, 1e-12);
  EXPECT_LT(reflected(TestTissue::kGas), -0.99);
}

TEST(TestScenes, BoxContainsTheWholeScanBehindTheSkin) {
  const Transducer transducer = plain_convex();
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 120.0, 2.0), TestTissue::kTissue);
  const ScanGeometry scan = make_scan_geometry(transducer, 120.0, 65, 64);
  for (int line = 0; line < scan.lines; line += 8)
    for (const double depth_mm : {3.0, 60.0, 119.0}) {
      const Vec2 p = scan.to_cartesian({static_cast<double>(line), depth_mm});
      EXPECT_EQ(tissue_number_at(*scene, {p.x(), p.y(), 0.0}), index_of(TestTissue::kTissue))
          << line << " " << depth_mm;
    }
  const Vec2 before = scan.to_cartesian({0.0, -4.0});
  EXPECT_EQ(tissue_number_at(*scene, {before.x(), before.y(), 0.0}), 0);
}

TEST(TestScenes, SkinFollowsAConvexFace) {
  const Transducer transducer = plain_convex();
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 60.0, 2.0), TestTissue::kTissue);
  const volume::FloatGrid& skin = scene->skin_distance_mm;
  for (std::size_t at = 0; at < skin.voxels.size(); at += 997) {
    const Vec3 p = skin.geometry.to_mm(Vec3(static_cast<double>(skin.geometry.index_of(at)[0]),
                                            static_cast<double>(skin.geometry.index_of(at)[1]), 0.0));
    const double from_apex_mm = std::hypot(p.x(), p.y() + transducer.radius_mm);
    ASSERT_NEAR(skin.voxels[at], transducer.radius_mm - from_apex_mm, 1e-3);
  }
}

TEST(TestScenes, LayersEndAtTheirDepths) {
  const TestLayer layers[] = {{20.0, TestTissue::kTissue}, {26.0, TestTissue::kDense}, {1e9, TestTissue::kGas}};
  const ScenePtr scene = layers_scene(SceneBox{}, layers);
  EXPECT_EQ(tissue_number_at(*scene, {3, 19.5, 0}), index_of(TestTissue::kTissue));
  EXPECT_EQ(tissue_number_at(*scene, {3, 20.5, 0}), index_of(TestTissue::kDense));
  EXPECT_EQ(tissue_number_at(*scene, {3, 25.5, 0}), index_of(TestTissue::kDense));
  EXPECT_EQ(tissue_number_at(*scene, {3, 26.5, 0}), index_of(TestTissue::kGas));
}

TEST(TestScenes, RodsLieAtTheirPositions) {
  const TestRod rods[] = {{-8.0, 30.0, 4.0, TestTissue::kWater}, {8.0, 30.0, 4.0, TestTissue::kBone, 2.0}};
  const ScenePtr scene = rods_scene(SceneBox{}, TestTissue::kTissue, rods, {{Vec3(0, 50, 0), 40.0}});
  EXPECT_EQ(tissue_number_at(*scene, {-8.5, 33.5, 9.5}), index_of(TestTissue::kWater));
  EXPECT_EQ(tissue_number_at(*scene, {8.5, 33.5, 0.5}), index_of(TestTissue::kBone));
  EXPECT_EQ(tissue_number_at(*scene, {8.5, 33.5, 9.5}), index_of(TestTissue::kTissue));
  ASSERT_EQ(scene->points.size(), 1u);
}

TEST(TestScenes, PlaneMirrorsObjectsBehindIt) {
  const TestPlane plane{40.0, 0.3};
  const TestRod rods[] = {{5.0, 20.0, 3.0, TestTissue::kPlus12}};
  const ScenePtr scene = plane_scene(SceneBox{}, TestTissue::kTissue, plane, rods);
  EXPECT_EQ(tissue_number_at(*scene, {5, 20, 0}), index_of(TestTissue::kPlus12));
  const Vec3 image = mirrored(Vec3(5, 20, 0), plane);
  EXPECT_EQ(tissue_number_at(*scene, image), index_of(TestTissue::kGas));
  EXPECT_LT((mirrored(image, plane) - Vec3(5, 20, 0)).norm(), 1e-12);
  // The face looks from the origin: what lies before the plane is nearer to it than its mirror image.
  EXPECT_GT(image.norm(), 40.0);
}

TEST(TestScenes, AGapIsAirBetweenFaceAndSkin) {
  const ScenePtr scene = gap_scene(SceneBox{}, TestTissue::kTissue, 5.0, 6.0);
  EXPECT_EQ(tissue_number_at(*scene, {0.5, 0.5, 0}), index_of(TestTissue::kTissue));
  EXPECT_EQ(tissue_number_at(*scene, {6.5, 3.5, 0}), 0);
  EXPECT_EQ(tissue_number_at(*scene, {6.5, 7.5, 0}), index_of(TestTissue::kTissue));
}

TEST(TestScenes, CellsAreMixedOnlyAtBorders) {
  const TestSlab slab{10.0, 20.0, 28.0, TestTissue::kBone};
  const ScenePtr scene = slab_scene(SceneBox{}, TestTissue::kTissue, slab);
  std::size_t mixed = 0;
  for (std::size_t at = 0; at < scene->tissue.size(); ++at) {
    if ((scene->tissue[at] & kMixedCell) == 0) continue;
    ++mixed;
    const volume::Index3 ijk = scene->geometry.index_of(at);
    const Vec3 p = scene->geometry.centre_mm(ijk);
    const bool is_near_skin = std::abs(p.y()) < 1.1;
    const bool is_near_slab = std::abs(p.x()) < 11.1 && p.y() > 18.9 && p.y() < 29.1;
    const bool is_at_rim = ijk[0] == scene->geometry.size[0] - 1 || ijk[1] == scene->geometry.size[1] - 1 ||
                           ijk[2] == scene->geometry.size[2] - 1;
    ASSERT_TRUE(is_near_skin || is_near_slab || is_at_rim) << p.transpose();
  }
  EXPECT_GT(mixed, 1000u);
}

}  // namespace
}  // namespace trocar::ultrasound
