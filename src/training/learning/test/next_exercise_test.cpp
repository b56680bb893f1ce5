#include "learning/next_exercise.h"

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

Recommendation next(const std::vector<PastAttempt>& history, int on_day = 0, std::string_view task = {}) {
  return next_exercise(history, example_curriculum(), day(on_day), task);
}

void expect_exercise(const Recommendation& advice, Purpose purpose, const std::string& patient, TrainingMode level) {
  EXPECT_EQ(advice.purpose, purpose) << to_string(advice.purpose);
  ASSERT_TRUE(advice.exercise);
  EXPECT_EQ(advice.exercise->patient, patient);
  EXPECT_EQ(advice.exercise->level, level) << to_string(advice.exercise->level);
  ASSERT_FALSE(advice.reasons.empty());
}

bool has_text(const std::vector<std::string>& lines, std::string_view text) {
  for (const std::string& line : lines)
    if (line.find(text) != std::string::npos) return true;
  return false;
}

TEST(NextExercise, StartsWithTheEasiestCaseOfTheFirstTask) {
  const Recommendation advice = next({});
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", TrainingMode::kGuided);
  EXPECT_EQ(exercise_text(*advice.exercise, example_curriculum()), "Biopsy, case 1, guided");
  EXPECT_TRUE(has_text(advice.reasons, "3 passes in a row with at least 80 points"));
  EXPECT_TRUE(advice.notes.empty());
  expect_exercise(next({}, 0, "tap"), Purpose::kNextStep, "tap-1", TrainingMode::kGuided);
}

TEST(NextExercise, ReducesHelpThenAdvancesToTheNextCase) {
  std::vector<PastAttempt> history;
  add(history, 2, attempt("biopsy-1", TrainingMode::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(next(history).reasons, "you have 2"));
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
  add(history, 3, attempt("biopsy-1", TrainingMode::kAssisted, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kExam);
  history.push_back(attempt("biopsy-1", TrainingMode::kExam, 0, 60.0));
  add(history, 3, attempt("biopsy-1", TrainingMode::kExam, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-2", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(next(history).reasons, "case 1 at all levels of help"));
}

TEST(NextExercise, FlawlessExamOffersTheNextExam) {
  std::vector<PastAttempt> history;
  master(history, "biopsy-1", 0);
  Recommendation advice = next(history, 0, "biopsy");
  expect_exercise(advice, Purpose::kTestOut, "biopsy-2", TrainingMode::kExam);
  EXPECT_TRUE(has_text(advice.reasons, "at least 80 points skips its steps with help"));
  std::vector<PastAttempt> failed = history;
  failed.push_back(attempt("biopsy-2", TrainingMode::kExam, 0, 70.0));
  expect_exercise(next(failed, 0, "biopsy"), Purpose::kNextStep, "biopsy-2", TrainingMode::kGuided);
  history.push_back(attempt("biopsy-2", TrainingMode::kExam, 0, 82.0));
  expect_exercise(next(history, 0, "biopsy"), Purpose::kNextStep, "biopsy-2", TrainingMode::kExam);
  history.back().score = 95.0;
  expect_exercise(next(history, 0, "biopsy"), Purpose::kTestOut, "biopsy-3", TrainingMode::kExam);
}

TEST(NextExercise, InterleavesAnotherTask) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0, 50.0, false));
  Recommendation advice = next(history);
  expect_exercise(advice, Purpose::kInterleave, "tap-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "one exercise 3 times in a row"));
  add(history, 3, attempt("tap-1", TrainingMode::kGuided, 0, 50.0, false));
  expect_exercise(next(history), Purpose::kInterleave, "biopsy-1", TrainingMode::kGuided);
  // Of one task: another case.
  history.resize(3);
  expect_exercise(next(history, 0, "biopsy"), Purpose::kInterleave, "biopsy-2", TrainingMode::kGuided);
  // Attempts that do not count do not interrupt a row, those without a result make one.
  history.assign(3, unscored("biopsy-1", TrainingMode::kGuided, 0));
  history.push_back(attempt("tap-1", TrainingMode::kGuided, 0));
  history.back().ending = Ending::kLost;
  history.back().score.reset();
  expect_exercise(next(history), Purpose::kInterleave, "tap-1", TrainingMode::kGuided);
}

TEST(NextExercise, InterleavesAMasteredExerciseIfNothingElseIsOpen) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("tap-1", TrainingMode::kExam, 0));
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0, 50.0, false));
  expect_exercise(next(history), Purpose::kInterleave, "biopsy-2",
                  TrainingMode::kGuided);  // the tap was just practised
  add(history, 4, attempt("biopsy-1", TrainingMode::kAssisted, 0, 50.0, false));
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0, 50.0, false));
  expect_exercise(next(history), Purpose::kInterleave, "tap-1", TrainingMode::kExam);
}

