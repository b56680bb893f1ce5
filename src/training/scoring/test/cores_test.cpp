// Several cores of a biopsy, punctures of the organ, and the risk of bleeding.
#include <gtest/gtest.h>

#include "scoring/score.h"
#include "scoring/test/outcome_support.h"

namespace trocar::scoring {
namespace {

using testing::make_attempt;
using testing::make_box_plan;

const Segment kPlan_P = make_box_plan().line_P;
const Segment kBesideLesion_P = shifted({-25.0, 0.0, 0.0});

tasks::Task make_core_task(std::size_t cores) {
  tasks::Task task = testing::make_box_task();
  task.cores = cores;
  task.weights = {{"target", 30.0}, {"core", 40.0}, {"passes", 30.0}};
  return task;
}

/// Straight in and out again, one after the other; a shot at the end of each.
struct Punctures {
  std::vector<telemetry::TickSample> samples;
  std::vector<std::size_t> shots;

  void add(const Segment& line_P) {
    const testing::Attempt attempt = make_attempt(line_P);
    const double begin_s = samples.empty() ? 0.0 : samples.back().time_s + 0.001;
    shots.push_back(samples.size() + attempt.fired);
    for (telemetry::TickSample sample : attempt.samples) {
      sample.time_s += begin_s;
      samples.push_back(sample);
    }
  }
};

Punctures punctures_along(const std::vector<Segment>& lines_P) {
  Punctures punctures;
  for (const Segment& line_P : lines_P) punctures.add(line_P);
  return punctures;
}

Outcome score_of_punctures(const Punctures& punctures, const tasks::Task& task, bool is_coaxial) {
  BoxCase made{.task = task};
  made.needle.is_coaxial = is_coaxial;
  return made.score(punctures.samples, punctures.shots);
}

double share(const Outcome& outcome, const std::string& name) {
  return part(outcome, name).points / part(outcome, name).max_points;
}

TEST(Cores, OneOfTwoScoresHalf) {
  Punctures once = punctures_along({kPlan_P});
  const Outcome one = score_of_punctures(once, make_core_task(2), true);
  EXPECT_NEAR(share(one, "core"), 0.5, 1e-9);
  EXPECT_TRUE(has_hint(one, "1 of 2 cores was taken")) << one.hints.front().text;
  EXPECT_TRUE(has_hint(one, "coaxial needle stays in place"));
  EXPECT_TRUE(has_hint(score_of_punctures(once, make_core_task(2), false), "withdraw the needle, load the gun"));

  once.shots.push_back(once.shots.front() + 1);  // loaded and fired again at the same place
  const Outcome two = score_of_punctures(once, make_core_task(2), true);
  EXPECT_NEAR(share(two, "core"), 1.0, 1e-9);
  ASSERT_EQ(two.cores.size(), 2u);
  EXPECT_LT(two.cores[0].time_s, two.cores[1].time_s);
  EXPECT_TRUE(has_hint(two, "Well done"));
}

TEST(Cores, HintNamesAMissingCoreBesideABadOne) {
  const Outcome outcome = score_of_punctures(punctures_along({kBesideLesion_P}), make_core_task(2), true);
  EXPECT_TRUE(has_hint(outcome, "1 of 2 cores was taken"));
  EXPECT_GT(outcome.hints.size(), 1u) << "what was wrong with it, too";
}

TEST(Cores, OffCentreFullCoreIsNotReportedAsMissed) {
  const Outcome outcome = score_of_punctures(punctures_along({shifted({5.0, 0.0, 0.0})}), make_core_task(1), true);
  EXPECT_GT(share(outcome, "core"), 0.8);
  EXPECT_LT(share(outcome, "core"), 1.0);
  EXPECT_TRUE(has_hint(outcome, "The core is complete, but the notch was off the target: the notch lay "));
  EXPECT_FALSE(has_hint(outcome, "missed"));
  EXPECT_FALSE(has_hint(outcome, "holds only"));
}

TEST(Cores, BestCoresCount) {
  const Punctures three = punctures_along({kBesideLesion_P, kPlan_P, kPlan_P});
  const Outcome outcome = score_of_punctures(three, make_core_task(2), true);
  ASSERT_EQ(outcome.cores.size(), 3u);
  EXPECT_EQ(outcome.cores[0].target_mm, 0.0);
  EXPECT_NEAR(share(outcome, "core"), 1.0, 1e-9);
  EXPECT_TRUE(outcome.target_reached);
  EXPECT_NEAR(part(outcome, "target").value, 0.0, 0.1) << "the nearest shot";
  EXPECT_EQ(outcome.best_core()->target_mm, outcome.cores[1].target_mm);
}

TEST(Cores, ShotOutsideTheBodyTakesNoCore) {
  Punctures once = punctures_along({kPlan_P});
  once.shots = {0, once.shots.front(), once.samples.size() + 7};
  EXPECT_EQ(score_of_punctures(once, make_core_task(1), true).cores.size(), 1u);
}

TEST(Passes, EachUnnecessaryPassCostsPoints) {
  const Punctures two = punctures_along({kPlan_P, kPlan_P});
  EXPECT_NEAR(share(score_of_punctures(two, make_core_task(2), false), "passes"), 1.0, 1e-9) << "one a core";
  EXPECT_NEAR(share(score_of_punctures(two, make_core_task(2), true), "passes"), 0.5, 1e-9)
      << "the coaxial needle saves one";
  EXPECT_NEAR(share(score_of_punctures(punctures_along({kPlan_P}), make_core_task(2), true), "passes"), 1.0, 1e-9);
  EXPECT_TRUE(has_hint(score_of_punctures(two, make_core_task(2), true), "was punctured 2 times"));
}

TEST(Bleeding, IsUsualAfterOnePunctureAndRaisedAfterMany) {
  const Outcome once = score_of_punctures(punctures_along({kPlan_P}), make_core_task(1), true);
  ASSERT_TRUE(once.bleeding);
  EXPECT_EQ(once.bleeding->risk, BleedingRisk::kUsual);
  EXPECT_EQ(once.bleeding->passes, 1u);
  EXPECT_TRUE(once.bleeding->reasons.empty());
  const Outcome often = score_of_punctures(punctures_along({kPlan_P, kPlan_P, kPlan_P}), make_core_task(1), true);
  EXPECT_EQ(often.bleeding->risk, BleedingRisk::kRaised);
  EXPECT_EQ(often.bleeding->passes, 3u);
  ASSERT_EQ(often.bleeding->reasons.size(), 1u);
  EXPECT_NE(often.bleeding->reasons[0].find("punctured 3 times"), std::string::npos);
}

TEST(Bleeding, TremorAtTheSurfaceIsOnePuncture) {
  Punctures once = punctures_along({kPlan_P});
  for (std::size_t n = 0; n < once.samples.size(); ++n) once.samples[n].tip_mm.y() += n % 2 == 0 ? 0.5 : -0.5;
  EXPECT_EQ(score_of_punctures(once, make_core_task(1), true).bleeding->passes, 1u);
}

/// The box patient with something else in a slab from y to y + 10 mm.
anatomy::VirtualPatient patient_with(const char* name, const char* tissue, double from_y_mm) {
  anatomy::VirtualPatient made = testing::make_box_patient();
  made.label_table.labels.push_back({7, name, tissue, {}});
  for (std::size_t n = 0; n < made.labels.voxels.size(); ++n) {
    const double y_mm = made.labels.geometry.centre_mm(made.labels.geometry.index_of(n)).y();
    if (y_mm > from_y_mm && y_mm < from_y_mm + 10.0) made.labels.voxels[n] = 7;
  }
  return made;
}

Outcome score_with(const anatomy::VirtualPatient& patient) {
  BoxCase made{.task = make_core_task(1), .who = &patient};
  made.task.target_label = "livertumor1";
  const Punctures once = punctures_along({kPlan_P});
  return made.score(once.samples, once.shots);
}

TEST(Bleeding, LesionWithinTheOrganIsNotANewPass) {
  EXPECT_EQ(score_with(patient_with("livertumor2", "liver_lesion", 30.0)).bleeding->passes, 1u);
  EXPECT_EQ(score_with(patient_with("liver_cyst", "fluid", 30.0)).bleeding->passes, 1u);
  EXPECT_EQ(score_with(patient_with("gallbladder", "gallbladder", 30.0)).bleeding->passes, 2u);
}

TEST(Bleeding, BleedingOrganIsAReason) {
  anatomy::VirtualPatient patient = patient_with("spleen", "spleen", 12.0);
  BoxCase made{.task = make_core_task(1), .who = &patient};
  made.task.risks.push_back({"spleen", "", 5.0, false, tasks::Harm::kCritical});
  const Punctures once = punctures_along({kPlan_P});
  const Outcome outcome = made.score(once.samples, once.shots);
  EXPECT_EQ(outcome.bleeding->risk, BleedingRisk::kHigh);
  EXPECT_NE(outcome.bleeding->reasons.at(0).find("into the spleen"), std::string::npos);
}

TEST(Bleeding, AGrazedVesselIsAReason) {
  const anatomy::VirtualPatient patient = [] {
    anatomy::VirtualPatient made = testing::make_box_patient();
    for (std::size_t n = 0; n < made.labels.voxels.size(); ++n) {
      const Vec3 p_P = made.labels.geometry.centre_mm(made.labels.geometry.index_of(n));
      if ((p_P - Vec3(55.6, 33.0, 50.0)).norm() < 6.0) made.labels.voxels[n] = 5;
    }
    return made;
  }();
  BoxCase made{.task = make_core_task(1), .who = &patient};
  const Punctures once = punctures_along({shifted({0.3, 0.0, 0.0})});
  const Outcome outcome = made.score(once.samples, once.shots);
  ASSERT_EQ(outcome.harms.size(), 1u);
  ASSERT_TRUE(outcome.harms[0].is_graze);
  EXPECT_EQ(outcome.bleeding->risk, BleedingRisk::kRaised);
  EXPECT_NE(outcome.bleeding->reasons.at(0).find("grazed a vessel"), std::string::npos);
}

TEST(Bleeding, IsHighAfterAVesselWasHit) {
  // The vessel lies at x 20 to 25 mm below 20 mm of depth.
  const Outcome outcome = score_of_punctures(punctures_along({shifted({-27.5, 0.0, 0.0})}), make_core_task(1), true);
  ASSERT_TRUE(outcome.bleeding);
  EXPECT_EQ(outcome.bleeding->risk, BleedingRisk::kHigh);
  EXPECT_NE(outcome.bleeding->reasons.at(0).find("hit a vessel"), std::string::npos);
}

TEST(Bleeding, IsNotGradedForAFluidTarget) {
  tasks::Task task = make_core_task(1);
  task.min_organ_path_mm = 0.0;
  const Outcome outcome = score_of_punctures(punctures_along({kPlan_P}), task, true);
  EXPECT_FALSE(outcome.bleeding);
}

TEST(Bleeding, RiskNamesRoundTrip) {
  for (const BleedingRisk risk : {BleedingRisk::kUsual, BleedingRisk::kRaised, BleedingRisk::kHigh})
    EXPECT_EQ(find_bleeding_risk(to_string(risk)), risk);
  EXPECT_FALSE(find_bleeding_risk("huge"));
}

}  // namespace
}  // namespace trocar::scoring
