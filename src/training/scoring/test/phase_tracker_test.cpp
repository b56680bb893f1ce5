#include "scoring/phase_tracker.h"

#include <gtest/gtest.h>

#include <limits>

#include "motion/testing/sliding_motion.h"
#include "scoring/test/outcome_support.h"
#include "tasks/fit_to_patient.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::scoring {
namespace {

using tasks::ActionKind;
using tasks::ConditionKind;

/// The box patient with one phase per condition under test. The plan goes along +y from (50, 0, 50) to (50, 51, 50).
class Phases : public ::testing::Test {
 protected:
  void add(const std::string& name, std::vector<tasks::Condition> done, std::vector<std::string> after = {},
           double hold_s = 0.0) {
    task_.phases.push_back({name, name, "why", std::move(after), std::move(done), hold_s});
  }
  PhaseTracker tracker() const { return {task_, patient(), testing::make_gun(), testing::make_box_plan(), plane_}; }
  PhaseMoment at(double time_s, const Vec3& tip_P, const Vec3& axis_P = Vec3::UnitY()) const {
    PhaseMoment moment;
    moment.needle.time_s = time_s;
    moment.needle.tip_mm = tip_P;
    moment.needle.axis = axis_P.normalized();
    telemetry::set_at_rest(moment.needle);
    moment.needle.depth_mm = std::max(0.0, tip_P.y());
    moment.X_PT = X_PT_;
    moment.contact_n = contact_n_;
    return moment;
  }
  bool is_done_by(std::vector<tasks::Condition> done, const PhaseMoment& moment) {
    task_.phases.clear();
    add("only", std::move(done));
    PhaseTracker tracked = tracker();
    tracked.step(moment);
    return tracked.states()[0].done_s.has_value();
  }

