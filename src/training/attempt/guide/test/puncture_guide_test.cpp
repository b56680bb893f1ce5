#include "attempt/guide/puncture_guide.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "cases/testing/phantom_case.h"

namespace trocar::attempt {
namespace {

class PunctureGuide : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = testing::phantom_case("layers-liver");
    ASSERT_TRUE(made) << made.error().text();
    the_case = *std::move(made);
  }
  /// On the planned path, so far from the entry.
  static telemetry::TickSample on_path(double depth_mm) {
    telemetry::TickSample sample;
    sample.axis = the_case.plan.line_P.direction();
    sample.tip_mm = the_case.plan.line_P.a + depth_mm * sample.axis;
    telemetry::set_at_rest(sample);
    sample.depth_mm = std::max(0.0, depth_mm);
    sample.phase = depth_mm > 0.0 ? telemetry::InsertionPhase::kInserted : telemetry::InsertionPhase::kOutside;
    return sample;
  }
  /// Towards the head, square to the path.
  static Vec3 headward() {
    const Vec3 axis = the_case.plan.line_P.direction();
    return (Vec3::UnitZ() - axis.z() * axis).normalized();
  }
  static bool says(const telemetry::TickSample& sample, const std::string& words) {
    return guide_puncture(the_case, sample).find(words) != std::string::npos;
  }
  static inline cases::Case the_case;
};

TEST_F(PunctureGuide, AdvisesAdvancingOnThePathAndFiringAtItsEnd) {
  EXPECT_TRUE(says(on_path(-15.0), "advance")) << guide_puncture(the_case, on_path(-15.0));
  const double length_mm = the_case.plan.line_P.length_mm();
  EXPECT_TRUE(says(on_path(length_mm - 12.0), "12 mm to the target"))
      << guide_puncture(the_case, on_path(length_mm - 12.0));
  EXPECT_TRUE(says(on_path(length_mm), "fire")) << guide_puncture(the_case, on_path(length_mm));
  EXPECT_TRUE(says(on_path(length_mm + 4.0), "4.0 mm too deep")) << guide_puncture(the_case, on_path(length_mm + 4.0));
}

TEST_F(PunctureGuide, StatesTheDirectionOfTheEntry) {
  telemetry::TickSample sample = on_path(-15.0);
  sample.rest_tip_mm += 40.0 * headward();
  EXPECT_TRUE(says(sample, "towards the feet")) << guide_puncture(the_case, sample);
  // An entry that lies lateral and further back is not called to be on the patient's back.
  const Vec3 sideways = the_case.plan.line_P.direction().cross(headward());
  sample = on_path(-15.0);
  sample.rest_tip_mm += 90.0 * headward() + 120.0 * sideways;
  EXPECT_TRUE(says(sample, " mm towards the feet")) << guide_puncture(the_case, sample);
  EXPECT_TRUE(says(sample, sideways.x() > 0.0 ? "to the patient's right and" : "to the patient's left and"))
      << guide_puncture(the_case, sample) << sideways.transpose();
  sample = on_path(-15.0);
  sample.rest_tip_mm += 4.0 * Vec3::UnitX();
  EXPECT_TRUE(says(sample, "to the patient's right")) << guide_puncture(the_case, sample);
}

TEST_F(PunctureGuide, AdviceCorrectsTheNeedle) {
  const Vec3 axis = the_case.plan.line_P.direction();
  const double angle = 6.0 * 3.14159265 / 180.0;
  telemetry::TickSample outside = on_path(-15.0);
  outside.rest_axis = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * axis;  // about z: x grows where y shrinks
  const std::string said = guide_puncture(the_case, outside);
  EXPECT_NE(said.find("6 degrees"), std::string::npos) << said;
  // The hub is at tip - axis: it has to go where outside.axis - axis looks.
  const Vec3 way = outside.axis - axis;
  EXPECT_NE(said.find(way.x() > 0.0 ? "left" : "right"), std::string::npos) << said;

  telemetry::TickSample inside = on_path(20.0);
  inside.rest_tip_mm += 3.0 * headward();
  EXPECT_TRUE(says(inside, "3.0 mm from the path: tilt the tip towards the feet")) << guide_puncture(the_case, inside);
}

TEST_F(PunctureGuide, WarnsOfBoneAheadFirst) {
  const volume::LabelGrid& labels = the_case.patient->labels;
  std::optional<Vec3> bone_P;
  for (std::size_t n = 0; n < labels.voxels.size() && !bone_P; ++n) {
    const anatomy::Label* label = the_case.patient->label_table.find(labels.voxels[n]);
    if (label == nullptr || label->tissue != "bone") continue;
    const volume::Index3 ijk = labels.geometry.index_of(n);
    bone_P = labels.geometry.centre_mm(ijk);
  }
  ASSERT_TRUE(bone_P);
  telemetry::TickSample sample = on_path(10.0);
  sample.tip_mm = *bone_P - 5.0 * sample.axis;
  telemetry::set_at_rest(sample);
  const std::string said = guide_puncture(the_case, sample);
  EXPECT_NE(said.find("Bone"), std::string::npos) << said;
  EXPECT_NE(said.find("mm ahead"), std::string::npos) << said;
}

