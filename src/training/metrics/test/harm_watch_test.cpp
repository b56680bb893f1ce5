#include "metrics/harm_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tasks/testing/attempt_patient.h"

namespace trocar::metrics {
namespace {

using tasks::Harm;

/// The box patient (fat, muscle, liver) with a bowel of 20 x 20 x 20 mm from (60, 40, 40), a vein of 4 mm and a film of
/// 1 mm: everything that a task can be told to harm.
class Harms : public ::testing::Test {
 protected:
  Harms() : patient_(testing::make_box_patient(false)), task_(testing::make_box_task()) {
    patient_.label_table.labels.push_back({7, "colon", "bowel", {}});
    patient_.label_table.labels.push_back({8, "hepatic_vein", "vessel", {}});
    patient_.label_table.labels.push_back({9, "pleural_recess", "pleura", {}});
    const auto& geometry = patient_.labels.geometry;
    for (std::size_t n = 0; n < patient_.labels.voxels.size(); ++n) {
      const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
      if (((p_P - Vec3(70.0, 50.0, 50.0)).array().abs() < 10.0).all()) patient_.labels.voxels[n] = 7;
      if (std::abs(p_P.y() - 30.0) < 2.0 && p_P.x() > 85.0) patient_.labels.voxels[n] = 8;
      if (std::abs(p_P.y() - 24.5) < 0.5 && p_P.x() < 15.0) patient_.labels.voxels[n] = 9;
    }
    task_.risks = {{"bowel", "", 5.0, false, Harm::kCritical},
                   {"vessel", "", 5.0, false, {}},
                   {"pleura", "", 1.0, false, Harm::kMajor},
                   {"bone", "", 1.0, false, Harm::kMinor}};
    tasks::HarmRule vein;
    vein.tissues = {"vessel"};
    vein.grade = Harm::kMinor;
    vein.notch = vein.stay = Harm::kMajor;
    vein.stay_s = 10.0;
    vein.reason = "blood";
    tasks::HarmRule none;
    none.tissues = {"adipose", "muscle"};
    none.grade = Harm::kNone;
    task_.harms = {vein, none};
  }

  HarmWatch watch() const { return {task_, patient_, testing::make_gun()}; }
  Moment at(const Vec3& tip_P, double time_s = 0.0) const {
    Moment moment;
    moment.time_s = time_s;
    moment.tip_P = tip_P;
    moment.axis_P = Vec3::UnitY();
    moment.depth_mm = std::max(0.0, tip_P.y());
    return moment;
  }
  /// Pushes a needle straight in at (x, z) to a depth and out again, 0.1 mm a moment.
  std::vector<HarmEvent> push(double x_mm, double z_mm, double deep_mm) const {
    HarmWatch watching = watch();
    double time_s = 0.0;
    for (double y_mm = -2.0; y_mm < deep_mm; y_mm += 0.1) watching.step(at({x_mm, y_mm, z_mm}, time_s += 0.01));
    for (double y_mm = deep_mm; y_mm > -2.0; y_mm -= 0.5) watching.step(at({x_mm, y_mm, z_mm}, time_s += 0.01));
    return watching.events();
  }

