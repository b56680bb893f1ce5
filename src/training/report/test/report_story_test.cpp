#include <gtest/gtest.h>

#include "report/session_analysis.h"
#include "report/test/example_attempt.h"

namespace trocar::report {
namespace {

using tasks::ConditionKind;

tasks::Phase phase(const std::string& name, tasks::Condition done, std::vector<std::string> after = {}) {
  return {name, "Step " + name, "", std::move(after), {std::move(done)}, 0.0};
}

// The example reaches 10 mm after 2 s and 40 mm, its end, after 5 s; it is over after 8 s.
TEST(StepTimes, MatchTheRecording) {
  storage::Session session = testing::example_attempt();
  session.actions = {{1.5, tasks::ActionKind::kAnaesthetise, 5.0, {}, {}, 0.0}};
  tasks::Task task;
  task.phases = {phase("numb", {ConditionKind::kAnaesthetised, 0.0, ""}),
                 phase("deep", {ConditionKind::kInserted, 20.0, ""}, {"numb"}),
                 phase("fire", {ConditionKind::kFired, 0.0, ""}, {"deep"}),
                 phase("deeper", {ConditionKind::kInserted, 90.0, ""}, {"fire"}),
                 phase("out", {ConditionKind::kOutside, 0.0, ""}, {"deeper"})};
  tasks::PlannedPath plan;
  plan.line_P = session.info.plan_P.line_P;
  const auto steps = step_times(session, task, testing::example_patient(), {}, plan);
  ASSERT_EQ(steps.size(), 5u);
  EXPECT_EQ(steps[0].title, "Step numb");
  const double every_s = 0.021;  // the tracker sees every 20 ms
  EXPECT_NEAR(steps[0].done_s.value_or(-1.0), 1.5, every_s);
  EXPECT_NEAR(steps[1].done_s.value_or(-1.0), 3.0, every_s);
  EXPECT_NEAR(steps[2].done_s.value_or(-1.0), 6.0, every_s) << "shot at sample 6000";
  EXPECT_TRUE(steps[3].begun_s);
  EXPECT_FALSE(steps[3].done_s);
  EXPECT_FALSE(steps[4].begun_s);
  session.samples.clear();
  EXPECT_EQ(step_times(session, task, testing::example_patient(), {}, plan).size(), 5u);
  task.phases.clear();
  EXPECT_TRUE(step_times(session, task, testing::example_patient(), {}, plan).empty());
}

}  // namespace
}  // namespace trocar::report
