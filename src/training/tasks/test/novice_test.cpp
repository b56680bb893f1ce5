#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tasks/operator.h"
#include "tasks/testing/box_patient.h"
#include "tasks/testing/layered_body.h"

namespace trocar::tasks {
namespace {

using testing::BoxPatient;
using testing::LayeredBody;
using testing::skin_muscle_capsule;

constexpr double kPath_mm = 60.0;

/// A puncture whose place is proven by spinal fluid.
OperatorCase puncture(std::uint64_t seed) {
  const Vec3 axis_P = Vec3(0.1, -0.9, 0.2).normalized();
  OperatorCase the_case{{Vec3(0.0, 90.0, 0.0), Vec3(0.0, 90.0, 0.0) + kPath_mm * axis_P}, false, seed, {}};
  the_case.actions.confirms = ActionKind::kDrawStylet;
  the_case.actions.awaited = Substance::kCsf;
  return the_case;
}

LayeredBody run_in_body(const OperatorCase& the_case, double csf_from_mm, double csf_to_mm) {
  LayeredBody body(the_case.path_P, skin_muscle_capsule(), 0.001);
  body.csf_from_mm = csf_from_mm;
  body.csf_to_mm = csf_to_mm;
  body.run(*make_novice(the_case), 60.0);
  return body;
}

std::vector<Action> looks_of(const LayeredBody& body) {
  std::vector<Action> looks;
  std::copy_if(body.actions.begin(), body.actions.end(), std::back_inserter(looks),
               [](const Action& action) { return action.kind == ActionKind::kDrawStylet; });
  return looks;
}

TEST(Novice, ChecksEveryTwoMillimetresAndStopsAtTheFluid) {
  std::size_t forgot = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const LayeredBody body = run_in_body(puncture(seed), kPath_mm - 4.0, kPath_mm + 20.0);
    EXPECT_TRUE(body.is_done) << seed;
    const std::vector<Action> looks = looks_of(body);
    if (looks.empty()) {
      ++forgot;
      continue;
    }
    EXPECT_EQ(looks.back().result.substance, Substance::kCsf) << seed;
    for (std::size_t n = 0; n + 1 < looks.size(); ++n) {
      EXPECT_EQ(looks[n].result.substance, Substance::kNothing) << seed;
      const double deeper_mm = looks[n + 1].depth_mm - looks[n].depth_mm;
      if (deeper_mm < -2.0) continue;  // another way
      EXPECT_NEAR(deeper_mm, 2.0, 1.6) << seed << ": braking and tremor";
    }
    if (looks.size() > 1) {
      EXPECT_LT(looks.back().depth_mm, kPath_mm - 4.0 + 2.8) << seed << ": not far behind the membrane";
    }
  }
  EXPECT_GE(forgot, 1u);  // one of ten forgets to look
  EXPECT_LE(forgot, 8u);
}

TEST(Novice, ReplacesTheStyletBeforeAdvancing) {
  const LayeredBody body = run_in_body(puncture(1), kPath_mm, kPath_mm + 20.0);
  bool is_out = false;
  for (const Action& action : body.actions) {
    if (action.kind == ActionKind::kDrawStylet) {
      EXPECT_FALSE(is_out);
    }
    is_out = action.kind == ActionKind::kDrawStylet;
  }
}

TEST(Novice, TriesTwoOtherPathsWithoutReturnThenEnds) {
  const OperatorCase the_case = puncture(1);
  const LayeredBody body = run_in_body(the_case, 0.0, 0.0);
  const std::vector<Action> looks = looks_of(body);
  ASSERT_GT(looks.size(), 6u);
  std::size_t restarts = 0;
  for (std::size_t n = 1; n < looks.size(); ++n) restarts += looks[n].depth_mm < looks[n - 1].depth_mm ? 1 : 0;
  EXPECT_EQ(restarts, 2u);
  EXPECT_TRUE(body.is_done);
}

/// Distance of the line that the novice aims along from the planned entry.
double entry_error_mm(const OperatorCase& the_case) {
  const HandCommand first = make_novice(the_case)->next({});
  const Vec3 axis_P = first.X_PN.R().col(2), plan_axis_P = the_case.path_P.direction();
  const Vec3 away_P = first.X_PN.p() - the_case.path_P.a;
  return (away_P - away_P.dot(plan_axis_P) / axis_P.dot(plan_axis_P) * axis_P).norm();
}

TEST(Novice, EntryErrorScalesWithTheErrorShare) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto with_share = [&](double share) {
      OperatorCase the_case = puncture(seed);
      the_case.error_share = share;
      return entry_error_mm(the_case);
    };
    const double all_mm = with_share(1.0), tremor_mm = 0.6;  // three times its rms
    EXPECT_GT(all_mm, 3.0 - tremor_mm) << seed;
    EXPECT_LT(all_mm, 8.0 + tremor_mm) << seed;
    EXPECT_NEAR(with_share(0.5), 0.5 * all_mm, tremor_mm) << seed;
    EXPECT_LT(with_share(0.0), 0.3) << seed << ": the expert's tremor";
  }
}

