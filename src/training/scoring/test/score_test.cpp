#include "scoring/score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scoring/test/outcome_support.h"
#include "tasks/testing/layered_body.h"

namespace trocar::scoring {
namespace {

using namespace testing;

Outcome score(const std::vector<telemetry::TickSample>& samples, std::optional<std::size_t> fired) {
  return BoxCase().score(samples, fired ? std::vector<std::size_t>{*fired} : std::vector<std::size_t>{});
}
Outcome score(const Segment& line_P) {
  return BoxCase().score(make_attempt(line_P));
}

TEST(Score, PlannedAttemptScoresFully) {
  const Outcome outcome = score(make_box_plan().line_P);
  EXPECT_GT(outcome.score, 99.5);  // 2.5 s of 120 s
  EXPECT_TRUE(outcome.target_reached);
  ASSERT_TRUE(outcome.best_core() != nullptr);
  EXPECT_NEAR(outcome.best_core()->target_mm, 17.0, 0.5);
  ASSERT_EQ(outcome.hints.size(), 1u);
  EXPECT_EQ(outcome.hints[0].text.rfind("Well done", 0), 0u) << outcome.hints[0].text;
}

TEST(Score, PartsSumTo100AndToTheScore) {
  for (const bool is_biopsy : {true, false}) {
    const BoxCase made = is_biopsy ? BoxCase() : make_puncture();
    const Outcome outcome = made.score(make_attempt(shifted({2.0, 0.0, 1.0})));
    double points = 0.0;
    double max_points = 0.0;
    for (const ScorePart& one : outcome.parts) {
      points += one.points;
      max_points += one.max_points;
    }
    EXPECT_NEAR(max_points, 100.0, 1e-9);
    EXPECT_NEAR(points, outcome.score, 1e-9);
    EXPECT_EQ(outcome.best_core() != nullptr, is_biopsy);
  }
}

TEST(Score, DoseCostsPointsOnlyIfTheTaskLimitsIt) {
  BoxCase made = make_puncture();
  made.xray.beam_s = 1.0;
  const Attempt attempt = make_attempt(make_box_plan().line_P);
  const auto score_with = [&](double dose_gycm2) {
    made.xray.dose_area_gycm2 = dose_gycm2;
    return made.score(attempt);
  };
  EXPECT_EQ(score_with(100.0).score, score_with(0.0).score);
  made.task.dose_limit_gycm2 = 8.0;
  made.task.weights["target"] = 15.0;
  made.task.weights["dose"] = 10.0;
  double before = score_with(0.0).score;
  EXPECT_GT(before, 99.5);
  EXPECT_FALSE(has_hint(score_with(0.0), "dose"));
  for (const double dose_gycm2 : {1.0, 4.0, 7.9}) {
    const Outcome now = score_with(dose_gycm2);
    EXPECT_LT(now.score, before);
    EXPECT_EQ(has_hint(now, "dose-area product"), dose_gycm2 > 2.0) << dose_gycm2;
    double max_points = 0.0;
    for (const ScorePart& one : now.parts) max_points += one.max_points;
    EXPECT_NEAR(max_points, 100.0, 1e-9);
    before = now.score;
  }
  EXPECT_NEAR(score_with(80.0).score, score_with(0.0).score - 100.0 / 7.5, 1e-9);  // 10 of 75: there is no core
}

TEST(Score, CloserIsNeverWorse) {
  const Vec3 ways[] = {Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ(), Vec3(0.6, 0.0, -0.8)};
  for (const Vec3& way_P : ways) {
    Outcome before = score(make_box_plan().line_P);
    for (double off_mm = 0.5; off_mm < 16.0; off_mm += 0.5) {
      const Outcome now = score(shifted(off_mm * way_P));
      EXPECT_LE(now.score, before.score + 1e-9) << off_mm << " mm towards " << way_P.transpose();
      EXPECT_GT(now.score, before.score - 15.0) << "a jump at " << off_mm;
      before = now;
    }
  }
}

TEST(Score, EachPartDependsOnItsOwnDeviationOnly) {
  const Outcome off_entry = score({{54.0, 0.0, 50.0}, {50.0, 51.0, 50.0}});
  EXPECT_NEAR(part(off_entry, "entry").points, 10.0 / (1.0 + 0.16), 0.01);
  EXPECT_EQ(part(off_entry, "target").value, 0.0) << "the notch is in the lesion";
  const Outcome shallow = score({{50.0, 0.0, 50.0}, {50.0, 48.0, 50.0}});
  EXPECT_NEAR(part(shallow, "entry").points, 10.0, 0.01);
}

TEST(Score, HarmCostsPointsByGrade) {
  const Outcome rib = score({{50.0, 0.0, 75.0}, {50.0, 15.0, 75.0}});
  EXPECT_EQ(rib.risks_touched, std::vector<std::string>{"rib_right_9"});
  EXPECT_NEAR(part(rib, "risk").points, 12.0, 1e-9);
  EXPECT_TRUE(has_hint(rib, "right rib 9")) << rib.hints[0].text;
  // The stylet alone reaches the vessel.
  const Outcome throw_only = score({{50.0, 0.0, 20.0}, {39.0, 30.0, 20.0}});
  ASSERT_TRUE(throw_only.best_core() != nullptr);
  EXPECT_TRUE(throw_only.risks_touched.empty());
  const Outcome vessel = score({{50.0, 0.0, 20.0}, {30.0, 30.0, 20.0}});
  EXPECT_EQ(vessel.risks_touched, std::vector<std::string>{"portal_vein"});
  EXPECT_NEAR(part(vessel, "risk").points, 0.0, 1e-9);
  EXPECT_TRUE(has_hint(vessel, "mm into the portal vein"));
}

TEST(Score, TargetPointsFallWithDistanceOutsideTheLesion) {
  // Short of the target along the path: the notch's middle leaves the lesion (10 mm in radius) after 10.5 mm.
  const auto points_at = [](double short_mm) {
    return part(score({{50.0, 0.0, 50.0}, {50.0, 51.0 - short_mm, 50.0}}), "target").points;
  };
  for (const double short_mm : {0.0, 5.0, 10.0}) EXPECT_NEAR(points_at(short_mm), 25.0, 1e-6) << short_mm;
  EXPECT_NEAR(points_at(15.5), 12.5, 0.7);
  double before = points_at(10.0);
  for (double short_mm = 11.0; short_mm <= 35.0; short_mm += 1.0) {
    const double now = points_at(short_mm);
    EXPECT_LT(now, before - 0.04) << short_mm;
    before = now;
  }
}

TEST(Score, CriticalTouchFailsAndNoPartIsNegative) {
  BoxCase made;
  const Attempt attempt = make_attempt({{50.0, 0.0, 75.0}, {50.0, 15.0, 75.0}});
  for (const bool is_critical : {false, true}) {
    made.task.risks[1].harm = is_critical ? tasks::Harm::kCritical : tasks::Harm::kMinor;
    const Outcome outcome = made.score(attempt);
    EXPECT_NEAR(part(outcome, "risk").points, is_critical ? 0.0 : 12.0, 1e-9);
    double points = 0.0;
    for (const ScorePart& one : outcome.parts) {
      points += one.points;
      EXPECT_GE(one.points, 0.0) << one.name;
    }
    EXPECT_NEAR(points, outcome.score, 1e-9);
    EXPECT_FALSE(outcome.is_passed);
    EXPECT_EQ(outcome.fails.front() == "the needle touched the right rib 9", is_critical) << outcome.fails.front();
  }
}

TEST(Score, APassedAttemptHasNoFails) {
  const Outcome good = score(make_box_plan().line_P);
  EXPECT_TRUE(good.is_passed);
  EXPECT_TRUE(good.fails.empty());
  const Outcome far = score(shifted({20.0, 0.0, 0.0}));
  EXPECT_FALSE(far.is_passed);
  EXPECT_EQ(far.fails.front(), "the target was not reached: the cores hold 0 mm of it, one can hold 17 mm");
}

TEST(Score, ReachesALesionAnywhereButAnOrganOnlyAsPlanned) {
  // A long lesion is reached anywhere in it; healthy organ is everywhere, and only the planned place counts.
  anatomy::VirtualPatient long_lesion = make_box_patient();
  for (std::size_t i = 0; i < long_lesion.labels.voxels.size(); ++i)
    if (long_lesion.labels.voxels[i] == 3) long_lesion.labels.voxels[i] = 4;
  const anatomy::VirtualPatient healthy = make_box_patient(false);
  const auto is_reached = [](const anatomy::VirtualPatient& who, double short_mm) {
    const Outcome outcome =
        BoxCase{.who = &who}.score(make_attempt({{50.0, 0.0, 50.0}, {50.0, 51.0 - short_mm, 50.0}}));
    EXPECT_GT(outcome.best_core()->target_mm, 16.0) << short_mm;
    return outcome.target_reached;
  };
  EXPECT_TRUE(is_reached(long_lesion, 4.0));
  EXPECT_TRUE(is_reached(long_lesion, 9.0));
  EXPECT_TRUE(is_reached(long_lesion, 12.0));
  EXPECT_TRUE(is_reached(long_lesion, 19.0));
  EXPECT_TRUE(is_reached(healthy, 4.0));
  EXPECT_FALSE(is_reached(healthy, 9.0));  // liver is all around: a core of it does not tell the place
}

TEST(Score, NoviceScoresLowerThanTheExpert) {
  const auto score_of = [](auto make_operator, std::uint64_t seed) {
    const tasks::OperatorCase the_case{make_box_plan().line_P, true, seed};
    LayeredBody body(the_case.path_P, {{0.0, 4.5, 2.8}, {10.0, 2.8, 2.5}, {20.0, 2.7, 1.5}}, 0.001);
    body.run(*make_operator(the_case), 60.0);
    return score(body.samples, body.fired.empty() ? std::nullopt : std::optional(body.fired[0])).score;
  };
  double novices = 0.0;
  int clearly_worse = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double expert = score_of(tasks::make_expert, seed);
    const double novice = score_of(tasks::make_novice, seed);
    EXPECT_GT(expert, 95.0) << seed;
    EXPECT_LT(novice, expert) << seed;
    clearly_worse += novice < expert - 5.0 ? 1 : 0;
    novices += novice / 20.0;
  }
  EXPECT_GE(clearly_worse, 12);  // some novices are skilled, and this lesion is large
  EXPECT_LT(novices, 95.0);
}

TEST(Score, HandlesUnfinishedAttempts) {
  EXPECT_EQ(score(std::vector<telemetry::TickSample>{}, {}).score, 0.0);
  EXPECT_EQ(score(std::vector<telemetry::TickSample>{}, {}).not_scored, "the needle never touched the skin");
  EXPECT_TRUE(has_hint(score(std::vector<telemetry::TickSample>{}, {}), "never reached the skin"));

  const std::vector<telemetry::TickSample> whole = make_attempt(make_box_plan().line_P).samples;
  const std::vector<telemetry::TickSample> loading(whole.begin(), whole.begin() + 270);
  EXPECT_EQ(score(loading, {}).score, 0.0);
  EXPECT_EQ(score(loading, {}).not_scored, "the needle did not pierce the skin");
  EXPECT_TRUE(has_hint(score(loading, {}), "skin was not pierced"));

  for (const std::size_t ticks : {400u, 1000u, 2000u, 2700u}) {  // killed on the way in
    const std::vector<telemetry::TickSample> killed(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(ticks));
    const Outcome outcome = score(killed, {});
    EXPECT_EQ(outcome.not_scored, "the gun was not fired");
    EXPECT_EQ(outcome.score, 0.0);
    EXPECT_TRUE(outcome.parts.empty());
    EXPECT_FALSE(outcome.target_reached);
    EXPECT_FALSE(outcome.best_core() != nullptr);
    EXPECT_TRUE(has_hint(outcome, "No core was taken"));
  }
  EXPECT_FALSE(score(whole, whole.size() + 5).best_core() != nullptr);
}

TEST(Score, RequiresAShotOnlyWithAGun) {
  const Attempt attempt = make_attempt({{50.0, 0.0, 50.0}, {50.0, 25.0, 50.0}});
  const Outcome unfired = score(attempt.samples, {});
  EXPECT_EQ(unfired.not_scored, "the gun was not fired");
  EXPECT_TRUE(has_hint(unfired, "No core was taken"));
  EXPECT_TRUE(score(attempt.samples, attempt.fired).is_scored());
  const Outcome puncture = make_puncture().score(attempt);
  EXPECT_TRUE(puncture.is_scored());
  EXPECT_GT(puncture.score, 0.0);
}

TEST(Hints, StateTheOffsetOfTheInsertionPoint) {
  const Outcome outcome = score({{56.0, 0.0, 50.0}, {50.0, 51.0, 50.0}});
  EXPECT_TRUE(has_hint(outcome,
                       "The insertion point was 6 mm too far to the patient's left: move the needle 6 mm to the "
                       "patient's right before you insert it."));
  EXPECT_TRUE(has_hint(outcome,
                       "The needle pointed 7° too far to the patient's right: tilt it so that its tip points 7° "
                       "further to the patient's left."));
}

TEST(Hints, StateTheCostliestErrorFirst) {
  // 5 mm beside the path and 25 mm short: the core is lost, worth far more than the entry.
  const Outcome outcome = score({{55.0, 0.0, 50.0}, {55.0, 26.0, 50.0}});
  ASSERT_GE(outcome.hints.size(), 2u);
  EXPECT_NE(outcome.hints[0].text.find("The core missed the lesion"), std::string::npos) << outcome.hints[0].text;
  EXPECT_NE(outcome.hints[0].text.find("25 mm short"), std::string::npos) << outcome.hints[0].text;
  EXPECT_NE(outcome.hints[0].text.find("advance 25 mm further"), std::string::npos) << outcome.hints[0].text;
}

TEST(Hints, DoNotSendTheNeedleThroughBone) {
  const Outcome outcome = score({{50.0, 0.0, 75.0}, {50.0, 10.5, 75.0}});
  EXPECT_TRUE(has_hint(outcome, "No tissue was taken: the stylet hit bone"));
  EXPECT_FALSE(has_hint(outcome, "advance"));
}

TEST(Hints, DistinguishOvershootFromRetraction) {
  const Outcome deep = score({{50.0, 0.0, 50.0}, {50.0, 73.0, 50.0}});
  EXPECT_TRUE(has_hint(deep, "stop 22 mm earlier")) << deep.hints.front().text;
  EXPECT_FALSE(has_hint(deep, "mm deep for a path of")) << "the same advice twice";
  EXPECT_FALSE(has_hint(deep, "pulling back"));

  // In to 45 mm, out to 5 mm, in to the target: 40 mm are travelled twice.
  Attempt attempt = make_attempt(make_box_plan().line_P);
  double time_s = attempt.samples[attempt.fired].time_s;
  const auto sample_at = [&](double depth_mm) {
    telemetry::TickSample sample = attempt.samples[attempt.fired];
    sample.time_s = time_s += 0.001;
    sample.depth_mm = depth_mm;
    sample.tip_mm.y() = depth_mm;
    return sample;
  };
  std::vector<telemetry::TickSample> samples(attempt.samples.begin(),
                                             attempt.samples.begin() + static_cast<std::ptrdiff_t>(attempt.fired));
  for (double depth_mm = 45.0; depth_mm > 5.0; depth_mm -= 0.1) samples.push_back(sample_at(depth_mm));
  for (double depth_mm = 5.0; depth_mm < 51.0; depth_mm += 0.1) samples.push_back(sample_at(depth_mm));
  samples.push_back(sample_at(51.0));
  const Outcome repeated = score(samples, samples.size() - 1);
  EXPECT_TRUE(has_hint(repeated, "46 mm of it after pulling back")) << repeated.hints.back().text;
  EXPECT_TRUE(has_hint(repeated, "need not be corrected inside"));
}

TEST(Hints, StateHowFarShortTheTipStopped) {
  Attempt attempt = make_attempt({{50.0, 0.0, 50.0}, {50.0, 30.0, 50.0}});
  EXPECT_TRUE(has_hint(score(attempt.samples, {}), "The tip stopped 21 mm short of the target."));
}

TEST(Hints, OmitSmallErrors) {
  const Outcome outcome = score(shifted({1.0, 0.0, 0.5}));
  EXPECT_FALSE(has_hint(outcome, "insertion point"));
  EXPECT_FALSE(has_hint(outcome, "pointed"));
}

TEST(Score, FormatsValuesWithTheirUnits) {
  EXPECT_EQ(part_value_text({"target", "", 3.14, "mm", 0.0, 0.0}), "3.1 mm");
  EXPECT_EQ(part_value_text({"time", "", 123.4, "s", 0.0, 0.0}), "123 s");
  EXPECT_EQ(part_value_text({"risk", "", 2.0, "", 0.0, 0.0}), "2");
  EXPECT_EQ(part_value_text({"confirmation", "", 1.0, "", 0.0, 0.0}), "yes");
  EXPECT_EQ(part_value_text({"confirmation", "", 0.0, "", 0.0, 0.0}), "no");
}

TEST(Score, EntryInsideTheZoneScoresFully) {
  const Segment plan_P = make_box_plan().line_P;
  const Segment beside_P{plan_P.a + Vec3(4.0, 0.0, 0.0), plan_P.b + Vec3(4.0, 0.0, 0.0)};
  const Attempt attempt = make_attempt(beside_P);
  const auto entry_points = [&](const tasks::Task& task) {
    const ScorePart entry = part(BoxCase{.task = task}.score(attempt), "entry");
    return entry.points / entry.max_points;
  };
  tasks::Task task = make_box_task();
  EXPECT_LT(entry_points(task), 0.95);
  task.entry_zone = tasks::EntryZone{plan_P.a, 6.0};
  EXPECT_EQ(entry_points(task), 1.0);
  task.entry_zone = tasks::EntryZone{plan_P.a - Vec3(20.0, 0.0, 0.0), 6.0};  // 18 mm outside
  EXPECT_NEAR(entry_points(task), 1.0 / (1.0 + 1.8 * 1.8), 0.01);
}

}  // namespace
}  // namespace trocar::scoring
