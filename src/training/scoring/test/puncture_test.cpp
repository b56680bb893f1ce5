// Punctures without a gun: what came back, several expert paths, pain, the access as it was.
#include <gtest/gtest.h>

#include <algorithm>

#include "scoring/pain.h"
#include "scoring/test/outcome_support.h"

namespace trocar::scoring {
namespace {

using namespace testing;

TEST(Puncture, CorrectSubstanceConfirmsTheTarget) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  const double at_s = attempt.samples[attempt.fired].time_s;
  const Outcome unproved = puncture.score(attempt);
  EXPECT_FALSE(unproved.target_reached);
  EXPECT_NEAR(unproved.score, 60.0, 1e-6);
  ASSERT_FALSE(unproved.fails.empty());
  EXPECT_EQ(unproved.fails.front(), "position not confirmed: no bile came back");
  EXPECT_TRUE(has_hint(unproved, "remove the stylet at the target and look whether bile comes"));
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

TEST(Puncture, EndsAtTheConfirmedPositionDespiteEarlierDepth) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Segment deep_P{make_box_plan().line_P.a, make_box_plan().line_P.b + Vec3(0.0, 30.0, 0.0)};
  const Attempt attempt = make_attempt(deep_P);  // through the lesion and 11 mm beyond it, then out
  EXPECT_NEAR(part(puncture.score(attempt), "target").value, 11.0, 0.6);
  const auto back = std::find_if(attempt.samples.begin() + static_cast<std::ptrdiff_t>(attempt.fired),
                                 attempt.samples.end(), [](const auto& sample) { return sample.depth_mm <= 51.0; });
  puncture.actions = {{back->time_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBile, 1.0}, {}, 51.0}};
  EXPECT_NEAR(part(puncture.score(attempt), "target").value, 0.0, 0.1);
}

TEST(Puncture, EndsAtTheLastCheckWithoutConfirmation) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 50.0}, {"confirmation", 20.0}, {"length", 10.0}, {"time", 20.0}};
  const Segment plan_P = make_box_plan().line_P;
  std::vector<telemetry::TickSample> samples = make_attempt({plan_P.a, plan_P.b + Vec3(0.0, 30.0, 0.0)}).samples;
  const Attempt again = make_attempt({plan_P.a, plan_P.b - Vec3(0.0, 6.0, 0.0)});
  const double begin_s = samples.back().time_s + 0.001;
  for (telemetry::TickSample sample : again.samples) {
    sample.time_s += begin_s;
    samples.push_back(sample);
  }
  const double look_s = begin_s + again.samples[again.fired].time_s;
  const Outcome no_look = puncture.score(samples, {});
  EXPECT_NEAR(part(no_look, "target").value, 5.0, 0.6) << "5 mm before the lesion, not 11 mm behind it";
  EXPECT_FALSE(part(no_look, "time").is_judged);
  EXPECT_EQ(part(no_look, "time").points, 0.0);
  puncture.actions = {{look_s, tasks::ActionKind::kDrawStylet, 0.0, {}, {}, 45.0}};
  const Outcome looked = puncture.score(samples, {});
  EXPECT_NEAR(part(looked, "target").value, 5.0, 0.6);
  EXPECT_NEAR(part(looked, "length").value, 81.0 + 45.0, 1.0) << "all of the way";
  EXPECT_STREQ(target_words(looked), "missed");
  puncture.actions[0].time_s = samples[samples.size() / 4].time_s;  // early in the first insertion
  EXPECT_NEAR(part(puncture.score(samples, {}), "target").value, 5.0, 0.6) << "the needle went on after it";
}

TEST(Puncture, ReportsAnUnconfirmedTargetAsNotConfirmed) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  EXPECT_STREQ(target_words(puncture.score(attempt)), "not confirmed");
  const double at_s = attempt.samples[attempt.fired].time_s;
  puncture.actions = {{at_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBile, 1.0}, {}, 51.0}};
  EXPECT_STREQ(target_words(puncture.score(attempt)), "reached");
}

