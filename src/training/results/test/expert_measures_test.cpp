#include <gtest/gtest.h>

#include "small_study.h"

namespace trocar::results {
namespace {

/// SmallStudy: path_length is 200 − score.
TEST(ExpertMeasures, AreThoseOfRealExpertsIfThereAreAny) {
  SmallStudy study;
  const Person simulated = study.add("Simulated expert", Group::kExpert, true);
  study.attempt(simulated, 90.0);
  study.attempt(study.add("Trainee", Group::kTrainee), 10.0);
  const auto of_simulated = expert_measures(study.repository(), "liver-biopsy").value();
  ASSERT_EQ(of_simulated.size(), 2U);
  EXPECT_EQ(of_simulated[1].metric, "path_length");
  EXPECT_EQ(of_simulated[1].values, std::vector<double>{110.0});

  const Person expert = study.add("Expert", Group::kExpert);
  study.attempt(expert, 80.0);
  study.attempt(expert, 70.0);
  study.attempt(expert, std::nullopt);
  study.attempt(expert, 60.0, "lumbar-puncture");
  auto values = expert_measures(study.repository(), "liver-biopsy").value()[1].values;
  std::sort(values.begin(), values.end());
  EXPECT_EQ(values, (std::vector<double>{120.0, 130.0}));
  EXPECT_TRUE(expert_measures(study.repository(), "unknown").value().empty());
}

TEST(TaskSummaries, OfOnePersonAreThoseOfAll) {
  SmallStudy study;
  const Person a = study.add("A", Group::kTrainee), b = study.add("B", Group::kTrainee);
  for (const double score : {50.0, 60.0, 90.0}) study.attempt(a, score);
  study.attempt(b, 10.0);
  const auto all = summarise_tasks(study.repository()).value();
  const auto one = summarise_tasks(study.repository(), a.id).value();
  ASSERT_EQ(all.size(), 2U);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].person_id, a.id);
  EXPECT_EQ(one[0].attempts, 3);
  EXPECT_EQ(one[0].last_score, 90.0);
  EXPECT_TRUE(summarise_tasks(study.repository(), "nobody").value().empty());
}

}  // namespace
}  // namespace trocar::results
