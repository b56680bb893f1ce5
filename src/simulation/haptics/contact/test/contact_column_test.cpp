#include <gtest/gtest.h>

#include <numbers>

#include "haptics/contact/contact_balance.h"
#include "haptics/contact/test/flat_skin.h"

namespace trocar::testing {
namespace {

constexpr double kPi = std::numbers::pi;

double plane_strain_n_per_mm2(double kpa) {
  return kpa * 1e-3 / (1.0 - haptics::kPoisson * haptics::kPoisson);
}

TEST(TissueColumn, ThickUniformTissueMatchesBoussinesqsPunch) {
  // Under a disc that is small against the column, area * stiffness is 2 a E*; what lies below 40 mm lacks.
  haptics::HapticScene scene = *make_face_scene(haptics::Tool::kFinger, all_fat);
  const double a = scene.face.spread_mm;
  const double expected = 2.0 * a * plane_strain_n_per_mm2(5.0);
  const haptics::TissueColumn column = haptics::tissue_column(scene, Vec3::Zero(), Vec3::UnitZ());
  const double punch = kPi * a * a * column.stiffness_n_per_mm3;
  const double below = haptics::settlement_mm(1e6, a) - haptics::settlement_mm(haptics::kColumn_mm, a);
  EXPECT_NEAR(punch * (1.0 - below / haptics::settlement_mm(1e6, a)), expected, 1e-5 * expected);
  EXPECT_NEAR(haptics::settlement_mm(1e6, a), 0.5 * kPi * a, 1e-3);
}

TEST(TissueColumn, LayersAreSpringsInSeries) {
  const auto layers = [](const Vec3& p) { return p.z() < 15.5 ? kFat : kMuscle; };  // border of cells at 16 mm
  const auto scene = make_face_scene(haptics::Tool::kTransducer, layers);
  const double a = scene->face.spread_mm;
  const double yields =
      haptics::settlement_mm(16.0, a) / plane_strain_n_per_mm2(5.0) +
      (haptics::settlement_mm(40.0, a) - haptics::settlement_mm(16.0, a)) / plane_strain_n_per_mm2(20.0);
  EXPECT_NEAR(haptics::tissue_column(*scene, Vec3::Zero(), Vec3::UnitZ()).stiffness_n_per_mm3, 1.0 / yields, 1e-9);
}

TEST(TissueColumn, EndsAtBone) {
  for (const double depth : {4.0, 9.0, 10.0, 17.0}) {
    const auto scene =
        make_face_scene(haptics::Tool::kFinger, [&](const Vec3& p) { return p.z() < depth ? kFat : kBone; });
    const haptics::TissueColumn column = haptics::tissue_column(*scene, Vec3::Zero(), Vec3::UnitZ());
    const double border = depth - 0.5;                     // of the first voxel of bone
    EXPECT_NEAR(column.length_mm, border, 0.07) << depth;  // a 2 mm step halved four times
    const double expected =
        plane_strain_n_per_mm2(5.0) / haptics::settlement_mm(column.length_mm, scene->face.spread_mm);
    EXPECT_NEAR(column.stiffness_n_per_mm3, expected, 1e-9);
  }
}

TEST(TissueColumn, ReadsUnlabelledTissueFromHu) {
  anatomy::TissueTable tissues = soft_tissues();
  tissues.transfer.knot_count = 2;
  tissues.transfer.hu[0] = -100.0;
  tissues.transfer.hu[1] = 100.0;
  tissues.transfer.laws[0].young_kpa = 5.0;
  tissues.transfer.laws[1].young_kpa = 45.0;
  const auto none = [](const Vec3&) -> std::uint8_t { return 0; };
  const auto by_hu =
      make_face_scene(haptics::Tool::kFinger, none, {}, tissues);  // HU 0: 25 kPa, under 2 mm of skin of 5 kPa
  const double a = by_hu->face.spread_mm;
  const double yields =
      haptics::settlement_mm(2.0, a) / plane_strain_n_per_mm2(5.0) +
      (haptics::settlement_mm(40.0, a) - haptics::settlement_mm(2.0, a)) / plane_strain_n_per_mm2(25.0);
  EXPECT_NEAR(haptics::tissue_column(*by_hu, Vec3::Zero(), Vec3::UnitZ()).stiffness_n_per_mm3, 1.0 / yields, 1e-9);
}

TEST(TissueColumn, LimitsTheCompressionOfEachLayer) {
  // Layers of E e/(1 - e) in series: their indentation under a pressure, summed over the cells.
  const auto scene =
      make_face_scene(haptics::Tool::kTransducer, [](const Vec3& p) { return p.z() < 15.5 ? kFat : kMuscle; });
  const haptics::TissueColumn column = haptics::tissue_column(*scene, Vec3::Zero(), Vec3::UnitZ());
  for (const double pressure : {0.0005, 0.001, 0.002}) {
    double indentation = 0.0;
    for (std::size_t cell = 0; cell < haptics::kColumnCells; ++cell) {
      const double thickness = haptics::kCellBorder_mm[cell + 1] - haptics::kCellBorder_mm[cell];
      const double share = (scene->face.settlement_mm[cell + 1] - scene->face.settlement_mm[cell]) / thickness;
      const double strain = pressure * share / plane_strain_n_per_mm2(cell < 8 ? 5.0 : 20.0);
      indentation += thickness * strain / (1.0 + strain);
    }
    EXPECT_NEAR(haptics::respond(column, indentation).pressure, pressure, 0.03 * pressure);  // good to the second order
  }
}

TEST(ColumnResponse, IsConvexAndContinuousWithExactTangent) {
  const haptics::TissueColumn column{0.002, 10.0, 0.05};
  EXPECT_EQ(haptics::respond(column, -1.0).pressure, 0.0);
  EXPECT_NEAR(haptics::respond(column, 5.0).pressure, 0.002 * 5.0 * 1.25 / 0.5, 1e-12);
  double before = 0.002 - 1e-9;
  for (double p = 0.05; p < 14.0; p += 0.1) {
    const double slope =
        (haptics::respond(column, p + 1e-6).pressure - haptics::respond(column, p - 1e-6).pressure) / 2e-6;
    EXPECT_NEAR(haptics::respond(column, p).tangent, slope, 1e-5 * slope) << p;
    EXPECT_GE(slope, before * (1.0 - 1e-6));
    before = slope;
  }
}

TEST(Face, MatchesAreasAndNormalsOfTheBody) {
  const haptics::ContactFace probe = haptics::make_transducer_face(60.0, 60.0, 14.0);
  const haptics::ContactFace finger = haptics::make_finger_face(8.0);
  const auto sum = [](const haptics::ContactFace& face) {
    double area = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
      EXPECT_NEAR(face.normal_T[i].norm(), 1.0, 1e-12);
      EXPECT_LE(face.point_T[i].y(), 1e-9);
      area += face.area_mm2[i];
    }
    return area;
  };
  EXPECT_NEAR(sum(probe), 60.0 * (kPi / 3.0) * 14.0, 1e-9);  // a chord of one radius: an arc of 60 degrees
  EXPECT_NEAR(sum(finger), 2.0 * kPi * 64.0, 1e-9);
  EXPECT_EQ(haptics::make_face(haptics::Tool::kNeedle).count, 0);
  EXPECT_TRUE(haptics::parse_tool("probe").has_value());
  EXPECT_EQ(*haptics::parse_tool("finger"), haptics::Tool::kFinger);
  EXPECT_FALSE(haptics::parse_tool("hammer").has_value());
}

}  // namespace
}  // namespace trocar::testing