TEST(NextExercise, StopsRecommendingAFailedRepetition) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  for (int n = 1; n <= 3; ++n) history.push_back(attempt("biopsy-1", TrainingMode::kGuided, n, 50.0, false));
  expect_exercise(next(history, 4), Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
}

TEST(NextExercise, PlateauRefersToTheInstructor) {
  std::vector<PastAttempt> history;
  add(history, 10, attempt("biopsy-1", TrainingMode::kGuided, 0, 61.0));
  Recommendation advice = next(history);
  expect_exercise(advice, Purpose::kSeeInstructor, "tap-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "See your instructor about Biopsy, case 1, guided"));
  EXPECT_TRUE(has_text(advice.reasons, "61 points on average, +0.0 an attempt"));
  expect_exercise(next(history, 0, "biopsy"), Purpose::kSeeInstructor, "biopsy-2", TrainingMode::kGuided);
  add(history, 2, attempt("tap-1", TrainingMode::kGuided, 0, 70.0));
  advice = next(history);  // goes on with the other one, and is reminded
  expect_exercise(advice, Purpose::kNextStep, "tap-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "Biopsy, case 1, guided waits for your instructor"));
  for (int n = 0; n < 8; ++n) history.push_back(attempt("tap-1", TrainingMode::kGuided, 0, 70.0 + n));
  expect_exercise(next(history), Purpose::kInterleave, "biopsy-1",
                  TrainingMode::kGuided);  // rested: it may be tried again
}

TEST(NextExercise, PlateauOfTheOnlyExerciseHasNoAlternative) {
  Curriculum curriculum;
  curriculum.rules.intervals_days = {1};
  curriculum.rules.most_in_a_row = 100;
  curriculum.courses = {{"tap", "Tap", {{"tap-1", 1}}, {{"target", 100.0}}}};
  std::vector<PastAttempt> history;
  for (int n = 0; n < 10; ++n)
    for (const TrainingMode level : kTrainingModes) history.push_back(attempt("tap-1", level, 0, 61.0));
  const Recommendation stuck = next_exercise(history, curriculum, day(0));
  EXPECT_EQ(stuck.purpose, Purpose::kSeeInstructor);
  EXPECT_FALSE(stuck.exercise);
}

TEST(NextExercise, RecommendsADueRepetitionFirst) {
  std::vector<PastAttempt> history;
  master(history, "biopsy-1", 0);
  add(history, 3, attempt("tap-1", TrainingMode::kGuided, 1));
  add(history, 1, attempt("biopsy-2", TrainingMode::kGuided, 1, 50.0, false));
  expect_exercise(next(history, 0, "biopsy"), Purpose::kNextStep, "biopsy-2", TrainingMode::kGuided);
  const Recommendation advice = next(history, 3);  // biopsy-1 is due since day 1, tap-1 since day 2
  expect_exercise(advice, Purpose::kRepetition, "biopsy-1", TrainingMode::kExam);
  EXPECT_TRUE(has_text(advice.reasons, "after 1 day is due since 2026-03-02 (2 days)"));
  expect_exercise(next(history, 3, "tap"), Purpose::kRepetition, "tap-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(next(history, 2, "tap").reasons, "due today"));
}

TEST(NextExercise, ContinuesTheTaskOfTheLastAttempt) {
  std::vector<PastAttempt> history;
  add(history, 1, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 1, attempt("tap-1", TrainingMode::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "tap-1", TrainingMode::kGuided);
}

/// A failed attempt that loses the points of one part.
PastAttempt weak(const std::string& patient, TrainingMode level, const std::string& part) {
  PastAttempt one = attempt(patient, level, 0, 60.0, false);
  one.part_shares = {{"target", 0.9}, {"time", 0.95}};
  one.part_shares[part] = 0.41;
  return one;
}

TEST(NextExercise, WeakestPartAddsOneLevelOfHelp) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 3, weak("biopsy-1", TrainingMode::kAssisted, "visibility"));
  const Recommendation advice = next(history);
  expect_exercise(advice, Purpose::kMoreHelp, "biopsy-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "'Tip visible while advancing': it cost 12 of 20 points"));
  EXPECT_TRUE(has_text(advice.reasons, "last 3 attempts"));
  EXPECT_TRUE(has_text(advice.reasons, "case 1, assisted"));
  PastAttempt good = attempt("biopsy-1", TrainingMode::kGuided, 0);
  good.part_shares = {{"target", 0.9}, {"time", 0.95}, {"visibility", 0.95}};
  add(history, 1, good);  // (3 * 11.8 + 1.0) / 4 = 9.1 points: no longer weak
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
}

TEST(NextExercise, MoreHelpDoesNotLockThePath) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 3, weak("biopsy-1", TrainingMode::kAssisted, "visibility"));
  for (int n = 0; n < 2; ++n) {
    expect_exercise(next(history), Purpose::kMoreHelp, "biopsy-1", TrainingMode::kGuided);
    history.push_back(weak("biopsy-1", TrainingMode::kGuided, "visibility"));
  }
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
  PastAttempt success = weak("biopsy-1", TrainingMode::kAssisted, "visibility");
  success.score = 85.0;
  success.is_passed = true;
  history.push_back(success);
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
}

TEST(NextExercise, IgnoresAWeakPartOfFewPoints) {
  Curriculum curriculum = example_curriculum();
  curriculum.courses[0].part_weights = {{"target", 90.0}, {"visibility", 5.0}, {"time", 5.0}};
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 0));
  add(history, 2, weak("biopsy-1", TrainingMode::kAssisted, "visibility"));
  add(history, 1, weak("tap-1", TrainingMode::kGuided, "visibility"));
  add(history, 2, weak("biopsy-1", TrainingMode::kAssisted, "visibility"));
  const Recommendation advice = next_exercise(history, curriculum, day(0));
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
  EXPECT_FALSE(has_text(advice.reasons, "weakest"));
}

