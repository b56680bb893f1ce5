#include "ultrasound/probe/probe_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/testing/allocation_guard.h"
#include "ultrasound/tissue/acoustic_scene.h"
#include "ultrasound/tissue/test/make_block.h"

namespace trocar::ultrasound {
namespace {

/// Skin at y = 0, the body where y > 0.
volume::FloatGrid flat_skin() {
  volume::GridGeometry geometry;
  geometry.size = {61, 61, 31};
  geometry.spacing_mm.setConstant(2.0);
  geometry.origin_P = Vec3(-60, -60, -30);
  volume::FloatGrid skin(geometry);
  for (std::size_t n = 0; n < skin.voxels.size(); ++n)
    skin.voxels[n] = static_cast<float>(60.0 - 2.0 * static_cast<double>(geometry.index_of(n)[1]));
  return skin;
}

ScanGeometry linear_scan(int lines = 65) {
  ScanGeometry geometry;
  geometry.is_fan = false;
  geometry.lines = lines;
  geometry.line_step = 40.0 / (lines - 1);
  return geometry;
}

ScanGeometry convex_scan(int lines = 65) {
  ScanGeometry geometry;
  geometry.radius_mm = 60.0;
  geometry.lines = lines;
  geometry.line_step = 1.0 / (lines - 1);
  return geometry;
}

Pose tilted(double angle_rad, const Vec3& p_PT) {
  return {Mat3(Eigen::AngleAxisd(angle_rad, Vec3::UnitZ())), p_PT};
}

TEST(ProbeContact, FlatFaceDentsFlatSkinByItsDepth) {
  const volume::FloatGrid skin = flat_skin();
  std::vector<LineContact> contact(65);
  find_contact(skin, linear_scan(), Pose::translation({3, 4.3, 1}), contact);
  for (const LineContact& line : contact) {
    EXPECT_NEAR(line.pressed_mm, 4.3, 0.03);
    EXPECT_EQ(line.gap_mm, 0.0F);
    EXPECT_EQ(line.coupling, 1.0F);
  }
}

TEST(ProbeContact, GapIsMeasuredAndLosesCoupling) {
  const volume::FloatGrid skin = flat_skin();
  std::vector<LineContact> contact(65);
  for (const double gap_mm : {0.4, 1.5, 3.0, 40.0}) {
    find_contact(skin, linear_scan(), Pose::translation({3, -gap_mm, 1}), contact);
    EXPECT_EQ(contact[5].pressed_mm, 0.0F);
    EXPECT_NEAR(contact[5].gap_mm, std::min(gap_mm, kWidestGap_mm), 0.03);
    if (gap_mm <= kGelFills_mm)
      EXPECT_EQ(contact[5].coupling, 1.0F);
    else if (gap_mm >= kGelEnds_mm)
      EXPECT_EQ(contact[5].coupling, 0.0F);
    else
      EXPECT_NEAR(contact[5].coupling, 0.5F, 0.1F);
  }
}

TEST(ProbeContact, DistanceIsAlongTheScanline) {
  // A convex face: its outer scanlines leave it obliquely and behind the middle.
  const volume::FloatGrid skin = flat_skin();
  const ScanGeometry geometry = convex_scan();
  std::vector<LineContact> contact(65);
  constexpr double kPressed_mm = 3.0;
  find_contact(skin, geometry, Pose::translation({0, kPressed_mm, 0}), contact);
  for (int n = 0; n < 65; ++n) {
    const double angle = (n - 32) * geometry.line_step;
    const double y = kPressed_mm - 60.0 * (1.0 - std::cos(angle));
    const auto& line = contact[static_cast<std::size_t>(n)];
    EXPECT_NEAR(line.pressed_mm - line.gap_mm, y / std::cos(angle), 0.04) << n;
  }
  EXPECT_LT(contact[0].coupling, 0.01F);
  EXPECT_EQ(contact[32].coupling, 1.0F);
}

TEST(ProbeContact, TiltedFaceLosesOneSideSmoothly) {
  const volume::FloatGrid skin = flat_skin();
  std::vector<LineContact> contact(257);
  find_contact(skin, linear_scan(257), tilted(0.2, {0, 1, 0}), contact);
  EXPECT_EQ(contact.front().coupling, 0.0F);
  EXPECT_EQ(contact.back().coupling, 1.0F);
  for (std::size_t n = 1; n < contact.size(); ++n) {
    EXPECT_GE(contact[n].coupling, contact[n - 1].coupling - 1e-6F);
    EXPECT_LT(contact[n].coupling - contact[n - 1].coupling, 0.1F);
  }
}

TEST(ProbeContact, PressesNothingWithoutSkinOrPose) {
  std::vector<LineContact> contact(65, LineContact{1, 1, 0});
  find_contact(volume::FloatGrid{}, linear_scan(), Pose{}, contact);
  EXPECT_EQ(contact[7].pressed_mm, 0.0F);
  EXPECT_EQ(contact[7].coupling, 1.0F);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const volume::FloatGrid skin = flat_skin();
  for (const double bad : {nan, 1e300, -1e300, std::numeric_limits<double>::infinity()}) {
    find_contact(skin, linear_scan(), Pose::translation({bad, 0, 0}), contact);
    for (const LineContact& line : contact) EXPECT_TRUE(std::isfinite(line.pressed_mm + line.gap_mm + line.coupling));
  }
}

TEST(ProbeContact, AllocatesNothing) {
  const volume::FloatGrid skin = flat_skin();
  std::vector<LineContact> contact(65);
  const testing::AllocationGuard guard;
  find_contact(skin, convex_scan(), Pose::translation({0, 3, 0}), contact);
  EXPECT_EQ(guard.count(), 0U);
}

TEST(ProbeContact, DentIsMonotoneAndItsInverseExact) {
  Random random(5);
  for (int n = 0; n < 20000; ++n) {
    const double pressed_mm = random.uniform(0.0, kDeepestDent_mm);
    const double reach_mm = random.uniform(12.0, 60.0);
    const double depth_mm = random.uniform(0.0, 80.0);
    const double rest_mm = rest_depth_mm(depth_mm, pressed_mm, reach_mm);
    EXPECT_LT(rest_mm, rest_depth_mm(depth_mm + 0.01, pressed_mm, reach_mm));
    EXPECT_GE(rest_mm, -pressed_mm);
    EXPECT_LE(rest_mm, depth_mm);
    EXPECT_NEAR(pressed_depth_mm(rest_mm, pressed_mm, reach_mm), depth_mm, 1e-9);
  }
}

TEST(ProbeContact, DentMovesTheSkinToTheFaceAndKeepsDeepTissue) {
  EXPECT_DOUBLE_EQ(rest_depth_mm(0.0, 7.0), -7.0);
  EXPECT_NEAR(pressed_depth_mm(-7.0, 7.0), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(rest_depth_mm(kDentReach_mm, 7.0), kDentReach_mm);
  EXPECT_DOUBLE_EQ(rest_depth_mm(90.0, 7.0), 90.0);
  // Nearer layers are squeezed more.
  const auto thickness = [](double from_mm) {
    return pressed_depth_mm(from_mm + 5.0, 7.0) - pressed_depth_mm(from_mm, 7.0);
  };
  EXPECT_LT(thickness(-7.0), thickness(5.0));
  EXPECT_LT(thickness(5.0), thickness(20.0));
  EXPECT_LT(thickness(20.0), 5.0);
}

TEST(ProbeContact, ReachGrowsWithFatAndEndsAtBone) {
  using namespace testing;
  const auto reach_mm = [](double fat_mm, double bone_mm) {
    const anatomy::VirtualPatient patient = make_block({90, 80, 30}, {1.5, 1.5, 3.0}, [&](const Vec3& p_P) {
      return BlockVoxel{p_P.y() > bone_mm ? kBone : p_P.y() < fat_mm ? kFat : kMuscle, 0};
    });
    AcousticTable table = make_block_table();
    AcousticTissue& bone = table.tissues[*table.find("bone")];
    bone.speed_m_per_s = 3500.0;
    bone.density_kg_per_m3 = 1900.0;
    const auto scene = make_acoustic_scene(patient, table);
    return find_dent_reach_mm(**scene, linear_scan(), Pose::translation({0, 0, 0}));
  };
  EXPECT_GT(reach_mm(20, 60), reach_mm(5, 60) + 8.0);
  EXPECT_NEAR(reach_mm(20, 16), 16.0, 1.5);
  EXPECT_GE(reach_mm(3, 4), 12.0);
}

}  // namespace
}  // namespace trocar::ultrasound