TEST(Puncture, UsesTheNearestExpertPath) {
  BoxCase puncture = make_puncture();
  const Vec3 beside_P(14.0, 0.0, 0.0);
  tasks::PlannedPath other = make_box_plan();
  other.line_P = shifted(beside_P);
  puncture.experts.push_back(other);
  const Outcome outcome = puncture.score(make_attempt(shifted(beside_P)));
  EXPECT_EQ(outcome.expert, 1U);
  EXPECT_NEAR(part(outcome, "entry").value, 0.0, 0.1);
  EXPECT_NEAR(part(outcome, "target").value, 6.6, 0.6) << "beside the lesion: the path's end is not the target";
  EXPECT_EQ(puncture.score(make_attempt(make_box_plan().line_P)).expert, 0U);
}

TEST(Puncture, CountsPainOncePerContact) {
  BoxCase puncture = make_puncture();
  puncture.task.pain = {{"bone"}, true};
  puncture.task.weights = {{"target", 50.0}, {"comfort", 50.0}};
  const Attempt attempt = make_attempt({{50.0, 0.0, 75.0}, {50.0, 15.0, 75.0}});  // onto the rib
  EXPECT_EQ(puncture.score(attempt).pain_events, 2U) << "the skin, then the rib";
  puncture.actions = {{0.0, tasks::ActionKind::kAnaesthetise, 5.0, {}, Vec3(50.0, 0.0, 75.0), 0.0}};
  const Outcome numb = puncture.score(attempt);
  EXPECT_EQ(numb.pain_events, 1U);
  EXPECT_NEAR(part(numb, "comfort").points, 25.0, 1e-9);
  EXPECT_TRUE(has_hint(numb, "The needle touched the right rib 9"));
  puncture.actions[0].time_s = 1e3;  // after the puncture
  EXPECT_EQ(puncture.score(attempt).pain_events, 2U);
}

