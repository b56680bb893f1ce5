// trocar learn: mastery and the next exercise from a folder of sessions.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"
#include "cli/short_session.h"

namespace trocar::cli_test {
namespace {

/// A passed attempt whose weakest part is the visibility.
void write_attempt(const std::string& file, int minute) {
  write_session(file, {.started_utc = "2026-01-02T10:" + std::to_string(10 + minute) + ":00Z",
                       .score = 92.0,
                       .parts = {{"visibility", "Advance with the tip in the image", 50.0, "%", 2.0, 5.0}}});
}

TEST(Learn, ContinuesFromTheSessionsOfAFolder) {
  const TemporaryFolder folder;
  for (int n = 0; n < 3; ++n) write_attempt(folder / ("g" + std::to_string(n) + ".trocar"), n);
  std::ofstream(folder / "damaged.trocar") << "hello";
  const Outcome outcome = trocar("learn --task liver-biopsy --sessions '" + folder.path().string() + "'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("3 attempts counted\n3 of 3 passed\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("mastered: case 1 guided\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("repeat case 1 guided on 2026-01-03"), std::string::npos) << outcome.out;
  // Its day has passed, but it was practised three times in a row.
  EXPECT_NE(outcome.out.find("next: Liver biopsy, case 1, assisted (patient biopsy-1)"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("damaged.trocar"), std::string::npos) << outcome.err;
  const config::Json json = json_of(trocar("learn --json --sessions '" + folder.path().string() + "'"));
  EXPECT_EQ(json["attempts"], 3);
  EXPECT_EQ(json["next"]["purpose"], "next-step");
  EXPECT_EQ(json["next"]["patient"], "biopsy-1");
  EXPECT_EQ(json["damaged"].size(), 1u);
}

TEST(Learn, CountsAttemptsWithoutAResultAsNotPassed) {
  const TemporaryFolder folder;
  write_attempt(folder / "a.trocar", 0);
  for (int n = 0; n < 2; ++n)
    write_session(folder / ("u" + std::to_string(n) + ".trocar"),
                  {.started_utc = "2026-01-02T11:00:00Z", .not_scored = "the gun was not fired"});
  write_session(folder / "n.trocar", {.not_scored = "the needle never touched the skin", .punctures = 0.0});
  write_session(folder / "c.trocar", {.is_cut = true});
  write_session(folder / "s.trocar", {.level = ""});
  const std::string sessions = " --sessions '" + folder.path().string() + "'";
  const Outcome outcome = trocar("learn" + sessions);
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(
      outcome.out.find("3 attempts counted (2 ended without a result), 3 left out: 1 never began, 1 was lost to a "
                       "crash, 1 had no level of help\n1 of 3 passed\n"),
      std::string::npos)
      << outcome.out;
  const config::Json json = json_of(trocar("learn --json" + sessions));
  EXPECT_EQ(json["counts"]["without_result"], 2);
  EXPECT_EQ(json["counts"]["left_out"]["lost"], 1);
  // Tested out by its first attempt, and failed since.
  EXPECT_EQ(outcome.out.find("mastered: case 1"), std::string::npos) << outcome.out;
}

TEST(Learn, BeginsWithoutSessionsAndRefusesUnknownNames) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar("learn --sessions '" + folder.path().string() + "'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("case 1, guided"), std::string::npos) << outcome.out;
  expect_refused(trocar("learn --sessions '" + folder / "nothing" + "'"), 2, "no such folder");
  expect_refused(trocar("learn --task nothing"), 2, "known are: ascites-puncture");
  for (const std::string option : {"--task", "--sessions"})
    expect_refused(trocar("learn " + option + " ''"), 2, option + " is empty");
}

}  // namespace
}  // namespace trocar::cli_test
