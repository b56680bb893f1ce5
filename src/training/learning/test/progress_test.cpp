#include "learning/progress.h"

#include <gtest/gtest.h>

#include "learning/test/example_history.h"

namespace trocar::learning {
namespace {

using testing::add;
using testing::attempt;
using testing::day;
using testing::example_curriculum;
using testing::master;
using testing::unscored;

StepProgress step_of(const std::vector<PastAttempt>& history, const std::string& patient, TrainingMode level,
                     int on_day = 0) {
  const Curriculum curriculum = example_curriculum();
  for (const Course& course : curriculum.courses)
    for (const StepProgress& step : progress_of(history, course, curriculum.rules, day(on_day)))
      if (step.exercise.patient == patient && step.exercise.level == level) return step;
  ADD_FAILURE() << "no such step";
  return {};
}

std::chrono::sys_days date(int n) {
  return std::chrono::floor<std::chrono::days>(day(n));
}

TEST(Progress, PassesInARowMasterAStep) {
  std::vector<PastAttempt> history;
  const PastAttempt pass = attempt("biopsy-1", TrainingMode::kGuided, 0);
  add(history, 2, pass);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  history.push_back(attempt("biopsy-1", TrainingMode::kGuided, 0, 90.0, false));
  add(history, 2, pass);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).passes_in_a_row, 2);
  add(history, 1, pass);
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).attempts, 6);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kAssisted).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-2", TrainingMode::kGuided).is_mastered);
}

TEST(Progress, PassBelowTheMasteryScoreResetsTheRow) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0, 79.9));
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).passes_in_a_row, 0);
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0, 80.0));
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
}

TEST(Progress, IgnoresLostUnstartedAndUnlevelledAttempts) {
  std::vector<PastAttempt> history;
  add(history, 2, attempt("biopsy-1", TrainingMode::kGuided, 0));
  for (const Ending ending : {Ending::kLost, Ending::kNeverBegan, Ending::kRunning}) {
    history.push_back(unscored("biopsy-1", TrainingMode::kGuided, 0));
    history.back().ending = ending;
  }
  PastAttempt scripted = attempt("biopsy-1", TrainingMode::kGuided, 0);
  scripted.level.reset();
  history.push_back(scripted);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).attempts, 2);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).passes_in_a_row, 2);
}

TEST(Progress, CountsAnAttemptWithoutAResultAsNotPassed) {
  std::vector<PastAttempt> history;
  add(history, 2, attempt("biopsy-1", TrainingMode::kGuided, 0));
  history.push_back(unscored("biopsy-1", TrainingMode::kGuided, 0));
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).attempts, 3);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).passes_in_a_row, 0);
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  history.push_back(unscored("biopsy-1", TrainingMode::kGuided, 1));
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided, 1).repetition->has_failed);
}

TEST(Progress, ExcellentFirstAttemptMastersUntilAFailure) {
  std::vector<PastAttempt> history{attempt("biopsy-1", TrainingMode::kGuided, 0, 95.0)};
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_tested_out);
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided).repetition->due, date(1));
  history.push_back(attempt("biopsy-1", TrainingMode::kGuided, 1, 60.0));
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided, 1).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided, 1).repetition);
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 1));
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided, 1).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided, 1).is_tested_out);
  // Only the first attempt, and only a pass.
  EXPECT_FALSE(
      step_of({attempt("tap-1", TrainingMode::kGuided, 0, 94.0), attempt("tap-1", TrainingMode::kGuided, 0, 99.0)},
              "tap-1", TrainingMode::kGuided)
          .is_mastered);
  EXPECT_FALSE(
      step_of({attempt("tap-1", TrainingMode::kGuided, 0, 99.0, false)}, "tap-1", TrainingMode::kGuided).is_mastered);
}

TEST(Progress, PassedExamCoversHelpLevelsOfEasierCases) {
  const std::vector<PastAttempt> history{attempt("biopsy-2", TrainingMode::kExam, 0, 80.0)};
  for (const char* patient : {"biopsy-1", "biopsy-2"}) {
    EXPECT_TRUE(step_of(history, patient, TrainingMode::kAssisted).is_tested_out) << patient;
    EXPECT_TRUE(step_of(history, patient, TrainingMode::kGuided).is_mastered) << patient;
    EXPECT_FALSE(step_of(history, patient, TrainingMode::kExam).is_mastered) << patient;
  }
  EXPECT_FALSE(step_of(history, "biopsy-3", TrainingMode::kGuided).is_mastered);
  EXPECT_FALSE(
      step_of({attempt("biopsy-2", TrainingMode::kExam, 0, 79.0)}, "biopsy-2", TrainingMode::kGuided).is_mastered);
}