/// The case with another needle and with bone in a ball beyond the planned end.
cases::Case with_bone_behind(const cases::Case& the_case, double behind_mm) {
  cases::Case changed = the_case;
  changed.needle.is_biopsy = false;
  changed.needle.stylet_diameter_mm = 0.5;
  changed.task.confirmed_by = tasks::Substance::kBile;
  auto patient = std::make_shared<anatomy::VirtualPatient>(*the_case.patient);
  const Segment& path_P = the_case.plan.line_P;
  const Vec3 middle_P = path_P.b + (behind_mm + 3.0) * path_P.direction();
  const auto bone = std::ranges::find(patient->label_table.labels, "bone", &anatomy::Label::tissue);
  EXPECT_NE(bone, patient->label_table.labels.end());
  for (std::size_t n = 0; n < patient->labels.voxels.size(); ++n) {
    const Vec3 p_P = patient->labels.geometry.centre_mm(patient->labels.geometry.index_of(n));
    if ((p_P - middle_P).norm() < 3.0) patient->labels.voxels[n] = bone->id;
  }
  changed.patient = std::move(patient);
  return changed;
}

TEST_F(PunctureGuide, WarnsOnlyOfStructuresBeforeTheTarget) {
  const cases::Case changed = with_bone_behind(the_case, 6.0);
  const double length_mm = the_case.plan.line_P.length_mm();
  EXPECT_EQ(guide_puncture(changed, on_path(length_mm - 3.0)).find("Bone"), std::string::npos) << "behind the target";
  telemetry::TickSample beyond = on_path(length_mm + 2.0);  // on its way there
  beyond.rest_tip_mm += 8.0 * headward();
  EXPECT_TRUE(guide_puncture(changed, beyond).find("Bone") != std::string::npos ||
              guide_puncture(changed, beyond).find("too deep") != std::string::npos)
      << guide_puncture(changed, beyond);
  const cases::Case before = with_bone_behind(the_case, -15.0);
  EXPECT_NE(guide_puncture(before, on_path(length_mm - 20.0)).find("Bone"), std::string::npos);
}

TEST_F(PunctureGuide, ReportsTheTargetOnlyInsideIt) {
  const double length_mm = the_case.plan.line_P.length_mm();
  cases::Case changed = with_bone_behind(the_case, 30.0);
  changed.is_parenchymal = false;
  changed.task.target_tissues = {"bile_duct"};  // this patient has none there: the tip is beside it
  EXPECT_EQ(guide_puncture(changed, on_path(length_mm)).find("At the target"), std::string::npos);
  EXPECT_NE(guide_puncture(changed, on_path(length_mm)).find("Beside the bile duct"), std::string::npos);
  changed.task.target_tissues = {anatomy::find_label(*changed.patient, on_path(length_mm).tip_mm)->tissue};
  EXPECT_EQ(guide_puncture(changed, on_path(length_mm)), "At the target: hold still and remove the stylet");
  telemetry::TickSample pressing = on_path(length_mm);
  pressing.phase = telemetry::InsertionPhase::kLoading;
  pressing.layer_displacement_mm = length_mm - 1.0;
  EXPECT_EQ(guide_puncture(changed, pressing).find("At the target"), std::string::npos) << "the wall did not give way";
}

TEST_F(PunctureGuide, StatesTheResultOfAShotAndCompletion) {
  GunShot air;
  EXPECT_EQ(guide_puncture(the_case, on_path(-5.0), {0, false, &air}),
            "No core, the gun was fired outside the body: load the gun for the next one");
  GunShot bone;
  bone.depth_mm = 20.0;
  EXPECT_NE(guide_puncture(the_case, on_path(20.0), {0, false, &bone}).find("No core, the stylet hit bone"),
            std::string::npos);
  const std::size_t all = the_case.task.cores;
  EXPECT_EQ(guide_puncture(the_case, on_path(-5.0), {all, true}), "The needle is out: end the attempt");
  EXPECT_EQ(guide_puncture(the_case, on_path(20.0), {all, true}), "Everything is done: withdraw the needle");
  EXPECT_EQ(guide_puncture(the_case, on_path(-5.0), {.are_steps_done = true}), "The needle is out: end the attempt");
  EXPECT_EQ(guide_puncture(with_bone_behind(the_case, 30.0), on_path(20.0), {.is_confirmed = true}),
            "Position confirmed: hold still for the next step");
}

TEST_F(PunctureGuide, IsSilentForNonFinitePoses) {
  telemetry::TickSample sample = on_path(5.0);
  sample.rest_tip_mm.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(guide_puncture(the_case, sample), "");
  EXPECT_EQ(guide_puncture(the_case, telemetry::TickSample{}).empty(), false);  // a real place, if a strange one
}

}  // namespace
}  // namespace trocar::attempt
