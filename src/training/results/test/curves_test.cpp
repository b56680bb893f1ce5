#include "results/proficiency.h"
#include "results/test/small_study.h"

namespace trocar::results {
namespace {

class LearningCurveTest : public SmallStudy {};
TROCAR_BOTH_DATABASES(LearningCurveTest);

TEST_P(LearningCurveTest, ListsAttemptsInRecordingOrder) {
  const Person person = add("Novice", Group::kTrainee);
  play(person, 40.0);
  play(person, 58.0);
  play(person, std::nullopt);
  play(person, 90.0);
  play(person, 99.0, "lumbar-puncture");
  play(person, std::nullopt, "liver-biopsy", State::kInterrupted);
  const auto curve = learning_curve(*repository_, person, "liver-biopsy", {2, {}});
  ASSERT_TRUE(curve) << curve.error().text();
  ASSERT_EQ(curve->attempts.size(), 4u);
  EXPECT_EQ(curve->attempts[1].moving_mean, 49.0);
  EXPECT_EQ(curve->attempts[3].moving_mean, 74.0);
  EXPECT_EQ(curve->attempts[2].moving_mean, 49.0);
  const double step = curve->cusum.pass_step;
  EXPECT_DOUBLE_EQ(curve->attempts[1].cusum, 2.0 * (1.0 - step));
  EXPECT_DOUBLE_EQ(curve->attempts[2].cusum, 3.0 * (1.0 - step)) << "without a result: not passed";
  EXPECT_DOUBLE_EQ(curve->attempts[3].cusum, 3.0 * (1.0 - step) - step);
  EXPECT_EQ(curve->counts.passed, 1);
  EXPECT_EQ(curve->counts.unscored, 1);
  EXPECT_EQ(curve->counts.lost, 1);
  EXPECT_DOUBLE_EQ(*curve->trend, 50.0 / 3.0);
  EXPECT_FALSE(curve->experts);
  EXPECT_EQ(curve->peers, 0u);
}

TEST_P(LearningCurveTest, ComparesWithRealExpertsAndSimilarPeers) {
  const Person person = add("Novice", Group::kTrainee);
  const Person peer = add("Peer", Group::kTrainee);
  const Person simulated = add_simulated("simulated novice 1", Group::kTrainee);
  const Person robot = add_simulated("simulated expert 1", Group::kExpert);
  play(person, 50.0);
  play(robot, 100.0);
  play(simulated, 10.0);
  play(peer, 60.0);
  play(peer, std::nullopt);
  play(peer, 80.0);
  const auto only_simulated = learning_curve(*repository_, person, "liver-biopsy");
  ASSERT_TRUE(only_simulated) << only_simulated.error().text();
  ASSERT_TRUE(only_simulated->experts);
  EXPECT_TRUE(only_simulated->experts->is_simulated);
  EXPECT_EQ(only_simulated->experts->mean, 100.0);

  const Person first = add("Expert 1", Group::kExpert), second = add("Expert 2", Group::kExpert);
  play(first, 80.0);
  play(first, 90.0);
  play(second, 95.0);
  const auto curve = learning_curve(*repository_, person, "liver-biopsy");
  ASSERT_TRUE(curve && curve->experts);
  EXPECT_FALSE(curve->experts->is_simulated);
  EXPECT_EQ(curve->experts->people, 2u);
  EXPECT_EQ(curve->experts->mean, 90.0);
  EXPECT_EQ(curve->experts->low, 85.0);
  EXPECT_EQ(curve->experts->high, 95.0);
  EXPECT_EQ(curve->peers, 1u);
  ASSERT_EQ(curve->peer_curve.size(), 3u);
  EXPECT_FALSE(curve->peer_curve[1]);
  EXPECT_EQ(curve->peer_curve[2]->mean, 80.0);
  EXPECT_EQ(learning_curve(*repository_, first, "liver-biopsy")->experts->people, 1u) << "without oneself";
}

TEST_P(LearningCurveTest, WithoutAttemptsIsEmpty) {
  const auto curve = learning_curve(*repository_, add("Nobody", Group::kTrainee), "liver-biopsy");
  ASSERT_TRUE(curve) << curve.error().text();
  EXPECT_TRUE(curve->attempts.empty());
  EXPECT_LT(curve->cusum.lower, 0.0);
  EXPECT_TRUE(curve->peer_curve.empty());
}

TEST_P(LearningCurveTest, RefusesInvalidRules) {
  const Person person = add("Novice", Group::kTrainee);
  EXPECT_EQ(learning_curve(*repository_, person, "liver-biopsy", {0, {}}).error().exit_status, 2);
  EXPECT_EQ(learning_curve(*repository_, person, "liver-biopsy", {5, {0.5, 0.2, 0.1, 0.1}}).error().exit_status, 2);
}

}  // namespace
}  // namespace trocar::results
