#include "results/validity.h"

#include "results/test/small_study.h"

namespace trocar::results {
namespace {

class CohortDataTest : public SmallStudy {};
TROCAR_BOTH_DATABASES(CohortDataTest);
class ValidityTest : public SmallStudy {};
TROCAR_BOTH_DATABASES(ValidityTest);

TEST_P(CohortDataTest, AveragesEachPerson) {
  const Person expert = add("Expert", Group::kExpert), novice = add_simulated("Novice", Group::kTrainee);
  add("Without attempts", Group::kTrainee);
  play(novice, 20.0);
  play(expert, 90.0);
  play(novice, std::nullopt);
  play(novice, 40.0);
  play(expert, 100.0);
  play(expert, 10.0, "lumbar-puncture");
  const auto data = cohort_data(*repository_, {"liver-biopsy"});
  ASSERT_TRUE(data) << data.error().text();
  ASSERT_EQ(data->people.size(), 2u);
  const std::size_t e = data->people[0].is_expert ? 0 : 1, n = 1 - e;
  EXPECT_TRUE(data->people[e].is_expert);
  EXPECT_FALSE(data->people[e].is_simulated);
  EXPECT_TRUE(data->people[n].is_simulated);
  EXPECT_EQ(data->scores[e], 95.0);
  EXPECT_EQ(data->scores[n], 30.0);
  EXPECT_EQ(data->people[n].attempts, 3u);
  EXPECT_EQ(data->people[n].unscored, 1u);
  EXPECT_EQ(data->pass_shares[n], 0.0);
  EXPECT_EQ(data->pass_shares[e], 1.0);
  ASSERT_EQ(data->metrics.size(), 2u);
  EXPECT_EQ(data->metrics[0].title, "Path length of the tip");
  EXPECT_EQ(data->metrics[0].better, cohort::Better::kLower);
  EXPECT_EQ(data->metrics[0].values[e], 105.0);
  EXPECT_EQ(data->metrics[1].name, "of_tomorrow") << "a metric that this program does not know";
  EXPECT_EQ(data->metrics[1].better, cohort::Better::kNeither);
  ASSERT_EQ(data->items[n].size(), 2u);
  EXPECT_DOUBLE_EQ(*data->items[n][0], 18.0);
}

TEST_P(CohortDataTest, ChoosesAttemptsOfEachPerson) {
  const Person novice = add("Novice", Group::kTrainee), other = add("Other", Group::kTrainee);
  play(novice, 10.0);
  play(other, 50.0);
  play(novice, std::nullopt);
  play(novice, 20.0);
  play(novice, 60.0);
  const auto second_and_third = cohort_data(*repository_, {"liver-biopsy", "", {2, 3}});
  ASSERT_TRUE(second_and_third) << second_and_third.error().text();
  ASSERT_EQ(second_and_third->people.size(), 1u) << "the other has no second attempt";
  EXPECT_EQ(second_and_third->scores[0], 20.0) << "the second has no result";
  EXPECT_EQ(second_and_third->people[0].attempts, 2u);
  EXPECT_EQ(second_and_third->metrics[0].values[0].has_value(), true);
}

TEST_P(CohortDataTest, FiltersByCaseAndLevel) {
  const Person novice = add("Novice", Group::kTrainee, "Spring");
  const auto put_at = [&](const std::string& patient, const std::string& level, double score) {
    AttemptRecord record = attempt(novice.id, score);
    record.attempt.the_case.patient = patient;
    record.attempt.level = level;
    put(record);
  };
  put_at("biopsy-1", "guided", 10.0);
  put_at("biopsy-2", "guided", 30.0);
  put_at("biopsy-2", "exam", 50.0);
  put_at("biopsy-2", "exam", 70.0);
  const auto score_of = [&](const EvidenceFilter& filter) {
    const auto data = cohort_data(*repository_, filter);
    EXPECT_TRUE(data) << data.error().text();
    return data->scores.empty() ? std::optional<double>() : data->scores[0];
  };
  EXPECT_EQ(score_of({"liver-biopsy", "", {}, "biopsy-2"}), 50.0);
  EXPECT_EQ(score_of({"liver-biopsy", "", {}, "", "guided"}), 20.0);
  EXPECT_EQ(score_of({"liver-biopsy", "spring", {2, 2}, "biopsy-2", "exam"}), 70.0) << "counted within the filter";
  EXPECT_EQ(score_of({"liver-biopsy", "", {}, "biopsy-1", "exam"}), std::nullopt);
  EXPECT_EQ(score_of({"liver-biopsy", "", {}, "' OR '1' = '1"}), std::nullopt);
  const auto choices = evidence_choices(*repository_, "liver-biopsy");
  ASSERT_TRUE(choices) << choices.error().text();
  EXPECT_EQ(choices->patients, (std::vector<std::string>{"biopsy-1", "biopsy-2"}));
  EXPECT_EQ(choices->levels, (std::vector<std::string>{"exam", "guided"}));
  EXPECT_EQ(count_attempts(*repository_, {{}, "liver-biopsy", {}, "biopsy-2", "exam"})->counted(), 2);
}

TEST_P(CohortDataTest, CountsAttemptsWithoutAResultAsFailed) {
  const Person expert = add("Expert", Group::kExpert), novice = add("Novice", Group::kTrainee);
  for (int n = 0; n < 3; ++n) play(expert, 90.0);
  play(novice, 95.0);
  play(novice, std::nullopt);
  play(novice, std::nullopt);
  play(novice, 95.0);
  const auto validity = validity_of(*repository_, {"liver-biopsy"});
  ASSERT_TRUE(validity) << validity.error().text();
  EXPECT_EQ(validity->novice_attempts, 3u);
  EXPECT_EQ(validity->novice_unscored, 2u);
  EXPECT_EQ(validity->expert_unscored, 0u);
  EXPECT_EQ(validity->score.separation->auc, 0.0) << "the one scored attempt is better";
  EXPECT_EQ(validity->passes.separation->auc, 1.0);
  EXPECT_DOUBLE_EQ(validity->passes.separation->novice_median, 1.0 / 3.0);
}

TEST_P(CohortDataTest, FiltersByCourse) {
  play(add("A", Group::kTrainee, "Spring"), 50.0);
  play(add("B", Group::kTrainee, "Autumn"), 70.0);
  const auto data = cohort_data(*repository_, {"liver-biopsy", "spring"});
  ASSERT_TRUE(data) << data.error().text();
  ASSERT_EQ(data->people.size(), 1u);
  EXPECT_EQ(data->scores[0], 50.0);
  EXPECT_TRUE(cohort_data(*repository_, {"liver-biopsy", "Winter"})->people.empty());
}

TEST_P(ValidityTest, EvaluatesAStudyInTheDatabase) {
  for (const double score : {95.0, 92.0}) play(add(fmt::format("E{}", score), Group::kExpert), score);
  for (int n = 0; n < 12; ++n) play(add(fmt::format("N{}", n), Group::kTrainee), 30.0 + 3.0 * n);
  const auto validity = validity_of(*repository_, {"liver-biopsy"});
  ASSERT_TRUE(validity) << validity.error().text();
  EXPECT_EQ(validity->experts, 2u);
  EXPECT_EQ(validity->novices, 12u);
  EXPECT_EQ(validity->simulated, 0u);
  EXPECT_EQ(validity->score.separation->auc, 1.0);
  EXPECT_EQ(validity->tested, 2u);
  EXPECT_EQ(validity->discriminating, 1u) << "the path length; the other metric is the same for all";
  EXPECT_GT(validity->alpha->value, 0.9);
  ASSERT_TRUE(validity->pass_mark) << validity->pass_mark.error().text();
  EXPECT_EQ(validity->pass_mark->false_fails + validity->pass_mark->false_passes, 0u);
}

TEST_P(CohortDataTest, ExcludesSimulatedPeopleIfBothGroupsAreReal) {
  play(add_simulated("simulated expert 1", Group::kExpert), 100.0);
  play(add_simulated("simulated novice 1", Group::kTrainee), 10.0);
  play(add("Novice", Group::kTrainee), 50.0);
  const auto without_experts = cohort_data(*repository_, {"liver-biopsy"});
  ASSERT_TRUE(without_experts) << without_experts.error().text();
  EXPECT_EQ(without_experts->people.size(), 3u) << "no real expert";
  play(add("Expert", Group::kExpert), 90.0);
  const auto data = cohort_data(*repository_, {"liver-biopsy"});
  ASSERT_EQ(data->people.size(), 2u);
  EXPECT_FALSE(data->people[0].is_simulated || data->people[1].is_simulated);
  EXPECT_EQ(*data->scores[0] + *data->scores[1], 140.0);
  ASSERT_EQ(data->metrics[0].values.size(), 2u);
  EXPECT_EQ(data->items.size(), 2u);
}

TEST_P(ValidityTest, IsEmptyForAnUnknownTask) {
  const auto validity = validity_of(*repository_, {"'; DROP TABLE people; --"});
  ASSERT_TRUE(validity) << validity.error().text();
  EXPECT_EQ(validity->experts + validity->novices, 0u);
  EXPECT_FALSE(validity->pass_mark);
  EXPECT_TRUE(list_people(*repository_));
}

}  // namespace
}  // namespace trocar::results
