// The scripted expert passes every task on each of its embedded patients, and harms nobody.

#include "anatomy/phantom/phantom.h"
#include "attempt.h"
#include "cases/testing/cached_case.h"

namespace trocar::testing {
namespace {

TEST(Experts, PassTheirTasksOnAllEmbeddedPatients) {
  int attempts = 0;
  for (const anatomy::PhantomInfo& info : anatomy::embedded_patients()) {
    if (info.difficulty == 0) continue;
    for (const std::string& task : info.tasks) {
      cases::CaseChoice choice;
      choice.options.task = task;
      choice.patient_source = info.name;
      const auto open = open_cached_case(choice);
      ASSERT_TRUE(open) << info.name << ": " << open.error().text();
      const scoring::Outcome outcome = perform((*open)->the_case, "expert").result.outcome;
      EXPECT_TRUE(outcome.is_passed) << info.name << ": " << (outcome.fails.empty() ? "" : outcome.fails.front());
      EXPECT_TRUE(outcome.harms.empty()) << info.name << ": " << metrics::harm_words(outcome.harms.front());
      EXPECT_GT(outcome.score, 95.0) << info.name;
      ++attempts;
    }
  }
  EXPECT_EQ(attempts, 20);
}

}  // namespace
}  // namespace trocar::testing
