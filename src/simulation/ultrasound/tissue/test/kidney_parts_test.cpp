// Cortex, pyramids and sinus of a kidney that labels and CT show as one tissue.

#include <gtest/gtest.h>

#include <array>

#include "ultrasound/tissue/detail/strands.h"

namespace trocar::ultrasound::detail {
namespace {

enum Tissue : std::uint8_t { kAir, kFat, kSoft, kKidney, kPyramid, kSinus, kLiver };

AcousticTable table() {
  AcousticTable table;
  for (const char* name : {"air", "adipose", "soft_tissue", "kidney", "kidney_pyramid", "renal_sinus", "liver"}) {
    AcousticTissue tissue;
    tissue.name = name;
    table.tissues.push_back(tissue);
  }
  return table;
}

/// An ellipsoid of 52 x 44 x 108 mm in fat, with or without a hilum towards +x.
AcousticScene kidney(bool has_hilum, std::uint8_t around = kFat) {
  AcousticScene scene;
  scene.table = table();
  scene.geometry.size = {90, 80, 140};
  scene.geometry.spacing_mm = Vec3::Ones();
  scene.tissue.assign(scene.geometry.voxel_count(), around);
  for (std::size_t at = 0; at < scene.tissue.size(); ++at) {
    const Vec3 p = volume::to_vec3(scene.geometry.index_of(at)) - Vec3(45.0, 40.0, 70.0);
    const bool is_hilum =
        has_hilum && (p - Vec3(22.0, 0.0, 0.0)).cwiseQuotient(Vec3(18.0, 7.0, 24.0)).squaredNorm() < 1.0;
    if (p.cwiseQuotient(Vec3(26.0, 22.0, 54.0)).squaredNorm() < 1.0 && !is_hilum) scene.tissue[at] = kKidney;
  }
  return scene;
}

std::array<double, 7> volumes_ml(const AcousticScene& scene) {
  std::array<double, 7> ml{};
  for (const std::uint8_t tissue : scene.tissue) ml[tissue] += 1e-3;
  return ml;
}

TEST(KidneyParts, DivideItIntoCortexPyramidsAndSinus) {
  for (const bool has_hilum : {false, true}) {
    AcousticScene scene = kidney(has_hilum);
    const double whole_ml = volumes_ml(scene)[kKidney];
    add_kidney_parts(scene);
    const auto ml = volumes_ml(scene);
    EXPECT_GT(ml[kKidney], 0.5 * whole_ml) << "cortex and columns";
    EXPECT_GT(ml[kPyramid], 0.06 * whole_ml);
    EXPECT_LT(ml[kPyramid], 0.3 * whole_ml);
    EXPECT_GT(ml[kSinus], 0.02 * whole_ml);
    EXPECT_LT(ml[kSinus], 0.2 * whole_ml);
  }
}

TEST(KidneyParts, CortexIsOutside) {
  AcousticScene scene = kidney(false);
  const AcousticScene before = scene;
  add_kidney_parts(scene);
  for (std::size_t at = 0; at < scene.tissue.size(); ++at) {
    const Vec3 p = volume::to_vec3(scene.geometry.index_of(at)) - Vec3(45.0, 40.0, 70.0);
    // 5 mm below the surface everywhere: the ellipsoid whose axes are shorter by that.
    const bool is_outer = p.cwiseQuotient(Vec3(21.0, 17.0, 49.0)).squaredNorm() > 1.0;
    if (is_outer || before.tissue[at] != kKidney) {
      ASSERT_EQ(scene.tissue[at], before.tissue[at]);
    }
  }
}

TEST(KidneyParts, TurnOnlyFatInTheHilumIntoSinus) {
  AcousticScene fat = kidney(true), liver = kidney(true, kLiver);
  add_kidney_parts(fat);
  add_kidney_parts(liver);
  const std::size_t in_hilum = fat.geometry.offset({45 + 14, 40, 70}), beside = fat.geometry.offset({45 + 38, 40, 70});
  EXPECT_EQ(fat.tissue[in_hilum], kSinus);
  EXPECT_EQ(fat.tissue[beside], kFat);
  EXPECT_EQ(liver.tissue[in_hilum], kLiver);
}

TEST(KidneyParts, LeaveSmallPiecesAndOtherTablesUnchanged) {
  AcousticScene small = kidney(false);
  for (std::size_t at = 0; at < small.tissue.size(); ++at)
    if (small.geometry.index_of(at)[2] > 30) small.tissue[at] = kFat;
  AcousticScene other = kidney(false);
  other.table.tissues[kSinus].name = "another";
  for (AcousticScene* scene : {&small, &other}) {
    const auto before = scene->tissue;
    add_kidney_parts(*scene);
    EXPECT_EQ(scene->tissue, before);
  }
  AcousticScene none = kidney(false);
  std::fill(none.tissue.begin(), none.tissue.end(), std::uint8_t{kLiver});
  add_kidney_parts(none);
  EXPECT_EQ(volumes_ml(none)[kSinus], 0.0);
}

}  // namespace
}  // namespace trocar::ultrasound::detail