TEST(NextExercise, WeakestPartSelectsATaskThatScoresIt) {
  std::vector<PastAttempt> history;
  add(history, 3, weak("biopsy-1", TrainingMode::kGuided, "visibility"));
  PastAttempt tap = attempt("tap-1", TrainingMode::kGuided, 0, 60.0, false);
  tap.part_shares = {{"target", 0.9}};
  add(history, 2, tap);
  const Recommendation advice = next(history);  // a tap does not judge the visibility
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", TrainingMode::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "it cost 12 of 20 points"));
}

TEST(NextExercise, ReportsWhenEverythingIsMastered) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("tap-1", TrainingMode::kExam, 0));
  const Recommendation advice = next(history, 0, "tap");
  EXPECT_EQ(advice.purpose, Purpose::kNothing);
  EXPECT_FALSE(advice.exercise);
  EXPECT_TRUE(has_text(advice.reasons, "Tap, case 1, exam on 2026-03-02"));
}

TEST(NextExercise, NotesAClockSetBackWithoutChangingMastery) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", TrainingMode::kGuided, 50));
  const Recommendation advice = next(history, 10);
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", TrainingMode::kAssisted);
  EXPECT_TRUE(has_text(advice.notes, "3 attempts are dated after today (2026-03-11)"));
  EXPECT_TRUE(next(history, 50).notes.empty());
}

TEST(NextExercise, UnknownTasksAndCasesAreIgnored) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("other-1", TrainingMode::kExam, 0, 10.0, false));
  add(history, 3, attempt("biopsy-77", TrainingMode::kExam, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", TrainingMode::kGuided);
  const Recommendation advice = next(history, 0, "no-such-task");
  EXPECT_EQ(advice.purpose, Purpose::kNothing);
  EXPECT_TRUE(has_text(advice.reasons, "no case"));
}

TEST(NextExercise, RecommendsNothingForAnEmptyCurriculum) {
  EXPECT_EQ(next_exercise({}, {}, day(0)).purpose, Purpose::kNothing);
}

}  // namespace
}  // namespace trocar::learning
