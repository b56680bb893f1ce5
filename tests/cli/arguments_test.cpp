// What the program does with words: help, versions, mistakes.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"
#include "core/version.h"

namespace trocar::cli_test {
namespace {

/// Help of a command and of all its sub-commands, as they are listed there.
void expect_help(const std::string& command, int& count) {
  ++count;
  const Outcome outcome = trocar(command + " --help");
  EXPECT_EQ(outcome.exit_status, 0) << command;
  EXPECT_NE(outcome.out.find("Example"), std::string::npos) << command << ": " << outcome.out;
  EXPECT_EQ(outcome.err, "") << command;
  std::istringstream lines(outcome.out.substr(std::min(outcome.out.find("Subcommands:\n"), outcome.out.size())));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    const std::size_t end = line.find(' ', 2);
    if (end > 2) expect_help((command.empty() ? "" : command + " ") + line.substr(2, end - 2), count);
  }
}

TEST(Help, OfEveryCommandHasAnExample) {
  int count = 0;
  expect_help("", count);
  EXPECT_GT(count, 60);
}

class Mistake : public ::testing::TestWithParam<const char*> {};

TEST_P(Mistake, ExitsTwoWithOneLine) {
  const TemporaryFolder folder;
  const Outcome outcome = trocar(GetParam(), "cd '" + folder.path().string() + "' &&");
  EXPECT_EQ(outcome.exit_status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
  EXPECT_TRUE(folder.is_empty());
}

INSTANTIATE_TEST_SUITE_P(
    OfTheUser, Mistake,
    ::testing::Values(
        "", "nonsense", "patient", "patient nonsense", "patient show", "patient list --nonsense",
        "patient generate abdomen", "patient generate nobody --out x", "patient generate abdomen --seed many --out x",
        "patient build --ct a.nii", "patient series", "patient fetch --study 1.2 --out x",
        "patient fetch --pacs A@b:104 --out x", "patient fetch --pacs nonsense --study 1.2 --out x",
        "patient fetch --dicomweb ftp://b --study 1.2 --out x", "patient fetch --pacs A@b:104 --study x/y --list",
        "patient fetch --pacs A@b:104 --study 1.2 --timeout 0 --out x",
        "patient build --ct a.nii --labels a.nii --out ''",
        "patient build --ct a.nii --labels a.nii --rescale nan,0 --out x",
        "patient build --ct a.nii --labels a.nii --rescale 0,5 --out x", "plan liver-biopsy --patient abdomen --out ''",
        "run liver-biopsy --patient abdomen --operator expert --out ''",
        "plan liver-biopsy --patient abdomen --count 0 --out x.mrk.json",
        "plan nonsense --patient abdomen --out x.mrk.json", "run nonsense --patient abdomen --operator expert --out x",
        "run liver-biopsy --patient nobody --operator expert --out x",
        "run liver-biopsy --patient abdomen --operator nobody --out x",
        "run liver-biopsy --patient abdomen --operator constant-velocity:fast --out x",
        "run liver-biopsy --patient abdomen --operator novice: --out x",
        "run liver-biopsy --patient abdomen --operator novice:1.1 --out x",
        "run liver-biopsy --patient abdomen --operator expert --force-model springs --out x",
        "run liver-biopsy --patient abdomen --operator expert --rate 0 --out x",
        "run liver-biopsy --patient abdomen --operator expert --level nonsense --out x",
        "run liver-biopsy --patient abdomen --operator expert --level '' --out x",
        "run liver-biopsy --patient abdomen --operator expert --level 4 --out x", "exam", "exam draw",
        "exam draw nonsense", "exam draw liver-biopsy --difficulty 0", "exam sign", "exam sign ''", "exam verify",
        "exam verify nothing.json --key ''", "learn nonsense", "session metrics", "session metrics ''",
        "run liver-biopsy --patient abdomen --operator expert --set liver.k=stiff --out x",
        "run liver-biopsy --patient layers-liver --operator expert --set path_constraint.m0=3 --force-model proxy "
        "--out x",
        "link", "link keygen", "link nonsense", "bench nonsense", "bench slice --paths 3", "bench paths --paths 0",
        "bench paths --patient nobody", "bench paths --force-model nonsense", "bench --patient abdomen", "ultrasound",
        "ultrasound sweep", "ultrasound reconstruct a.igs.mha", "ultrasound reconstruct --out x.nrrd",
        "ultrasound reconstruct a.igs.mha --out x.nii", "ultrasound reconstruct a.igs.mha --spacing 0 --out x.nrrd",
        "ultrasound reconstruct a.igs.mha --holes all --out x.nrrd", "serve nonsense", "serve --listen nowhere",
        "serve account", "results", "results nonsense", "results --db mysql://a/b people", "results --db x add ' '",
        "results --db x validity --task liver-biopsy --level 0.05", "results --db x proficiency",
        "results --db x proficiency --task liver-biopsy --in-a-row 0"));

TEST(Arguments, UnknownCommandIsNamed) {
  EXPECT_NE(trocar("nonsense").err.find("nonsense"), std::string::npos);
  EXPECT_NE(trocar("patient nonsense").err.find("trocar patient --help"), std::string::npos);
}

TEST(Arguments, UnknownPatientListsTheEmbeddedOnes) {
  EXPECT_NE(trocar("patient show nobody").err.find("abdomen"), std::string::npos);
}

TEST(Arguments, VersionIsPrinted) {
  const Outcome outcome = trocar("--version");
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_EQ(outcome.out, std::string("trocar ") + kVersion + "\n");
}

TEST(Arguments, ExistingOutputIsRefusedAndKept) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mine") << "mine";
  for (const std::string command : {"patient generate abdomen --out ", "plan liver-biopsy --patient abdomen --out ",
                                    "patient render abdomen --out ", "link keygen --out ",
                                    "run liver-biopsy --patient abdomen --operator expert --out "}) {
    const Outcome outcome = trocar(command + "'" + (folder / "mine") + "'");
    EXPECT_EQ(outcome.exit_status, 2) << command << outcome.err;
  }
  std::ifstream kept(folder / "mine");
  std::string text;
  kept >> text;
  EXPECT_EQ(text, "mine");
}

TEST(Lists, ArePrintedAsJson) {
  const config::Json patients = json_of(trocar("patient list --json"));
  ASSERT_FALSE(patients["patients"].empty());
  EXPECT_EQ(patients["patients"][0]["name"], "abdomen");
  const config::Json tasks = json_of(trocar("task list --json"));
  ASSERT_FALSE(tasks["tasks"].empty());
  EXPECT_NE(trocar("task list").out.find("liver-biopsy"), std::string::npos);
  EXPECT_NE(trocar("bench --list").out.find("slice"), std::string::npos);
}

TEST(Bench, ErrorExplainsHowToBuildItsProgram) {
  const TemporaryFolder folder;
  const Outcome copied = run_shell("cp \"$TROCAR_BIN_DIR/trocar\" '" + folder.path().string() + "'");
  ASSERT_EQ(copied.exit_status, 0) << copied.err;
  const Outcome outcome =
      run_shell("/usr/bin/env -u TROCAR_BIN_DIR PATH=/nowhere '" + (folder / "trocar") + "' bench --list");
  expect_refused(outcome, 1, "scripts/build release trocar-bench");
  EXPECT_NE(outcome.err.find(folder.path().string()), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace trocar::cli_test
