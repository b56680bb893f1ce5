#include <gtest/gtest.h>

#include <algorithm>

#include "small_study.h"

namespace trocar::results {
namespace {

/// path_length of an attempt is 200 − score.
class MeasuresOfExperts : public SmallStudy {};
TROCAR_BOTH_DATABASES(MeasuresOfExperts);

TEST_P(MeasuresOfExperts, PreferRealExperts) {
  play(add_simulated("Simulated expert", Group::kExpert), 90.0);
  play(add("Trainee"), 10.0);
  const auto values_of = [this] {
    std::vector<double> values;
    const auto measures = expert_measures(*repository_, "liver-biopsy");
    EXPECT_TRUE(measures);
    for (const auto& one : *measures)
      if (one.metric == "path_length") values = one.values;
    std::ranges::sort(values);
    return values;
  };
  EXPECT_EQ(values_of(), std::vector<double>{110.0});

  const Person expert = add("Expert", Group::kExpert);
  play(expert, 80.0);
  play(expert, 70.0);
  play(expert, std::nullopt);
  play(expert, 60.0, "lumbar-puncture");
  EXPECT_EQ(values_of(), std::vector<double>{125.0}) << "an expert counts once";
  const Person second = add("Second expert", Group::kExpert);
  play(second, 100.0);
  EXPECT_EQ(values_of(), (std::vector<double>{100.0, 125.0}));
  const auto others = expert_measures(*repository_, "liver-biopsy", expert.id);
  ASSERT_TRUE(others);
  EXPECT_EQ(others->back().values, std::vector<double>{100.0}) << "compared with the others";
  EXPECT_TRUE(expert_measures(*repository_, "unknown").value().empty());
}

TEST_P(MeasuresOfExperts, MatchWhenFilteredByPerson) {
  const Person a = add("A"), b = add("B");
  for (const double score : {50.0, 60.0, 90.0}) play(a, score);
  play(b, 10.0);
  const auto all = summarise_tasks(*repository_).value();
  const auto one = summarise_tasks(*repository_, a.id).value();
  ASSERT_EQ(all.size(), 2U);
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].person_id, a.id);
  EXPECT_EQ(one[0].counts.counted(), 3);
  EXPECT_EQ(one[0].last_score, 90.0);
  EXPECT_TRUE(summarise_tasks(*repository_, "nobody").value().empty());
}

}  // namespace
}  // namespace trocar::results