TEST(Novice, TargetErrorShrinksWithTheErrorShare) {
  const auto mean_miss_mm = [](double share) {
    double sum_mm = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      OperatorCase the_case = puncture(seed);
      the_case.actions = {};
      the_case.fires_biopsy = true;
      the_case.error_share = share;
      const LayeredBody body = run_in_body(the_case, 0.0, 0.0);
      EXPECT_TRUE(body.is_done) << seed;
      EXPECT_EQ(body.fired.size(), 1u) << seed;
      sum_mm += (body.samples[body.fired.front()].tip_mm - the_case.path_P.b).norm();
    }
    return sum_mm / 20.0;
  };
  double larger_mm = mean_miss_mm(1.0);
  EXPECT_GT(larger_mm, 6.0);
  for (const double share : {0.75, 0.5, 0.25, 0.0}) {
    const double miss_mm = mean_miss_mm(share);
    EXPECT_LT(miss_mm, larger_mm - 1.0) << share;
    larger_mm = miss_mm;
  }
  EXPECT_LT(larger_mm, 2.0) << "the way to stop";
}

TEST(Novice, LandmarkErrorScalesWithTheCoveringFat) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto with_cover = [&](double cover_mm) {
      OperatorCase the_case = puncture(seed);
      the_case.cover_mm = cover_mm;
      return entry_error_mm(the_case);
    };
    const double felt_mm = with_cover(0.0);
    EXPECT_NEAR(with_cover(10.0), felt_mm, 0.05) << seed;
    EXPECT_NEAR(with_cover(40.0), 4.0 * felt_mm, 3.0) << seed << ": and the tremor four times";
    EXPECT_GT(with_cover(40.0), 2.0 * felt_mm) << seed;
  }
}

TEST(LandmarkCover, IsTheFatOverMuscleInALandmarkTask) {
  BoxPatient box;  // 12 mm of fat
  box.spacing_mm = 1.0;
  const anatomy::VirtualPatient patient = box.make();
  Task task;
  task.guidance = ImagingModality::kPalpation;
  const Segment straight{{-40.0, -70.0, 0.0}, {-40.0, -10.0, 0.0}};
  EXPECT_NEAR(landmark_cover_mm(task, patient, straight), 12.0, 1.0);
  const Vec3 slanted_P = Vec3(0.0, 1.0, 1.0).normalized();
  EXPECT_NEAR(landmark_cover_mm(task, patient, {straight.a, straight.a + 60.0 * slanted_P}), 12.0 * std::sqrt(2.0),
              1.5);
  task.guidance = ImagingModality::kUltrasound;
  EXPECT_EQ(landmark_cover_mm(task, patient, straight), 0.0);
  task.landmark_zone.emplace();
  EXPECT_NEAR(landmark_cover_mm(task, patient, straight), 12.0, 1.0);
}

TEST(LastReturn, ComesFromTheLastCheck) {
  std::vector<Action> actions;
  EXPECT_FALSE(last_return(actions));
  actions.push_back({1.0, ActionKind::kAnaesthetise, 5.0, {}, Vec3::Zero(), 0.0});
  EXPECT_FALSE(last_return(actions));
  actions.push_back({2.0, ActionKind::kDrawStylet, 0.0, {Substance::kBlood, 0.3}, Vec3::Zero(), 20.0});
  actions.push_back({3.0, ActionKind::kReplaceStylet, 0.0, {}, Vec3::Zero(), 20.0});
  ASSERT_TRUE(last_return(actions));
  EXPECT_EQ(last_return(actions)->substance, Substance::kBlood);
  actions.push_back({4.0, ActionKind::kAspirate, 0.0, {Substance::kCsf, 1.0}, Vec3::Zero(), 22.0});
  EXPECT_EQ(last_return(actions)->substance, Substance::kCsf);
}

}  // namespace
}  // namespace trocar::tasks
