// The bash completion script, asked as bash asks it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

/// What bash offers for the last of the words of a command line.
std::vector<std::string> completions(const std::string& words) {
  static const std::string script = [] {
    const Outcome outcome = trocar("completion bash");
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    return outcome.out;
  }();
  const TemporaryFolder folder;
  std::ofstream(folder / "ask.bash") << script << "\nCOMP_WORDS=(trocar " << words
                                     << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_trocar\n"
                                     << "printf '%s\\n' \"${COMPREPLY[@]}\"\n";
  const Outcome outcome = run_shell("bash --norc -u '" + (folder / "ask.bash") + "'");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  std::vector<std::string> offered;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) offered.push_back(line);
  return offered;
}

using Offered = std::vector<std::string>;

bool offers(const Offered& offered, const std::string& word) {
  return std::find(offered.begin(), offered.end(), word) != offered.end();
}

TEST(Completion, OffersCommandsAndSubCommands) {
  EXPECT_EQ(completions("pat"), Offered{"patient"});
  EXPECT_EQ(completions("patient bu"), Offered{"build"});
  EXPECT_TRUE(offers(completions("''"), "ultrasound"));
  EXPECT_EQ(completions("completion ba"), Offered{"bash"});
}

TEST(Completion, OffersOnlyTheOptionsOfTheCommand) {
  EXPECT_TRUE(offers(completions("patient build --"), "--labels"));
  EXPECT_FALSE(offers(completions("patient build --"), "--operator"));
  EXPECT_TRUE(offers(completions("run --patient abdomen --"), "--operator"));
}

TEST(Completion, OffersNamesOfThisProgram) {
  EXPECT_EQ(completions("run --patient abd"), Offered{"abdomen"});
  EXPECT_EQ(completions("run liver-b"), Offered{"liver-biopsy"});
  EXPECT_TRUE(offers(completions("run --operator ''"), "novice"));
  EXPECT_EQ(completions("ultrasound reconstruct --holes st"), Offered{"stick"});
  EXPECT_EQ(completions("ultrasound image --view gall"), Offered{"gallbladder"});
}

TEST(Completion, OffersNothingForFilesAndNumbers) {
  EXPECT_TRUE(completions("run --out ''").empty());
  EXPECT_TRUE(completions("run --seed ''").empty());
}

/// Every long option of every help text is offered.
TEST(Completion, OffersEveryOptionOfTheHelp) {
  for (const std::string command : {"patient build", "plan", "run", "session report", "ultrasound image",
                                    "ultrasound sweep", "ultrasound reconstruct", "bench"}) {
    const Offered offered = completions(command + " --");
    const Outcome printed = trocar(command + " --help");
    EXPECT_EQ(printed.exit_status, 0) << printed.err;
    std::istringstream help(printed.out);
    int options = 0;
    for (std::string word; help >> word;) {
      if (!word.starts_with("--") || word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-,") != std::string::npos)
        continue;
      if (word.ends_with(",")) word.pop_back();
      if (word.starts_with("--help")) continue;
      EXPECT_TRUE(offers(offered, word)) << command << " " << word;
      ++options;
    }
    EXPECT_GT(options, 0) << command;
  }
}

}  // namespace
}  // namespace trocar::cli_test
