// Punctures without a gun: what came back, several expert paths, pain, the access as it was.
#include <gtest/gtest.h>

#include <algorithm>

#include "scoring/test/outcome_support.h"

namespace trocar::scoring {
namespace {

using namespace testing;

TEST(Puncture, TheRightSubstanceProvesTheTarget) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  const double at_s = attempt.samples[attempt.fired].time_s;
  const Outcome unproved = puncture.score(attempt);
  EXPECT_FALSE(unproved.target_reached);
  EXPECT_NEAR(unproved.score, 60.0, 1e-6);
  ASSERT_FALSE(unproved.fails.empty());
  EXPECT_EQ(unproved.fails.front(), "the place is not proven: no bile came back");
  EXPECT_TRUE(has_hint(unproved, "draw the stylet at the target and look whether bile comes"));
  puncture.actions = {{at_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBlood, 1.0}, {}, 51.0}};
  EXPECT_TRUE(has_hint(puncture.score(attempt), "Not bile but blood came back"));
  EXPECT_FALSE(puncture.score(attempt).target_reached);
  puncture.actions[0].result = {tasks::Substance::kBile, 0.3};
  const Outcome slow = puncture.score(attempt);
  EXPECT_TRUE(slow.target_reached);
  EXPECT_NEAR(slow.score, 60.0 + 28.0, 1e-6);
  puncture.actions[0].result.share = 0.9;
  EXPECT_NEAR(puncture.score(attempt).score, 100.0, 1e-6);
}

TEST(Puncture, AConfirmedPlaceIsTheEndEvenIfTheNeedleWentDeeperBefore) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Segment deep_P{make_box_plan().line_P.a, make_box_plan().line_P.b + Vec3(0.0, 12.0, 0.0)};
  const Attempt attempt = make_attempt(deep_P);  // 12 mm too deep, then out
  EXPECT_NEAR(part(puncture.score(attempt), "target").value, 12.0, 0.1);
  const auto back = std::find_if(attempt.samples.begin() + static_cast<std::ptrdiff_t>(attempt.fired),
                                 attempt.samples.end(), [](const auto& sample) { return sample.depth_mm <= 51.0; });
  puncture.actions = {{back->time_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBile, 1.0}, {}, 51.0}};
  EXPECT_NEAR(part(puncture.score(attempt), "target").value, 0.0, 0.1);
}

TEST(Puncture, TheNearestExpertPathCounts) {
  BoxCase puncture = make_puncture();
  const Vec3 beside_P(14.0, 0.0, 0.0);
  tasks::PlannedPath other = make_box_plan();
  other.line_P = shifted(beside_P);
  puncture.experts.push_back(other);
  const Outcome outcome = puncture.score(make_attempt(shifted(beside_P)));
  EXPECT_EQ(outcome.expert, 1U);
  EXPECT_NEAR(part(outcome, "entry").value, 0.0, 0.1);
  EXPECT_NEAR(part(outcome, "target").value, 0.0, 0.1);
  EXPECT_EQ(puncture.score(make_attempt(make_box_plan().line_P)).expert, 0U);
}

TEST(Puncture, PainIsCountedOnceAContact) {
  BoxCase puncture = make_puncture();
  puncture.task.pain = {{"bone"}, true};
  puncture.task.weights = {{"target", 50.0}, {"comfort", 50.0}};
  const Attempt attempt = make_attempt({{50.0, 0.0, 75.0}, {50.0, 15.0, 75.0}});  // onto the rib
  EXPECT_EQ(puncture.score(attempt).pain_events, 2U) << "the skin, then the rib";
  puncture.actions = {{0.0, tasks::ActionKind::kAnaesthetise, 5.0, {}, {}, 0.0}};
  const Outcome numb = puncture.score(attempt);
  EXPECT_EQ(numb.pain_events, 1U);
  EXPECT_NEAR(part(numb, "comfort").points, 25.0, 1e-9);
  EXPECT_TRUE(has_hint(numb, "The tip met the right rib 9"));
  puncture.actions[0].time_s = 1e3;  // after the puncture
  EXPECT_EQ(puncture.score(attempt).pain_events, 2U);
}

TEST(Puncture, AnySafeWayIsWorthTheWholeAccess) {
  BoxCase puncture = make_puncture();
  puncture.task.weights = {{"target", 20.0}, {"access", 80.0}};
  puncture.task.min_organ_path_mm = 0.0;
  const auto access_of = [&](double x_mm) {
    const double off_mm = x_mm - 50.0;
    return part(puncture.score(make_attempt(shifted({off_mm, 0.0, 0.0}))), "access");
  };
  EXPECT_NEAR(access_of(50.0).points, 80.0, 1e-9);
  EXPECT_NEAR(access_of(60.0).points, 80.0, 1e-9) << "10 mm beside the plan, but safe";
  // The vessel from x = 20 to 25 needs 5 mm.
  EXPECT_NEAR(access_of(31.0).points, 80.0, 1e-9);
  double before = 80.0;
  for (const double x_mm : {29.0, 28.0, 27.0, 26.0}) {
    const ScorePart now = access_of(x_mm);
    EXPECT_NEAR(now.value, 5.0 - (x_mm - 25.0), 0.6) << "half a voxel";
    EXPECT_LT(now.points, before);
    before = now.points;
  }
}

TEST(Puncture, PartsThatCannotBeJudgedLeaveTheirPointsToTheOthers) {
  BoxCase puncture = make_puncture();
  puncture.task.weights = {{"target", 60.0}, {"visibility", 40.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  EXPECT_EQ(puncture.score(attempt).parts.size(), 1U);
  EXPECT_NEAR(puncture.score(attempt).score, 100.0, 1e-6);
  puncture.tip_visible_share = 0.5;
  EXPECT_NEAR(puncture.score(attempt).score, 80.0, 1e-6);
  EXPECT_TRUE(has_hint(puncture.score(attempt), "50 % of the advance"));
}

}  // namespace
}  // namespace trocar::scoring