  tasks::Task task_ = testing::make_box_task();
  metrics::ImagePlane plane_{.depth_mm = 120.0, .radius_mm = 60.0, .field_of_view_rad = 1.0};
  /// On the skin 30 mm beside the plan, its plane through the plan: x lateral, y into the body.
  std::optional<Pose> X_PT_ = Pose(Mat3::Identity(), Vec3(40.0, 0.0, 50.0));
  double contact_n_ = 2.0;
};

/// A patient who breathes holds the breath some time after being asked, and not for ever; one at rest at once.
TEST_F(Phases, BreathIsHeldWhenThePatientHoldsIt) {
  const auto model = motion::testing::uniform_model({0.0, 0.0, -30.0});
  motion::MotionState state;
  state.drivers[0] = 0.5;
  for (const bool breathes : {true, false}) {
    task_.phases.clear();
    add("breath", {{ConditionKind::kBreathHeld, 0.0, {}}});
    PhaseTracker tracked = tracker();
    PhaseMoment moment = at(0.0, {50.0, -10.0, 50.0});
    if (breathes) moment.motion = motion::PatientMotion(model.get(), state);
    tracked.step(moment);
    EXPECT_FALSE(tracked.states()[0].done_s);
    tracked.note({0.0, tasks::ActionKind::kHoldBreath, 0.0, {}, Vec3::Zero(), 0.0});
    tracked.step(moment);
    EXPECT_EQ(tracked.states()[0].done_s.has_value(), !breathes);
    moment.needle.is_breath_held = true;
    tracked.step(moment);
    EXPECT_TRUE(tracked.states()[0].done_s);
  }
}

/// The target is where the patient has moved it.
TEST_F(Phases, TargetInTheImageMovesWithThePatient) {
  const auto model = motion::testing::uniform_model({0.0, 0.0, -30.0});
  PhaseMoment moment = at(0.0, {50.0, -10.0, 50.0});
  const std::vector<tasks::Condition> in_image{{ConditionKind::kTargetInImage, 5.0, {}}};
  EXPECT_TRUE(is_done_by(in_image, moment));
  motion::MotionState state;
  state.drivers[0] = 1.0;
  moment.motion = motion::PatientMotion(model.get(), state);
  EXPECT_FALSE(is_done_by(in_image, moment));
  moment.X_PT = Pose(Mat3::Identity(), Vec3(40.0, 0.0, 20.0));
  EXPECT_TRUE(is_done_by(in_image, moment));
}

TEST_F(Phases, OpenInOrderAndStayDone) {
  add("touch", {{ConditionKind::kTipOnSkin, 0.0, {}}});
  add("deep", {{ConditionKind::kInserted, 40.0, {}}}, {"touch"});
  add("out", {{ConditionKind::kOutside, 0.0, {}}}, {"deep"});
  PhaseTracker tracked = tracker();
  tracked.step(at(0.0, {50.0, -10.0, 50.0}));
  EXPECT_EQ(tracked.current(), 0U);
  EXPECT_FALSE(tracked.states()[1].is_open);
  ASSERT_EQ(tracked.states()[0].lacks.size(), 1U);
  EXPECT_EQ(tracked.states()[0].lacks[0], "put the needle's tip on the skin");
  tracked.step(at(1.0, {50.0, 0.5, 50.0}));
  EXPECT_EQ(tracked.states()[0].done_s, 1.0);
  EXPECT_EQ(tracked.states()[1].begun_s, 1.0);
  tracked.step(at(2.0, {50.0, 45.0, 50.0}));
  EXPECT_EQ(tracked.states()[1].done_s, 2.0);
  tracked.step(at(3.0, {50.0, -5.0, 50.0}));
  EXPECT_EQ(tracked.states()[2].done_s, 3.0);
  EXPECT_EQ(tracked.states()[1].done_s, 2.0) << "it stays done";
  EXPECT_FALSE(tracked.current());
}

TEST_F(Phases, RequireTheBevelAcrossTheFibres) {
  const std::vector<tasks::Condition> turned{{ConditionKind::kBevelToFibres, 30.0, {}}};
  const auto with_bevel = [&](const Vec3& face_P) {
    PhaseMoment moment = at(0.0, {50.0, 0.0, 50.0});
    const Eigen::Quaterniond q(tasks::needle_rotation(Vec3::UnitY(), face_P));
    moment.needle.device_rotation_wxyz = {q.w(), q.x(), q.y(), q.z()};
    moment.needle.device_mm = moment.needle.tip_mm;
    return moment;
  };
  EXPECT_FALSE(is_done_by(turned, with_bevel(Vec3::UnitX()))) << "the task has no rule for the bevel";
  task_.bevel = tasks::BevelRule{"dura", "liver", 30.0};
  EXPECT_TRUE(is_done_by(turned, with_bevel(Vec3::UnitX())));
  EXPECT_TRUE(is_done_by(turned, with_bevel(-Vec3::UnitX())));
  EXPECT_TRUE(is_done_by(turned, with_bevel({1.0, 0.0, 0.5})));
  EXPECT_FALSE(is_done_by(turned, with_bevel({1.0, 0.0, 0.7})));
  EXPECT_FALSE(is_done_by(turned, with_bevel(Vec3::UnitZ())));
}

TEST_F(Phases, RepeatingOneResetsThoseThatFollow) {
  add("touch", {{ConditionKind::kTipOnSkin, 0.0, {}}});
  add("deep", {{ConditionKind::kInserted, 40.0, {}}}, {"touch"});
  PhaseTracker tracked = tracker();
  tracked.step(at(1.0, {50.0, 45.0, 50.0}));
  tracked.step(at(1.1, {50.0, 45.0, 50.0}));
  EXPECT_FALSE(tracked.current());
  tracked.repeat(0);
  EXPECT_FALSE(tracked.states()[1].is_open);
  tracked.step(at(2.0, {50.0, -9.0, 50.0}));
  EXPECT_EQ(tracked.current(), 0U);
}

TEST_F(Phases, RepeatedPhaseIgnoresEarlierActions) {
  const auto action = [](double time_s, ActionKind kind, double amount) {
    return tasks::Action{time_s, kind, amount, {}, Vec3(50.0, 0.0, 50.0), 0.0};
  };
  add("see", {{ConditionKind::kTargetInImage, 3.0, {}}});
  add("numb", {{ConditionKind::kAnaesthetised, 0.0, {}}});
  add("shot", {{ConditionKind::kFired, 0.0, {}}});
  add("wire", {{ConditionKind::kWire, 50.0, {}}});
  add("out", {{ConditionKind::kOutside, 0.0, {}}});
  PhaseTracker tracked = tracker();
  tracked.note(action(0.0, ActionKind::kAnaesthetise, 5.0));
  tracked.note(action(0.0, ActionKind::kAdvanceWire, 50.0));
  PhaseMoment inside = at(0.1, {50.0, 20.0, 50.0});
  inside.cores = 1;
  tracked.step(inside);
  PhaseMoment after = at(0.2, {50.0, -5.0, 50.0});
  after.cores = 1;
  tracked.step(after);
  ASSERT_FALSE(tracked.current());
  for (std::size_t n = 0; n < 5; ++n) tracked.repeat(n);
  for (const double time_s : {0.3, 0.4, 5.0}) {
    after.needle.time_s = time_s;
    tracked.step(after);
  }
  for (std::size_t n = 0; n < 5; ++n) EXPECT_FALSE(tracked.states()[n].done_s) << n;
  contact_n_ = 0.0;  // lifted once
  tracked.step(at(5.1, {50.0, -5.0, 50.0}));
  contact_n_ = 2.0;
  tracked.note(action(5.2, ActionKind::kAnaesthetise, 5.0));
  tracked.note(action(5.2, ActionKind::kAdvanceWire, 50.0));
  inside.needle.time_s = 5.3;
  inside.cores = 2;
  tracked.step(inside);
  tracked.step(at(5.4, {50.0, -5.0, 50.0}));
  for (std::size_t n = 0; n < 5; ++n) EXPECT_TRUE(tracked.states()[n].done_s) << n;
}

TEST_F(Phases, AnaestheticInTheAirDoesNotCount) {
  add("numb", {{ConditionKind::kAnaesthetised, 0.0, {}}});
  PhaseTracker tracked = tracker();
  tracked.note({0.0, ActionKind::kAnaesthetise, 5.0, {}, Vec3(50.0, -20.0, 50.0), 0.0});
  tracked.note({0.0, ActionKind::kAnaesthetise, 0.0, {}, Vec3(50.0, 0.0, 50.0), 0.0});
  tracked.step(at(0.1, {50.0, -5.0, 50.0}));
  EXPECT_FALSE(tracked.states()[0].done_s);
  tracked.note({0.2, ActionKind::kAnaesthetise, 5.0, {}, Vec3(50.0, -2.0, 50.0), 0.0});
  tracked.step(at(0.3, {50.0, -5.0, 50.0}));
  EXPECT_TRUE(tracked.states()[0].done_s);
}

TEST_F(Phases, UnpiercedWallHidesTheTissueBehindIt) {
  PhaseMoment pressed = at(0.0, {50.0, 53.0, 50.0});
  const std::vector<tasks::Condition> in_lesion{{ConditionKind::kTipIn, 0.0, "liver_lesion"}};
  EXPECT_TRUE(is_done_by(in_lesion, pressed));
  pressed.needle.phase = telemetry::InsertionPhase::kLoading;
  pressed.needle.layer_displacement_mm = 4.0;
  EXPECT_FALSE(is_done_by(in_lesion, pressed));
  EXPECT_FALSE(is_done_by({{ConditionKind::kPassed, 0.0, "liver_lesion"}}, pressed));
}

TEST_F(Phases, RememberTissuesPassedInThisInsertion) {
  add("muscle", {{ConditionKind::kPassed, 0.0, "muscle"}});
  add("lesion", {{ConditionKind::kPassed, 0.0, "liver_lesion"}});
  add("either", {{ConditionKind::kPassed, 0.0, "csf|muscle|bone"}});
  EXPECT_EQ(tasks::condition_words(task_.phases[2].done[0]), "advance the tip into the csf");
  PhaseTracker tracked = tracker();
  tracked.step(at(0.0, {50.0, 5.0, 50.0}));
  EXPECT_FALSE(tracked.states()[0].done_s);
  tracked.step(at(0.1, {50.0, 15.0, 50.0}));
  EXPECT_TRUE(tracked.states()[0].done_s);
  EXPECT_TRUE(tracked.states()[2].done_s) << "one of several";
  tracked.step(at(0.2, {50.0, 45.0, 50.0}));
  EXPECT_FALSE(tracked.states()[1].done_s);
}

TEST_F(Phases, TargetInARibShadowIsNotVisible) {
  // The rib is at z from 70 to 80, behind 10 mm.
  const std::vector<tasks::Condition> tip_seen{{ConditionKind::kTipInImage, 3.0, {}}};
  X_PT_ = Pose(Mat3::Identity(), Vec3(50.0, 0.0, 75.0));
  EXPECT_FALSE(is_done_by(tip_seen, at(0.0, {50.0, 40.0, 75.0})));
  X_PT_ = Pose(Mat3::Identity(), Vec3(50.0, 0.0, 60.0));
  EXPECT_TRUE(is_done_by(tip_seen, at(0.0, {50.0, 40.0, 60.0})));
}

TEST_F(Phases, RequireConditionsToHoldForTheirTime) {
  add("hold", {{ConditionKind::kTipOnSkin, 0.0, {}}}, {}, 0.5);
  PhaseTracker tracked = tracker();
  tracked.step(at(0.0, {50.0, 0.0, 50.0}));
  tracked.step(at(0.4, {50.0, 0.0, 50.0}));
  tracked.step(at(0.5, {50.0, -9.0, 50.0}));  // let go
  tracked.step(at(0.6, {50.0, 0.0, 50.0}));
  tracked.step(at(1.0, {50.0, 0.0, 50.0}));
  EXPECT_FALSE(tracked.states()[0].done_s);
  tracked.step(at(1.1, {50.0, 0.0, 50.0}));
  EXPECT_TRUE(tracked.states()[0].done_s);
}

TEST_F(Phases, TargetIsVisibleOnlyWithTransducerContact) {
  const std::vector<tasks::Condition> seen{{ConditionKind::kTargetInImage, 3.0, {}}};
  EXPECT_TRUE(is_done_by(seen, at(0.0, {50.0, -9.0, 50.0})));
  X_PT_ = Pose(Mat3::Identity(), Vec3(40.0, 0.0, 54.0));  // 4 mm beside the plane
  EXPECT_FALSE(is_done_by(seen, at(0.0, {50.0, -9.0, 50.0})));
  X_PT_ = Pose(Mat3::Identity(), Vec3(200.0, 0.0, 50.0));  // outside of the fan
  EXPECT_FALSE(is_done_by(seen, at(0.0, {50.0, -9.0, 50.0})));
  X_PT_ = Pose(Mat3::Identity(), Vec3(40.0, 0.0, 50.0));
  contact_n_ = 0.0;
  EXPECT_FALSE(is_done_by(seen, at(0.0, {50.0, -9.0, 50.0})));
  X_PT_.reset();
  EXPECT_FALSE(is_done_by(seen, at(0.0, {50.0, -9.0, 50.0})));
}

TEST_F(Phases, MeasureAngleAndOffsetToThePlane) {
  const std::vector<tasks::Condition> in_plane{{ConditionKind::kNeedleInPlane, 5.0, {}}};
  EXPECT_TRUE(is_done_by(in_plane, at(0.0, {50.0, 10.0, 50.0})));
  EXPECT_TRUE(is_done_by(in_plane, at(0.0, {50.0, 10.0, 50.0}, {0.3, 1.0, 0.08})));
  EXPECT_FALSE(is_done_by(in_plane, at(0.0, {50.0, 10.0, 50.0}, {0.0, 1.0, 0.1}))) << "5.7 degrees";
  EXPECT_FALSE(is_done_by(in_plane, at(0.0, {50.0, 10.0, 54.5})));
}

TEST_F(Phases, DetectAClearPath) {
  const std::vector<tasks::Condition> clear{{ConditionKind::kPathClear, 2.0, {}}};
  EXPECT_TRUE(is_done_by(clear, at(0.0, {50.0, 0.0, 50.0})));
  EXPECT_FALSE(is_done_by(clear, at(0.0, {22.0, 0.0, 50.0}))) << "through the vessel";
  EXPECT_FALSE(is_done_by(clear, at(0.0, {26.0, 0.0, 50.0}))) << "one millimetre beside it";
  EXPECT_TRUE(is_done_by({{ConditionKind::kPathClear, 0.0, {}}}, at(0.0, {26.0, 0.0, 50.0})));
}

TEST_F(Phases, FollowActionsAndReturnedFluid) {
  add("touch", {{ConditionKind::kTipOnSkin, 0.0, {}}});
  add("bile", {{ConditionKind::kReturned, 0.0, "bile"}, {ConditionKind::kStyletDrawn, 0.0, {}}}, {"touch"});
  PhaseTracker tracked = tracker();
  const auto draw = [](double time_s, tasks::Substance substance) {
    return tasks::Action{time_s, ActionKind::kDrawStylet, 0.0, {substance, 1.0}, {}, 0.0};
  };
  tracked.note(draw(0.1, tasks::Substance::kBile));  // before the phase opened
  tracked.step(at(0.5, {50.0, 5.0, 50.0}));
  tracked.step(at(0.6, {50.0, 5.0, 50.0}));
  EXPECT_EQ(tracked.current(), 1U);
  tracked.note(draw(0.7, tasks::Substance::kBlood));
  tracked.step(at(0.8, {50.0, 5.0, 50.0}));
  EXPECT_EQ(tracked.current(), 1U);
  tracked.note(draw(0.9, tasks::Substance::kBile));
  tracked.note({0.95, ActionKind::kReplaceStylet, 0.0, {}, {}, 0.0});
  tracked.step(at(1.0, {50.0, 5.0, 50.0}));
  EXPECT_EQ(tracked.states()[1].lacks, std::vector<std::string>{"remove the stylet"});
  tracked.note(draw(1.1, tasks::Substance::kNothing));
  tracked.step(at(1.2, {50.0, 5.0, 50.0}));
  EXPECT_FALSE(tracked.current());
}

TEST_F(Phases, RequireMotionFromTheStart) {
  add("move", {{ConditionKind::kMoved, 5.0, {}}});
  PhaseTracker tracked = tracker();
  tracked.step(at(0.0, {50.0, -40.0, 50.0}));
  tracked.step(at(0.1, {54.0, -40.0, 50.0}));
  EXPECT_EQ(tracked.states()[0].lacks, std::vector<std::string>{"move the needle"});
  tracked.step(at(0.2, {50.0, -45.0, 50.0}));
  EXPECT_EQ(tracked.states()[0].done_s, 0.2);
  tracked.step(at(0.3, {50.0, -40.0, 50.0}));
  EXPECT_TRUE(tracked.states()[0].done_s) << "and back";
  tracked.repeat(0);
  tracked.step(at(0.4, {50.0, -40.0, 50.0}));
  tracked.step(at(0.5, {50.0, -43.0, 50.0}));
  EXPECT_FALSE(tracked.states()[0].done_s);
  tracked.step(at(0.6, {50.0, -46.0, 50.0}));
  EXPECT_EQ(tracked.states()[0].done_s, 0.6) << "moved anew";
}

TEST_F(Phases, CountContrastAgentInTheTargetOnly) {
  add("duct", {{ConditionKind::kContrast, 0.5, {}}});
  PhaseTracker tracked = tracker();
  PhaseMoment moment = at(0.0, {50.0, 30.0, 50.0});
  moment.contrast_ml = 2.0;  // in the liver
  tracked.step(moment);
  EXPECT_FALSE(tracked.states()[0].done_s);
  moment = at(1.0, {50.0, 60.0, 50.0});  // in the lesion, the target
  moment.contrast_ml = 2.4;
  tracked.step(moment);
  EXPECT_FALSE(tracked.states()[0].done_s);
  moment.needle.time_s = 2.0;
  moment.contrast_ml = 2.6;
  tracked.step(moment);
  EXPECT_TRUE(tracked.states()[0].done_s);
}

TEST_F(Phases, LookAheadAlongTheThrow) {
  const std::vector<tasks::Condition> clear{{ConditionKind::kThrowClear, 0.0, {}}};
  EXPECT_TRUE(is_done_by(clear, at(0.0, {50.0, 45.0, 50.0})));
  EXPECT_FALSE(is_done_by(clear, at(0.0, {45.0, 60.0, 50.0}, -Vec3::UnitX()))) << "the vessel is 20 mm ahead";
}

TEST_F(Phases, SkipNonFiniteMoments) {
  add("touch", {{ConditionKind::kTipOnSkin, 0.0, {}}});
  PhaseTracker tracked = tracker();
  PhaseMoment broken = at(0.0, {50.0, 0.5, 50.0});
  broken.needle.tip_mm.x() = std::numeric_limits<double>::quiet_NaN();
  tracked.step(broken);
  EXPECT_FALSE(tracked.states()[0].done_s);
  task_.phases.clear();
  PhaseTracker none = tracker();
  none.step(at(0.0, Vec3::Zero()));
  none.repeat(3);
  EXPECT_FALSE(none.current());
}

}  // namespace
}  // namespace trocar::scoring
