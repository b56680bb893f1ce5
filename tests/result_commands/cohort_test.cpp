// scripts/cohort, and the commands that read what it recorded.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/program.h"
#include "core/testing/source_dir.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

Outcome cohort(const std::string& arguments) {
  return run_shell("'" + (testing::source_dir() / "scripts/cohort").string() + "' " + arguments);
}

TEST(Cohort, IsSimulatedImportedAndMarkedAsSimulated) {
  const TemporaryFolder folder;
  const std::string group = "'" + folder / "people" + "' --experts 1 --novices 1 --sessions 2 --expert-sessions 1" +
                            " --case liver-biopsy:layers-liver";
  const Outcome played = cohort(group);
  ASSERT_EQ(played.exit_status, 0) << played.err;
  EXPECT_NE(played.out.find("3 attempts of simulated people, 3 to play"), std::string::npos) << played.out;
  const fs::path session = folder / "people/simulated novice 01/002-liver-biopsy-layers-liver.session";
  const std::string manifest = read_text(folder / "people/manifest.csv");
  EXPECT_EQ(line_count(manifest), 4);

  // A missing attempt is played again, and gives the same score.
  ASSERT_TRUE(fs::remove(session));
  const std::string database = "'" + folder / "results.sqlite" + "'";
  const Outcome again = cohort(group + " --db " + database);
  ASSERT_EQ(again.exit_status, 0) << again.err;
  EXPECT_NE(again.out.find("3 attempts of simulated people, 1 to play"), std::string::npos) << again.out;
  EXPECT_EQ(read_text(folder / "people/manifest.csv"), manifest);

  const std::string results = "results --db " + database + " ";
  const config::Json curve =
      json_of(trocar(results + "curve --person 'simulated novice 01' --task liver-biopsy --json"));
  EXPECT_EQ(curve["simulated"], true);
  EXPECT_EQ(curve["points"].size(), 2u);
  EXPECT_EQ(curve["experts"]["n"], 1);
  EXPECT_EQ(curve["experts"]["simulated"], true);
  EXPECT_EQ(curve["peers"]["n"], 0);
  EXPECT_EQ(curve["cusum"]["values"].size(), 2u);

  const config::Json validity = json_of(trocar(results + "validity --task liver-biopsy --json"));
  EXPECT_EQ(validity["simulated_people"], 2);
  EXPECT_EQ(validity["experts"], 1);
  EXPECT_GT(validity["metrics"].size(), 20u);
  EXPECT_EQ(validity["discriminating"]["uncorrected"], 0) << "1 and 1 people: every p is 1";
  EXPECT_NE(validity["smallest_p"].get<std::string>().find("can be below 1"), std::string::npos);
  EXPECT_EQ(validity["counts"]["counted"], 3);
  EXPECT_EQ(json_of(trocar(results + "validity --task liver-biopsy --patient layers-liver --json"))["novices"], 1);
  const config::Json proficiency = json_of(trocar(results + "proficiency --task liver-biopsy --json"));
  ASSERT_EQ(proficiency["groups"].size(), 2u);
  EXPECT_EQ(proficiency["groups"][0]["trials_to_proficiency"]["not_yet"], 1);
  EXPECT_EQ(proficiency["groups"][0]["instructor_minutes"], nullptr);
  EXPECT_GT(proficiency["groups"][0]["people"][0]["practice_s"], 1.0);
  EXPECT_TRUE(proficiency["groups"][1]["first_pass_share"].is_number());
  for (const std::string command : {"curve --person 'simulated novice 01' ", "validity ", "proficiency "}) {
    const Outcome text = trocar(results + command + "--task liver-biopsy");
    EXPECT_EQ(text.exit_status, 0) << text.err;
    EXPECT_NE(text.out.find("simulated"), std::string::npos) << text.out;
  }
}

TEST(Cohort, ReportsAttemptsThatCannotRun) {
  const TemporaryFolder folder;
  const Outcome outcome =
      cohort("'" + folder / "people" + "' --experts 0 --novices 1 --sessions 1 --case liver-biopsy:nobody");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("unknown embedded patient"), std::string::npos) << outcome.err;
  EXPECT_EQ(cohort("'" + folder / "other" + "' --case nonsense").exit_status, 2);
  EXPECT_EQ(cohort("'" + folder / "other" + "' --expert-share 2").exit_status, 2);
}

TEST(ResultsEvidence, RefusesUnanswerableQuestions) {
  const TemporaryFolder folder;
  const std::string database = "'" + folder / "results.sqlite" + "'";
  expect_refused(trocar("results --db " + database + " validity --task liver-biopsy"), 1, "no such database");
  ASSERT_EQ(trocar("results --db " + database + " add Anna").exit_status, 0);
  const std::string results = "results --db " + database + " ";
  expect_refused(trocar(results + "validity --task liver-biopsy"), 1, "no attempts to compare (0 attempts counted)");
  expect_refused(trocar(results + "validity --task liver-biopsy --attempts 3-1"), 2, "no range of attempts");
  expect_refused(trocar(results + "validity --task liver-biopsy --attempts 0-1"), 2, "no range of attempts");
  expect_refused(trocar(results + "validity --task liver-biopsy --correction nonsense"), 2, "unknown correction");
  expect_refused(trocar(results + "validity --task liver-biopsy --level 0.05"), 2, "--significance");
  expect_refused(trocar(results + "validity --task liver-biopsy --patient nobody"), 1, "no attempts at this case");
  expect_refused(trocar(results + "proficiency --task liver-biopsy"), 1, "no attempts that count");
  expect_refused(trocar(results + "curve --person Hanna --task liver-biopsy"), 2, "Hanna");
  expect_refused(trocar(results + "curve --person Anna --task liver-biopsy --acceptable 0.5"), 2, "not above");
  expect_refused(trocar(results + "curve --person Anna --task nonsense"), 2, "nonsense");
  const Outcome nothing = trocar(results + "curve --person Anna --task liver-biopsy");
  EXPECT_EQ(nothing.exit_status, 0) << nothing.err;
  EXPECT_NE(nothing.out.find("0 attempts"), std::string::npos) << nothing.out;
}

}  // namespace
}  // namespace trocar::cli_test
