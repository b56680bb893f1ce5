#include <gtest/gtest.h>

#include "report/html_report.h"
#include "report/test/example_attempt.h"

namespace trocar::report {
namespace {

TEST(TextReport, FollowsReadingOrder) {
  storage::Session session = testing::example_attempt();
  session.outcome->fails = {"the lung was touched", "the score is below 90"};
  session.outcome->hints.push_back({"Advance more slowly.", 4.25});
  session.interruptions = {{1.0, 1.0, "busy"}, {3.0, 3.5, "the server was away"}};
  const ReportStory story{{{"Find the lesion", 0.0, 2.5}, {"Fire", 2.5, {}}, {"Withdraw", {}, {}}},
                          {{1.5, 12.25, "aspirated: bile"}}};
  EXPECT_EQ(text_report(session, story),
            "liver-biopsy on box by expert, 2026-01-02T03:04:05Z\n"
            "Not passed: the lung was touched; the score is below 90\n"
            "83 of 100 points, target reached\n"
            "improve first: Hold the needle flatter.\n"
            "then: Advance more slowly. (at 4.2 s)\n"
            "  Distance to the target                             0.4 mm   24.0 of 25.0 points\n"
            "  Risks                                                   1    0.0 of 20.0 points\n"
            "steps:\n"
            "  1. Find the lesion: begun at 0.0 s, done at 2.5 s, took 2.5 s\n"
            "  2. Fire: begun at 2.5 s, not done\n"
            "  3. Withdraw: not counted, a step before it was not done\n"
            "actions:\n"
            "  1.5 s, 12.2 mm deep: aspirated: bile\n"
            "interruption at 3.00 s: 0.50 s, the server was away\n"
            "1 interruption shorter than 0.1 s, 0.00 s in total\n");
}

TEST(TextReport, ReportsPassedNotScoredAndIncomplete) {
  storage::Session session = testing::example_attempt();
  session.outcome->is_passed = true;
  session.outcome->hints = {{"Well done: nothing at risk was touched.", {}}};
  EXPECT_EQ(text_report(session).find("improve"), std::string::npos);
  EXPECT_NE(text_report(session).find("\nWell done: nothing"), std::string::npos);
  EXPECT_NE(text_report(session).find("\nPassed\n83 of 100 points"), std::string::npos);
  session.outcome->is_passed = false;
  session.outcome->not_scored = "the skin was not pierced";
  EXPECT_NE(text_report(session).find("\nNot passed: not scored, the skin was not pierced\n"), std::string::npos);
  session.outcome.reset();
  EXPECT_NE(text_report(session).find("\nNo verdict: the session is incomplete"), std::string::npos);
}

}  // namespace
}  // namespace trocar::report
