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

Recommendation next(const std::vector<PastAttempt>& history, int on_day = 0, std::string_view task = {}) {
  return next_exercise(history, example_curriculum(), day(on_day), task);
}

void expect_exercise(const Recommendation& advice, Purpose purpose, const std::string& patient, Level level) {
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

TEST(NextExercise, BeginsWithTheEasiestCaseOfTheFirstTask) {
  const Recommendation advice = next({});
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", Level::kGuided);
  EXPECT_EQ(exercise_text(*advice.exercise, example_curriculum()), "Biopsy, case 1, guided");
  EXPECT_TRUE(has_text(advice.reasons, "3 passes in a row with at least 80 points"));
  EXPECT_TRUE(advice.notes.empty());
  expect_exercise(next({}, 0, "tap"), Purpose::kNextStep, "tap-1", Level::kGuided);
}

TEST(NextExercise, TakesHelpAwayThenGoesToTheNextCase) {
  std::vector<PastAttempt> history;
  add(history, 2, attempt("biopsy-1", Level::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", Level::kGuided);
  EXPECT_TRUE(has_text(next(history).reasons, "you have 2"));
  add(history, 1, attempt("biopsy-1", Level::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", Level::kAssisted);
  add(history, 3, attempt("biopsy-1", Level::kAssisted, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", Level::kExam);
  add(history, 3, attempt("biopsy-1", Level::kExam, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-2", Level::kGuided);
  EXPECT_TRUE(has_text(next(history).reasons, "case 1 at all levels of help"));
}

TEST(NextExercise, ADueRepetitionComesFirst) {
  std::vector<PastAttempt> history;
  master(history, "biopsy-1", 0);
  add(history, 3, attempt("tap-1", Level::kGuided, 1));
  expect_exercise(next(history, 0, "biopsy"), Purpose::kNextStep, "biopsy-2", Level::kGuided);
  const Recommendation advice = next(history, 3);  // biopsy-1 is due since day 1, tap-1 since day 2
  expect_exercise(advice, Purpose::kRepetition, "biopsy-1", Level::kExam);
  EXPECT_TRUE(has_text(advice.reasons, "after 1 day is due since 2026-03-02 (2 days)"));
  expect_exercise(next(history, 3, "tap"), Purpose::kRepetition, "tap-1", Level::kGuided);
  EXPECT_TRUE(has_text(next(history, 2, "tap").reasons, "due today"));
}

TEST(NextExercise, ContinuesTheTaskOfTheLastAttempt) {
  std::vector<PastAttempt> history;
  add(history, 1, attempt("biopsy-1", Level::kGuided, 0));
  add(history, 1, attempt("tap-1", Level::kGuided, 0));
  expect_exercise(next(history), Purpose::kNextStep, "tap-1", Level::kGuided);
}

/// A failed attempt that loses the points of one part.
PastAttempt weak(const std::string& patient, Level level, const std::string& part) {
  PastAttempt one = attempt(patient, level, 0, 60.0, false);
  one.part_shares = {{"target", 0.9}, {"time", 0.95}};
  one.part_shares[part] = 0.41;
  return one;
}

TEST(NextExercise, TheWeakestPartAsksForOneLevelMoreHelp) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", Level::kGuided, 0));
  add(history, 5, weak("biopsy-1", Level::kAssisted, "visibility"));
  const Recommendation advice = next(history);
  expect_exercise(advice, Purpose::kMoreHelp, "biopsy-1", Level::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "'Advance with the tip in the image': 41 % of its points"));
  EXPECT_TRUE(has_text(advice.reasons, "last 5 attempts"));
  EXPECT_TRUE(has_text(advice.reasons, "case 1, assisted"));
  PastAttempt good = attempt("biopsy-1", Level::kGuided, 0);
  good.part_shares = {{"target", 0.9}, {"time", 0.95}, {"visibility", 0.95}};
  add(history, 3, good);  // mean (2*0.41 + 3*0.95)/5 = 0.73: no longer weak
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", Level::kAssisted);
}

TEST(NextExercise, TheWeakestPartChoosesATaskThatJudgesIt) {
  std::vector<PastAttempt> history;
  add(history, 3, weak("biopsy-1", Level::kGuided, "visibility"));
  PastAttempt tap = attempt("tap-1", Level::kGuided, 0, 60.0, false);
  tap.part_shares = {{"target", 0.9}};
  add(history, 2, tap);
  const Recommendation advice = next(history);  // a tap does not judge the visibility
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", Level::kGuided);
  EXPECT_TRUE(has_text(advice.reasons, "41 %"));
}

TEST(NextExercise, SaysWhenEverythingIsMastered) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("tap-1", Level::kExam, 0));
  const Recommendation advice = next(history, 0, "tap");
  EXPECT_EQ(advice.purpose, Purpose::kNothing);
  EXPECT_FALSE(advice.exercise);
  EXPECT_TRUE(has_text(advice.reasons, "Tap, case 1, exam on 2026-03-02"));
}

TEST(NextExercise, AClockSetBackIsNotedAndChangesNoMastery) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("biopsy-1", Level::kGuided, 50));
  const Recommendation advice = next(history, 10);
  expect_exercise(advice, Purpose::kNextStep, "biopsy-1", Level::kAssisted);
  EXPECT_TRUE(has_text(advice.notes, "3 attempts are dated after today (2026-03-11)"));
  EXPECT_TRUE(next(history, 50).notes.empty());
}

TEST(NextExercise, UnknownTasksAndCasesAreIgnored) {
  std::vector<PastAttempt> history;
  add(history, 3, attempt("other-1", Level::kExam, 0, 10.0, false));
  add(history, 3, attempt("biopsy-77", Level::kExam, 0));
  expect_exercise(next(history), Purpose::kNextStep, "biopsy-1", Level::kGuided);
  const Recommendation advice = next(history, 0, "no-such-task");
  EXPECT_EQ(advice.purpose, Purpose::kNothing);
  EXPECT_TRUE(has_text(advice.reasons, "no case"));
}

TEST(NextExercise, AnEmptyCurriculumHasNothing) {
  EXPECT_EQ(next_exercise({}, {}, day(0)).purpose, Purpose::kNothing);
}

}  // namespace
}  // namespace trocar::learning