  anatomy::VirtualPatient patient_;
  tasks::Task task_;
};

TEST_F(Harms, StateHowDeepTheNeedleWent) {
  const auto events = push(70.0, 50.0, 52.0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].label, "colon");
  EXPECT_EQ(events[0].grade, Harm::kCritical);
  EXPECT_FALSE(events[0].is_graze);
  EXPECT_NEAR(events[0].inside_mm, 12.0, 0.6);
  EXPECT_NEAR(events[0].depth_mm, 40.0, 0.6);
  EXPECT_EQ(harm_words(events[0]), "the needle went 12 mm into the colon");
}

TEST_F(Harms, IncludeTheShaft) {
  const auto events = push(70.0, 50.0, 80.0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_NEAR(events[0].inside_mm, 20.0, 0.6) << "right through";
}

TEST_F(Harms, AGrazeWithinAVoxelIsAWarning) {
  for (const double x_mm : {60.2, 60.9}) {  // along its side, 6 mm long
    const auto events = push(x_mm, 50.0, 46.0);
    ASSERT_EQ(events.size(), 1U) << x_mm;
    EXPECT_TRUE(events[0].is_graze) << x_mm;
    EXPECT_EQ(events[0].grade, Harm::kMinor);
    EXPECT_EQ(harm_words(events[0]), "the needle grazed the colon");
    EXPECT_FALSE(push(x_mm, 50.0, 70.0)[0].is_graze) << "20 mm along it are no graze: " << x_mm;
  }
  EXPECT_TRUE(push(70.0, 50.0, 40.8)[0].is_graze) << "the tip alone";
  for (const double x_mm : {61.3, 65.0}) EXPECT_FALSE(push(x_mm, 50.0, 46.0)[0].is_graze) << x_mm;
  EXPECT_FALSE(push(70.0, 50.0, 41.4)[0].is_graze);
  EXPECT_TRUE(push(59.4, 50.0, 70.0).empty()) << "beside it";
}

TEST_F(Harms, AThinStructureIsCrossedNotGrazed) {
  const auto vein = push(92.0, 50.0, 40.0);
  ASSERT_EQ(vein.size(), 1U);
  EXPECT_FALSE(vein[0].is_graze);
  EXPECT_EQ(vein[0].grade, Harm::kMinor);
  const auto film = push(10.0, 50.0, 40.0);  // one voxel thick
  ASSERT_EQ(film.size(), 1U);
  EXPECT_FALSE(film[0].is_graze);
  EXPECT_EQ(film[0].grade, Harm::kMajor);
}

/// Tubes of 1 to 5 voxels across that the needle crosses in the middle, along the grid and obliquely to it.
TEST_F(Harms, CentrallyCrossedTubeIsNeverAGraze) {
  const auto& geometry = patient_.labels.geometry;
  const anatomy::VirtualPatient clean = patient_;
  for (const double radius_mm : {0.6, 1.0, 1.5, 2.0, 2.5})
    for (const Vec3& way_P : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(1.0, 0.0, 1.0), Vec3(1.0, 0.6, 0.3)})
      for (const double shift_mm : {0.0, 0.3, 0.5, 0.8}) {
        patient_ = clean;
        const Vec3 middle_P(40.0 + shift_mm, 40.0 + shift_mm, 50.0 + shift_mm), along_P = way_P.normalized();
        for (std::size_t n = 0; n < patient_.labels.voxels.size(); ++n) {
          const Vec3 apart_P = geometry.centre_mm(geometry.index_of(n)) - middle_P;
          if ((apart_P - apart_P.dot(along_P) * along_P).norm() < radius_mm) patient_.labels.voxels[n] = 7;
        }
        const auto events = push(middle_P.x(), middle_P.z(), 60.0);
        if (events.empty()) continue;  // a tube of less than a voxel has gaps
        EXPECT_FALSE(events[0].is_graze) << radius_mm << " mm along " << way_P.transpose() << " at " << shift_mm;
      }
}

TEST_F(Harms, ReturnedBowelContentRulesOutAGraze) {
  HarmWatch watching = watch();
  watching.step(at({70.0, 40.7, 50.0}, 0.1));
  ASSERT_TRUE(watching.events()[0].is_graze);
  watching.note(
      {0.2, tasks::ActionKind::kAspirate, 0.0, {tasks::Substance::kNothing, 0.0}, Vec3(70.0, 40.7, 50.0), 40.7});
  EXPECT_TRUE(watching.events()[0].is_graze);
  watching.note(
      {0.3, tasks::ActionKind::kAspirate, 0.0, {tasks::Substance::kBowelContent, 0.4}, Vec3(70.0, 40.7, 50.0), 40.7});
  EXPECT_FALSE(watching.events()[0].is_graze);
  EXPECT_EQ(watching.events()[0].grade, Harm::kCritical);
}

TEST_F(Harms, BloodFromAVeinBehindTheTipKeepsTheGraze) {
  HarmWatch watching = watch();
  watching.step(at({90.0, 28.7, 50.0}, 0.1));
  ASSERT_EQ(watching.events().size(), 1U);
  ASSERT_TRUE(watching.events()[0].is_graze);
  const auto look = [&](tasks::Substance substance) {
    watching.note({0.2, tasks::ActionKind::kDrawStylet, 0.0, {substance, 0.6}, Vec3(90.0, 32.2, 50.0), 32.2});
  };
  look(tasks::Substance::kBile);  // not of the vein
  EXPECT_TRUE(watching.events()[0].is_graze);
  look(tasks::Substance::kBlood);
  EXPECT_FALSE(watching.events()[0].is_graze);
  EXPECT_EQ(watching.events()[0].grade, Harm::kMinor);
}

TEST_F(Harms, TremorDoesNotEndAContact) {
  HarmWatch watching = watch();
  for (double y_mm = 0.0; y_mm < 40.0; y_mm += 0.2) watching.step(at({92.0, y_mm, 50.0}, y_mm / 20.0));
  for (double time_s = 2.0; time_s < 13.0; time_s += 0.01)  // to and fro by 0.6 mm, so that each moment is looked at
    watching.step(at({92.0 + 0.3 * std::sin(50.0 * time_s), 29.0 + 1.2 * std::sin(31.0 * time_s), 50.0}, time_s));
  EXPECT_TRUE(watching.events()[0].has_stayed);
}

TEST_F(Harms, AdjacentStructuresOfOneGradeAreNotGrazed) {
  patient_.label_table.labels.push_back({10, "stomach", "bowel", {}});
  const auto& geometry = patient_.labels.geometry;
  for (std::size_t n = 0; n < patient_.labels.voxels.size(); ++n)
    if (patient_.labels.voxels[n] == 7 && geometry.centre_mm(geometry.index_of(n)).x() > 70.0)
      patient_.labels.voxels[n] = 10;
  const auto events = push(70.4, 50.0, 60.0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_FALSE(events[0].is_graze) << "half a voxel inside the stomach, but in the middle of bowel";
}

TEST_F(Harms, StayInAVeinRaisesTheGrade) {
  HarmWatch watching = watch();
  for (double y_mm = 0.0; y_mm < 40.0; y_mm += 0.2) watching.step(at({92.0, y_mm, 50.0}, y_mm / 20.0));
  for (double time_s = 2.0; time_s < 11.0; time_s += 0.1) watching.step(at({92.0, 40.0, 50.0}, time_s));
  EXPECT_EQ(watching.events()[0].grade, Harm::kMinor);
  EXPECT_EQ(watching.take_news().size(), 1U);
  EXPECT_TRUE(watching.take_news().empty());
  Moment paused = at({92.0, 40.0, 50.0}, 60.0);
  paused.is_paused = true;  // an interruption is not the trainee's time
  watching.step(paused);
  EXPECT_EQ(watching.events()[0].grade, Harm::kMinor);
  for (double time_s = 60.1; time_s < 63.0; time_s += 0.1) watching.step(at({92.0, 40.0, 50.0}, time_s));
  EXPECT_EQ(watching.events()[0].grade, Harm::kMajor);
  EXPECT_TRUE(watching.events()[0].has_stayed);
  EXPECT_NE(harm_words(watching.events()[0]).find("stayed in the hepatic vein for 1"), std::string::npos);
  EXPECT_EQ(watching.take_news().size(), 1U) << "told again, it became worse";
  ASSERT_NE(watching.present(), nullptr);
  EXPECT_EQ(watching.present()->label, watching.events()[0].label);
  watching.step(at({92.0, -5.0, 50.0}, 63.1));
  EXPECT_EQ(watching.present(), nullptr) << "the needle is outside";
}

TEST_F(Harms, NotchInAVeinIsWorseThanTheStylet) {
  // The throw is 22 mm, the notch lies 1 to 18 mm beyond the tip.
  const auto shot_from = [&](double y_mm) {
    HarmWatch watching = watch();
    watching.step(at({92.0, y_mm, 50.0}, 0.1));
    watching.fire(at({92.0, y_mm, 50.0}, 0.2));
    return watching.events();
  };
  const auto notch = shot_from(22.0);
  ASSERT_EQ(notch.size(), 1U);
  EXPECT_EQ(notch[0].grade, Harm::kMajor);
  EXPECT_TRUE(notch[0].is_by_notch);
  EXPECT_EQ(harm_words(notch[0]), "the notch closed in the hepatic vein");
  const auto tip = shot_from(9.9);  // only the stylet's tip beyond the notch
  ASSERT_EQ(tip.size(), 1U);
  EXPECT_EQ(tip[0].grade, Harm::kMinor);
  EXPECT_TRUE(tip[0].is_by_stylet);
}

TEST_F(Harms, BoneStopsTheStylet) {
  HarmWatch watching = watch();
  watching.fire(at({70.0, 5.0, 75.0}, 0.1));
  ASSERT_EQ(watching.events().size(), 1U);
  EXPECT_EQ(watching.events()[0].label, "rib_right_9");
  EXPECT_EQ(watching.events()[0].grade, Harm::kMinor);
  EXPECT_FALSE(watching.events()[0].is_graze);
}

TEST_F(Harms, PressingHarmsBoneButNotAWall) {
  Moment pressing = at({70.0, 43.0, 50.0});
  pressing.pressed_mm = 3.2;
  HarmWatch watching = watch();
  watching.step(pressing);
  EXPECT_TRUE(watching.events().empty());
  Moment on_bone = at({50.0, 10.2, 75.0}, 1.0);
  on_bone.pressed_mm = 0.4;
  watching.step(on_bone);
  ASSERT_EQ(watching.events().size(), 1U);
  EXPECT_EQ(harm_words(watching.events()[0]), "the needle touched the right rib 9");
}

TEST_F(Harms, PressingOnBoneWithoutMovingTouchesIt) {
  HarmWatch watching = watch();
  watching.step(at({50.0, 9.9, 75.0}, 0.0));  // stops before the rib
  EXPECT_TRUE(watching.events().empty());
  Moment on_bone = at({50.0, 10.1, 75.0}, 0.1);
  on_bone.pressed_mm = 0.2;  // what is pierced stays where it was
  watching.step(on_bone);
  ASSERT_EQ(watching.events().size(), 1U);
  EXPECT_EQ(watching.events()[0].label, "rib_right_9");
}

TEST_F(Harms, AFastNeedleSkipsNothing) {
  HarmWatch watching = watch();
  watching.step(at({50.0, 50.0, 50.0}, 0.0));
  watching.step(at({90.0, 50.0, 50.0}, 0.001));  // sideways through the bowel between two moments
  EXPECT_TRUE(std::ranges::any_of(watching.events(), [](const auto& event) { return event.label == "colon"; }));
}

TEST_F(Harms, SkipNonFiniteValues) {
  HarmWatch watching = watch();
  Moment bad = at({70.0, 50.0, 50.0});
  bad.tip_P.x() = std::numeric_limits<double>::quiet_NaN();
  watching.step(bad);
  watching.fire(bad);
  EXPECT_TRUE(watching.events().empty());
}

}  // namespace
}  // namespace trocar::metrics