TEST(Puncture, AnaestheticActsOnlyAtItsInjectionSite) {
  BoxCase puncture = make_puncture();
  puncture.task.pain = {{}, true};
  puncture.task.weights = {{"target", 50.0}, {"comfort", 50.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  const auto score_with = [&](double amount_ml, const Vec3& tip_P) {
    puncture.actions = {{0.0, tasks::ActionKind::kAnaesthetise, amount_ml, {}, tip_P, 0.0}};
    return puncture.score(attempt);
  };
  const Vec3 entry_P = make_box_plan().line_P.a;
  EXPECT_EQ(score_with(5.0, entry_P).pain_events, 0U);
  EXPECT_EQ(score_with(5.0, entry_P + Vec3(15.0, -4.0, 0.0)).pain_events, 0U);
  EXPECT_EQ(score_with(0.0, entry_P).pain_events, 1U);
  EXPECT_TRUE(has_hint(score_with(0.0, entry_P), "no anaesthetic was injected"));
  EXPECT_EQ(score_with(5.0, entry_P - Vec3(0.0, 8.0, 0.0)).pain_events, 1U);
  EXPECT_TRUE(has_hint(score_with(5.0, entry_P - Vec3(0.0, 8.0, 0.0)), "injected into the air"));
  EXPECT_EQ(score_with(5.0, entry_P + Vec3(30.0, 0.0, 0.0)).pain_events, 1U);
  EXPECT_TRUE(has_hint(score_with(5.0, entry_P + Vec3(30.0, 0.0, 0.0)), "more than 20 mm beside"));
}

TEST(Puncture, TouchingTheSkinDoesNotHurt) {
  BoxCase puncture = make_puncture();
  puncture.task.pain = {{}, true};
  Attempt attempt = make_attempt(make_box_plan().line_P);
  attempt.samples.resize(270);  // pressed, not pierced
  PainWatch watch(puncture.task, patient());
  for (const telemetry::TickSample& sample : attempt.samples) EXPECT_FALSE(watch.step(sample));
}

TEST(Puncture, ShotBeforeSkinPunctureDoesNotEnd) {
  BoxCase made;
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  const Outcome once = made.score(attempt.samples, {attempt.fired});
  for (const std::size_t early : {std::size_t{0}, std::size_t{265}}) {  // in the air, and on the dented skin
    const Outcome outcome = made.score(attempt.samples, {early, attempt.fired});
    EXPECT_TRUE(outcome.is_scored()) << early;
    EXPECT_EQ(outcome.cores.size(), 1U);
    EXPECT_EQ(outcome.score, once.score) << "this task has no part for needless shots";
    EXPECT_EQ(made.score(attempt.samples, {early}).not_scored, "the gun was fired only outside the body");
  }
}

TEST(Puncture, UnnecessaryShotsCostPoints) {
  BoxCase made;
  made.task.weights = {{"core", 50.0}, {"passes", 50.0}};
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  double before = made.score(attempt.samples, {attempt.fired}).score;
  EXPECT_NEAR(before, 100.0, 1e-6);
  std::vector<std::size_t> shots{attempt.fired};
  for (int n = 1; n < 12; ++n) {
    shots.push_back(attempt.fired + static_cast<std::size_t>(n));
    const Outcome now = made.score(attempt.samples, shots);
    EXPECT_LT(now.score, before) << n;
    before = now.score;
  }
  EXPECT_LT(before, 51.0);
  EXPECT_TRUE(has_hint(made.score(attempt.samples, shots), "The gun was fired 12 times for 1 core"));
}

TEST(Puncture, TargetNeedsAPiercedWall) {
  // The tip presses 4 mm into the wall of the lesion: it is at the planned place, and in front of the lesion.
  BoxCase puncture = make_puncture();
  puncture.task.weights = {{"target", 100.0}};
  Attempt attempt = make_attempt(make_box_plan().line_P);
  attempt.samples.resize(attempt.fired + 1);
  EXPECT_TRUE(puncture.score(attempt.samples, {}).target_reached);
  attempt.samples.back().phase = telemetry::InsertionPhase::kLoading;
  attempt.samples.back().layer_displacement_mm = 4.0;
  const Outcome pressed = puncture.score(attempt.samples, {});
  EXPECT_FALSE(pressed.target_reached);
  EXPECT_GT(part(pressed, "target").value, 2.5);
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 50.0}, {"confirmation", 50.0}};
  attempt.samples.back().layer_displacement_mm = 1.3;  // less than 1 mm before the lesion
  const Outcome unproven = puncture.score(attempt.samples, {});
  EXPECT_TRUE(has_hint(unproven, "had not given way: advance until it does, then remove the stylet"));
  EXPECT_STREQ(target_words(unproven), "not reached");
}

TEST(Puncture, BileFromBehindTheTipDoesNotMoveTheTarget) {
  BoxCase puncture = make_puncture();
  puncture.task.confirmed_by = tasks::Substance::kBile;
  puncture.task.weights = {{"target", 60.0}, {"confirmation", 40.0}};
  const Segment plan_P = make_box_plan().line_P;
  const Attempt attempt = make_attempt({plan_P.a, plan_P.b + Vec3(0.0, 22.0, 0.0)});  // 3 mm beyond the lesion
  const double at_s = attempt.samples[attempt.fired].time_s;
  puncture.actions = {{at_s, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kBile, 0.4}, {}, 73.0}};
  const Outcome outcome = puncture.score(attempt);
  EXPECT_TRUE(outcome.target_reached);
  EXPECT_NEAR(part(outcome, "target").value, 3.0, 0.6);
}

TEST(Puncture, AnySafePathScoresFullAccess) {
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

TEST(Puncture, RedistributesPointsOfUnscoredParts) {
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
