// Made-up trainees follow every recommendation of the real curriculum: no exercise locks the path.
#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "learning/progress.h"
#include "learning/test/simulated_trainee.h"

namespace trocar::learning {
namespace {

using testing::follow;
using testing::LearningRun;
using testing::TraineeModel;

Curriculum real_curriculum() {
  auto curriculum = load_curriculum(data_dir());
  EXPECT_TRUE(curriculum) << curriculum.error().text();
  return curriculum.value_or(Curriculum{});
}

TraineeModel model(const std::string& name) {
  for (const TraineeModel& one : testing::trainee_models())
    if (one.name == name) return one;
  ADD_FAILURE() << name;
  return {};
}

int mastered(const LearningRun& run, const Curriculum& curriculum) {
  int count = 0;
  for (const Course& course : curriculum.courses)
    for (const StepProgress& step : progress_of(run.history, course, curriculum.rules, testing::day(1000)))
      count += step.is_mastered ? 1 : 0;
  return count;
}

TEST(PathSimulation, NoTraineeRepeatsOneExerciseForever) {
  const Curriculum curriculum = real_curriculum();
  for (const TraineeModel& one : testing::trainee_models())
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const LearningRun run = follow(one, curriculum, 200, seed);
      EXPECT_LE(run.longest_row(), curriculum.rules.most_in_a_row) << one.name;
      int most = 0;
      for (const auto& [exercise, count] : run.exercises()) most = std::max(most, count);
      EXPECT_LE(3 * most, static_cast<int>(run.advice.size())) << one.name << ": a third of all at one exercise";
    }
}

TEST(PathSimulation, SmallWeakPartDoesNotDelayATrainee) {
  const Curriculum curriculum = real_curriculum();
  const LearningRun run = follow(model("weak in a small part"), curriculum, 30);
  EXPECT_EQ(run.purposes().count("more-help"), 0u);
  EXPECT_GE(mastered(run, curriculum), 12);
}

TEST(PathSimulation, FastLearnerFinishesQuickly) {
  const Curriculum curriculum = real_curriculum();
  std::size_t steps = 0;
  for (const Course& course : curriculum.courses) steps += course.cases.size() * kTrainingModes.size();
  const LearningRun run = follow(model("fast learner"), curriculum, 300);
  EXPECT_TRUE(run.is_through);
  EXPECT_LT(run.history.size(), 2 * steps);  // repetitions included; three passes of each step alone are 3 * steps
  EXPECT_GT(run.purposes()["test-out"], 0);
}

TEST(PathSimulation, SlowLearnerFinishesMostlyWithoutTheInstructor) {
  const Curriculum curriculum = real_curriculum();
  const LearningRun run = follow(model("slow learner"), curriculum, 500);
  EXPECT_TRUE(run.is_through);
  EXPECT_LT(run.purposes()["see-instructor"], 50);
}

TEST(PathSimulation, APlateauReachesTheInstructorSoon) {
  const Curriculum curriculum = real_curriculum();
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const LearningRun run = follow(model("plateau"), curriculum, 60, seed);
    const auto first = std::find_if(run.advice.begin(), run.advice.end(),
                                    [](const auto& one) { return one.purpose == Purpose::kSeeInstructor; });
    ASSERT_NE(first, run.advice.end());
    EXPECT_LT(first - run.advice.begin(), 40);
    ASSERT_TRUE(first->exercise);
    EXPECT_NE(first->reasons.front().find("See your instructor about"), std::string::npos);
  }
  const LearningRun never_fires = follow(model("never fires"), curriculum, 300);
  EXPECT_GT(never_fires.purposes()["see-instructor"], 0);
}

TEST(PathSimulation, ForgetfulTraineeRepeatsAndStillAdvances) {
  const Curriculum curriculum = real_curriculum();
  const LearningRun run = follow(model("forgetful"), curriculum, 300);
  EXPECT_GT(run.purposes()["repetition"], 60);
  EXPECT_GE(mastered(run, curriculum), 30);
}

}  // namespace
}  // namespace trocar::learning
