// Every option that takes a number refuses what is no number of its range: exit status 2, one line, nothing written.
#include <gtest/gtest.h>

#include <regex>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

/// A command with the arguments it needs, so that a single bad number is the only mistake.
struct Command {
  const char* program;
  const char* name;
  const char* required;
};
constexpr Command kCommands[] = {
    {"trocar", "patient generate", "abdomen --out x"},
    {"trocar", "patient build", "--ct x.nii --labels x.nii --out x"},
    {"trocar", "patient show", "abdomen"},
    {"trocar", "patient check", "abdomen"},
    {"trocar", "patient render", "abdomen --out x"},
    {"trocar", "plan", "liver-biopsy --patient abdomen --out x"},
    {"trocar", "run", "liver-biopsy --patient abdomen --operator expert --out x"},
    {"trocar", "session report", "x --out y"},
    {"trocar", "session metrics", "x"},
    {"trocar", "exam draw", "liver-biopsy"},
    {"trocar", "ultrasound image", "--patient abdomen --view aorta --out x.png"},
    {"trocar", "ultrasound sweep", "--patient abdomen --view aorta --out x.nrrd"},
    {"trocar", "ultrasound reconstruct", "x.igs.mha --out x.nrrd"},
    {"trocar", "xray", "--patient abdomen --out x.png"},
    {"trocar", "results list", ""},
    {"trocar", "results curve", "--person x --task liver-biopsy"},
    {"trocar", "results validity", "--task liver-biopsy"},
    {"trocar", "results proficiency", "--task liver-biopsy"},
    {"trocar", "bench", "slice"},
    {"trocar-hapticd", "", ""},
};

/// The options of a help text whose argument is a number: "--rate NUMBER=1000 ... (250 to 4000 Hz)".
std::vector<std::string> numeric_options(const std::string& help) {
  std::vector<std::string> options;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    if (const auto at = line.find(" NUMBER"); at != std::string::npos) {
      const auto first = line.find("--");
      options.push_back(line.substr(first, at - first));
    }
  return options;
}

/// Refused by every option: each has a range of its own.
constexpr const char* kOutOfRange[] = {"1e300", "-1e300"};
/// All options are read by one function (apps/arguments), so the spellings are tried with one option of a command.
constexpr const char* kNoNumbers[] = {"nan",      "''",   "3x",  "-nan", "inf", "-inf", "' '", "18446744073709551616",
                                      "-1000000", "0x10", "1,5x"};

class Numbers : public ::testing::TestWithParam<Command> {
 protected:
  void expect_refused(const std::string& option, const char* value) {
    const std::string line = std::string(command_.name) + " " + command_.required + " " + option + "=" + value;
    const Outcome outcome = run_program(command_.program, line, "cd '" + folder_.path().string() + "' &&");
    EXPECT_EQ(outcome.exit_status, 2) << line << "\n" << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << line << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(option), std::string::npos) << line << "\n" << outcome.err;
  }

  const Command command_ = GetParam();
  const TemporaryFolder folder_;
};

TEST_P(Numbers, AreRefusedOutOfRangeInOneLine) {
  const Outcome help = run_program(command_.program, std::string(command_.name) + " --help");
  const std::vector<std::string> options = numeric_options(help.out);
  for (const std::string& option : options)
    for (const char* value : kOutOfRange) expect_refused(option, value);
  if (!options.empty())
    for (const char* value : kNoNumbers) expect_refused(options.front(), value);
  EXPECT_TRUE(folder_.is_empty());
}

TEST_P(Numbers, AreDocumentedWithTheirRange) {
  const Outcome help = run_program(GetParam().program, std::string(GetParam().name) + " --help");
  const std::regex unrestricted(R"(--\S+ (FLOAT|INT|UINT)\b)");
  EXPECT_FALSE(std::regex_search(help.out, unrestricted)) << help.out;
}

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, Numbers, ::testing::ValuesIn(kCommands));

TEST(NumericOptions, AreListedInTheHelp) {
  EXPECT_GE(numeric_options(trocar("ultrasound image --help").out).size(), 20u);
  EXPECT_GE(numeric_options(trocar("run --help").out).size(), 3u);
}

TEST(NumericOptions, AcceptZero) {
  for (const char* line : {"ultrasound sweep --patient abdomen --view aorta --out x.nrrd --angle-deg 0",
                           "ultrasound sweep --patient abdomen --view aorta --tracked x.igs.mha --frames 0",
                           "ultrasound image --patient abdomen --view aorta --out x.png --frames 0",
                           "ultrasound reconstruct x.igs.mha --spacing 0 --out x.nrrd"}) {
    const Outcome outcome = trocar(line);
    EXPECT_EQ(outcome.exit_status, 2) << line << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << line << outcome.err;
  }
}

TEST(NumericOptions, LeadingZerosAreDecimal) {
  // Octal 010 would be 8, which is within the range, too; the program names the number that it has read.
  const Outcome outcome = trocar("ultrasound image --patient abdomen --view aorta --out x.png --planes 008");
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_NE(outcome.err.find("odd"), std::string::npos) << outcome.err;
}

TEST(StandardOutput, FailsIfUnwritable) {
  for (const char* line : {"device list", "device list --json", "task list", "patient list", "ultrasound views",
                           "ultrasound transducers", "bench --list", "--help", "--version", "run --help"}) {
    const Outcome outcome = trocar(std::string(line) + " >/dev/full");
    EXPECT_EQ(outcome.exit_status, 1) << line;
    EXPECT_TRUE(outcome.err.starts_with("error: cannot write the output")) << line << "\n" << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << line << "\n" << outcome.err;
  }
  EXPECT_EQ(run_program("trocar-hapticd", "--help >/dev/full").exit_status, 1);
}

TEST(BenchList, PrintsJsonOnRequest) {
  const config::Json json = json_of(trocar("bench --list --json"));
  ASSERT_FALSE(json["benchmarks"].empty());
  EXPECT_EQ(json["benchmarks"][0]["name"], "slice");
  EXPECT_FALSE(json["benchmarks"][0]["description"].empty());
}

}  // namespace
}  // namespace trocar::cli_test
