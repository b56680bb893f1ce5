// The scripted expert passes every task on its embedded patients, and harms nobody.

#include <cstdlib>
#include <map>

#include "attempt.h"
#include "cases/testing/cached_case.h"
#include "phantom/phantom.h"

namespace trocar::testing {
namespace {

void expect_passes(const std::string& patient, const std::string& task) {
  cases::CaseChoice choice;
  choice.options.task = task;
  choice.patient_source = patient;
  const auto open = open_cached_case(choice);
  ASSERT_TRUE(open) << patient << ": " << open.error().text();
  const scoring::Outcome outcome = perform((*open)->the_case, "expert").result.outcome;
  EXPECT_TRUE(outcome.is_passed) << patient << ": " << (outcome.fails.empty() ? "" : outcome.fails.front());
  EXPECT_TRUE(outcome.harms.empty()) << patient << ": " << metrics::harm_words(outcome.harms.front());
  EXPECT_GT(outcome.score, 95.0) << patient;
}

TEST(Experts, PassTheirTasksOnTheMostDifficultPatients) {
  std::map<std::string, const phantom::PhantomInfo*> most_difficult;
  const std::vector<phantom::PhantomInfo> patients = phantom::embedded_patients();
  for (const phantom::PhantomInfo& info : patients)
    for (const std::string& task : info.tasks) {
      const phantom::PhantomInfo*& known = most_difficult[task];
      if (known == nullptr || info.difficulty > known->difficulty) known = &info;
    }
  EXPECT_EQ(most_difficult.size(), 4u);
  for (const auto& [task, info] : most_difficult) expect_passes(info->name, task);
}

// Six minutes: before a release, and after a change of patients, forces or scores (CONTRIBUTING.md).
TEST(Experts, PassTheirTasksOnAllEmbeddedPatients) {
  if (std::getenv("TROCAR_TEST_EVERY_PATIENT") == nullptr) GTEST_SKIP() << "TROCAR_TEST_EVERY_PATIENT is not set";
  int attempts = 0;
  for (const phantom::PhantomInfo& info : phantom::embedded_patients()) {
    if (info.difficulty == 0) continue;
    for (const std::string& task : info.tasks) {
      expect_passes(info.name, task);
      ++attempts;
    }
  }
  EXPECT_EQ(attempts, 20);
}

// In these the planned end lies so near to the wall that the wall has not given way there.
TEST(Experts, PressThroughTheWallOfTheTarget) {
  expect_passes("ascites-3", "lumbar-puncture");
  expect_passes("biopsy-1", "ptcd");
}

}  // namespace
}  // namespace trocar::testing
