#include <gtest/gtest.h>

#include "scoring/score.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::scoring {
namespace {

using namespace testing;

constexpr double kVoxel_mm = 0.5;  // where a border lies on a voxel grid of 1 mm

TEST(TakeCore, NamesThePiecesAlongTheNotch) {
  const anatomy::VirtualPatient patient = make_box_patient();
  // The notch from y = 41 to 58: liver to 50, lesion behind it.
  const BiopsyCore core = take_core(make_box_task(), patient, make_gun(), {50.0, 40.0, 50.0}, Vec3::UnitY());
  ASSERT_EQ(core.pieces.size(), 2u);
  EXPECT_EQ(core.pieces[0].label, "liver");
  EXPECT_EQ(core.pieces[0].tissue, "liver");
  EXPECT_EQ(core.pieces[1].label, "livertumor1");
  EXPECT_EQ(core.pieces[0].from_mm, 0.0);
  EXPECT_NEAR(core.pieces[0].to_mm, 9.0, kVoxel_mm);
  EXPECT_EQ(core.pieces[1].from_mm, core.pieces[0].to_mm);
  EXPECT_NEAR(core.pieces[1].to_mm, 17.0, 1e-9);
  EXPECT_NEAR(core.target_mm, 8.0, kVoxel_mm);
  EXPECT_NEAR(core.organ_mm, 9.0, kVoxel_mm);
  EXPECT_TRUE(core.risks_in_throw.empty());
}

TEST(TakeCore, LengthsSumToTheNotch) {
  const anatomy::VirtualPatient patient = make_box_patient();
  for (int i = 0; i < 200; ++i) {
    const Vec3 tip_P(10.0 + 0.37 * i, -20.0 + 0.6 * i, 15.0 + 0.4 * i);
    const Vec3 axis_P = Vec3(std::sin(i), 1.0, std::cos(i)).normalized();
    const BiopsyCore core = take_core(make_box_task(), patient, make_gun(), tip_P, axis_P);
    EXPECT_NEAR(core.target_mm + core.organ_mm + core.vessel_mm + core.other_mm, 17.0, 1e-9);
    EXPECT_NEAR(core.pieces.back().to_mm, 17.0, 1e-9);
  }  // none of these reaches the rib
}

TEST(TakeCore, MeasuresVesselsAndFindsRisksBeyondTheNotch) {
  const anatomy::VirtualPatient patient = make_box_patient();
  // Towards the patient's right: notch x from 38 to 21, dead space from 21 to 17.
  const BiopsyCore core = take_core(make_box_task(), patient, make_gun(), {39.0, 40.0, 20.0}, -Vec3::UnitX());
  EXPECT_NEAR(core.vessel_mm, 4.0, kVoxel_mm);
  EXPECT_EQ(core.risks_in_throw, std::vector<std::string>{"portal_vein"});
  // 4 mm further off the notch ends where the vessel begins: only the dead space reaches it.
  const BiopsyCore off = take_core(make_box_task(), patient, make_gun(), {43.5, 40.0, 20.0}, -Vec3::UnitX());
  EXPECT_EQ(off.vessel_mm, 0.0);
  EXPECT_EQ(off.risks_in_throw, std::vector<std::string>{"portal_vein"});
  const BiopsyCore clear = take_core(make_box_task(), patient, make_gun(), {48.0, 40.0, 20.0}, -Vec3::UnitX());
  EXPECT_TRUE(clear.risks_in_throw.empty());
}

TEST(TakeCore, BoneStopsTheStylet) {
  const anatomy::VirtualPatient patient = make_box_patient();
  // From the fat into the rib 10 mm below the skin: the stylet gets 8 mm far, 4 mm of them notch.
  const BiopsyCore core = take_core(make_box_task(), patient, make_gun(), {50.0, 2.0, 75.0}, Vec3::UnitY());
  EXPECT_EQ(core.risks_in_throw, std::vector<std::string>{"rib_right_9"});
  EXPECT_NEAR(core.other_mm, 4.0, kVoxel_mm);
  EXPECT_EQ(core.target_mm + core.organ_mm + core.vessel_mm, 0.0);
  // With the tip on the rib nothing comes out.
  const BiopsyCore none = take_core(make_box_task(), patient, make_gun(), {50.0, 10.5, 75.0}, Vec3::UnitY());
  EXPECT_TRUE(none.pieces.empty());
  EXPECT_EQ(none.risks_in_throw, std::vector<std::string>{"rib_right_9"});
}

TEST(TakeCore, TreatsTheOrganAsTargetWithoutALesion) {
  const anatomy::VirtualPatient patient = make_box_patient(false);
  const BiopsyCore core = take_core(make_box_task(), patient, make_gun(), {50.0, 40.0, 50.0}, Vec3::UnitY());
  EXPECT_NEAR(core.target_mm, 17.0, 1e-9);
  EXPECT_EQ(core.organ_mm, 0.0);
}

TEST(TakeCore, OutsideThePatientFindsNothing) {
  const BiopsyCore core = take_core(make_box_task(), make_box_patient(), make_gun(), {500.0, 0.0, 0.0}, Vec3::UnitX());
  ASSERT_EQ(core.pieces.size(), 1u);
  EXPECT_EQ(core.pieces[0].label, "unlabelled");
  EXPECT_NEAR(core.other_mm, 17.0, 1e-9);
}

}  // namespace
}  // namespace trocar::scoring