TEST(Progress, PlateauHasNoSlopeOverTheLastAttempts) {
  std::vector<PastAttempt> history;
  for (int n = 0; n < 9; ++n)
    history.push_back(attempt("biopsy-1", TrainingMode::kGuided, 0, n % 2 == 0 ? 60.0 : 62.0, false));
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided).plateau);
  history.push_back(unscored("biopsy-1", TrainingMode::kGuided, 0));
  const auto plateau = step_of(history, "biopsy-1", TrainingMode::kGuided).plateau;
  ASSERT_TRUE(plateau);
  EXPECT_LE(plateau->slope, 0.0);
  EXPECT_NEAR(plateau->mean, (5 * 60.0 + 4 * 62.0 + 0.0) / 10.0, 1e-12);
  EXPECT_FALSE(plateau->is_rested);
  add(history, 10, attempt("tap-1", TrainingMode::kGuided, 0, 50.0, false));
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).plateau->is_rested);

  std::vector<PastAttempt> rising;
  for (int n = 0; n < 10; ++n) rising.push_back(attempt("biopsy-1", TrainingMode::kGuided, 0, 50.0 + 0.25 * n, false));
  EXPECT_FALSE(step_of(rising, "biopsy-1", TrainingMode::kGuided).plateau);
  rising = history;
  add(rising, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  EXPECT_FALSE(step_of(rising, "biopsy-1", TrainingMode::kGuided).plateau) << "it is mastered";
}

TEST(Progress, HarderCaseWithLessHelpCoversEasierOnes) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-2", TrainingMode::kAssisted, 0));
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kAssisted).is_mastered);
  EXPECT_TRUE(step_of(history, "biopsy-2", TrainingMode::kGuided).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kExam).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-3", TrainingMode::kGuided).is_mastered);
  EXPECT_FALSE(step_of(history, "tap-1", TrainingMode::kGuided).is_mastered);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kAssisted).repetition);  // it was never practised
}

TEST(Progress, SchedulesRepetitionsAtGrowingIntervals) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  const auto due = [&] { return step_of(history, "biopsy-1", TrainingMode::kGuided, 100).repetition->due; };
  EXPECT_EQ(due(), date(1));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 1));
  EXPECT_EQ(due(), date(1 + 3));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 4));
  EXPECT_EQ(due(), date(4 + 7));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 20));  // late: from the day on which it was done
  EXPECT_EQ(due(), date(20 + 7));                                   // the last interval stays
}

TEST(Progress, EarlyPassDoesNotLengthenTheInterval) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 5, attempt("biopsy-1", TrainingMode::kGuided, 0));
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided, 9).repetition->due, date(1));
}

TEST(Progress, FailedRepetitionRestartsTheIntervals) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 1));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 4, 50.0, false));
  const StepProgress step = step_of(history, "biopsy-1", TrainingMode::kGuided, 9);
  EXPECT_TRUE(step.is_mastered);
  EXPECT_EQ(step.repetition->due, date(5));
  EXPECT_TRUE(step.repetition->has_failed);
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 5));
  EXPECT_EQ(step_of(history, "biopsy-1", TrainingMode::kGuided, 9).repetition->due, date(5 + 3));
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided, 9).repetition->has_failed);
}

TEST(Progress, RepeatsOnlyTheLevelWithTheLeastHelp) {
  std::vector<PastAttempt> history;
  master(history, "biopsy-1", 0);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kGuided).repetition);
  EXPECT_FALSE(step_of(history, "biopsy-1", TrainingMode::kAssisted).repetition);
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kExam).repetition);
  EXPECT_TRUE(step_of(history, "biopsy-1", TrainingMode::kGuided).is_mastered);
}

TEST(WeakestPart, CostsTheMostPointsOverTheLastAttempts) {
  std::vector<PastAttempt> history;
  const auto with = [](std::map<std::string, double, std::less<>> shares) {
    PastAttempt one = attempt("biopsy-1", TrainingMode::kGuided, 0);
    one.part_shares = std::move(shares);
    return one;
  };
  add(history, 9, with({{"visibility", 0.0}}));                                  // older than the last five
  add(history, 3, with({{"target", 0.7}, {"visibility", 0.5}}));                 // of 75 and 25 points
  add(history, 2, with({{"target", 0.8}, {"visibility", 0.3}, {"time", 0.0}}));  // of 60, 20 and 20
  const auto weakest = find_weakest_part(history, example_curriculum());
  ASSERT_TRUE(weakest);
  EXPECT_EQ(weakest->part, "target");  // visibility has the lower share; the time was judged only twice
  EXPECT_NEAR(weakest->lost_points, (3 * 0.3 * 75.0 + 2 * 0.2 * 60.0) / 5, 1e-12);
  EXPECT_NEAR(weakest->most_points, (3 * 75.0 + 2 * 60.0) / 5, 1e-12);
  EXPECT_EQ(weakest->attempts, 5);
}

TEST(WeakestPart, NeedsEnoughAttemptsOfKnownTasks) {
  std::vector<PastAttempt> history;
  PastAttempt one = attempt("biopsy-1", TrainingMode::kGuided, 0);
  one.part_shares = {{"target", 0.1}, {"of another program", 0.0}};
  add(history, 2, one);
  one.task = "unknown";
  add(history, 4, one);
  EXPECT_FALSE(find_weakest_part(history, example_curriculum()));
  EXPECT_FALSE(find_weakest_part({}, example_curriculum()));
  one.task = "biopsy";
  history.push_back(one);
  ASSERT_TRUE(find_weakest_part(history, example_curriculum()));
  EXPECT_EQ(find_weakest_part(history, example_curriculum())->part, "target");
  EXPECT_FALSE(find_weakest_part(history, example_curriculum(), "tap"));
}

}  // namespace
}  // namespace trocar::learning
