// Tables, motions and JSON that are almost right: one line with file, place and advice, exit status 1 or 2, nothing
// read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"

namespace trocar::cli_test {
namespace {

constexpr const char* kPoses = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,event\n0,0,0,0,0,0,1,\n";
constexpr const char* kMotion = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n";
constexpr const char* kAttempts = "attempt,person,group,task,started_utc,state,score,passed\n";
constexpr const char* kMarkups = R"({"markups": [{"type": "Line", "controlPoints": [
  {"position": [0, -40, 0]}, {"position": [0, 0, )";

/// `{}` in a command is the file.
constexpr const char *kMeasure = "session metrics '{}'", *kImport = "import of '{}'", *kReplay = "replay of '{}'",
                     *kExpert = "expert of '{}'",
                     *kVerify =
                         "exam verify '{}' --key "
                         "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa";

struct Case {
  const char* command;
  std::string text;
  const char* words;  ///< Of the error.
};

std::vector<Case> cases() {
  const std::string poses = kPoses, motion = kMotion, attempts = kAttempts, markups = kMarkups;
  const std::string row = "0a,Anna,trainee,liver-biopsy,2026-01-02T03:04:05Z,finished,";
  return {
      {kMeasure, poses + "1,0,0,0,0,0,1,interruption:abc\n", "line 3: column event: 'interruption:abc'"},
      {kMeasure, poses + "1,0,0,0,0,0,1,landed\n", "line 3: column event: 'landed': there is no such event"},
      {kMeasure, poses + "1,0,1.0x,0,0,0,1,\n", "line 3: column tip_y_mm: '1.0x'"},
      {kMeasure, poses + "1,0,inf,0,0,0,1,\n", "line 3: column tip_y_mm: 'inf'"},
      {kMeasure, poses + "1,0,5,0,0,0,0,1,\n", "line 3: 9 fields, the header has 8"},
      {kMeasure, poses + "1,0,0,0,0,0,1,\"puncture:skin\n", "line 3, field 8"},
      {kMeasure, poses.substr(7), "line 1: missing column time_s"},
      {kMeasure, "", "empty"},
      {kReplay, motion + "0.001,0,0,0,1.0x,0,0,0\n", "line 3: column qw: '1.0x'"},
      {kReplay, motion + "0.001,nan,0,0,1,0,0,0\n", "line 3: column x_mm: 'nan'"},
      {kReplay, motion + "0,001,0,0,0,1,0,0,0\n", "line 3: 9 fields, not 8"},
      {kReplay, motion.substr(1), "not a recorded motion"},
      {kImport, attempts + row + "50,5,1\n", "line 2"},
      {kImport, attempts + row + "50.0x,1\n", "line 2, column score"},
      {kImport, attempts + row + "nan,1\n", "line 2, column score"},
      {kImport, attempts + row + "50,yes\n", "line 2, column passed"},
      {kImport, attempts + row + "50,1\n" + row + "50,1\n", "the attempt occurs twice"},
      {kImport, "attempt,attempt,person,group,task,started_utc,state\n", "occurs twice"},
      {kImport, "attempt,person,group,task,started_utc,state,scor\n", "there is no column \"scor\""},
      {kImport, "attempt,person,group,task,state\n", "the column \"started_utc\" is missing"},
      {kImport, "", "empty"},
      {kExpert, markups + "0.5x]}]}]}", "line 2, column 53"},
      {kExpert, markups + "NaN]}]}]}", "line 2, column 50"},
      {kExpert, markups + "0,5]}]}]}", "no usable position"},
      {kExpert, markups + "\"0\"]}]}]}", "no usable position"},
      {kExpert, markups + "0]}], \"type\": \"Fiducial\"}]}", "the key \"type\" occurs twice"},
      {kExpert, markups, "not valid JSON"},
      {kVerify, R"({"format": "trocar exam result 2", "format": "trocar exam result 1"})", "no result of an exam"},
      {kVerify, R"({"format": NaN})", "no result of an exam"},
      {kVerify, R"({"format": 2})", "a format that this program does not know"},
  };
}

TEST(StrictInput, IsRefusedWithFileAndLocation) {
  const TemporaryFolder folder;
  const std::string database = folder / "results.sqlite";
  ASSERT_EQ(trocar("results --db '" + database + "' add Anna").exit_status, 0);
  int number = 0;
  for (const Case& c : cases()) {
    const bool is_json = c.command == kExpert || c.command == kVerify;
    const std::string file = folder / fmt::format("{}.{}", ++number, is_json ? "mrk.json" : "csv");
    std::ofstream(file, std::ios::binary) << c.text;
    Outcome outcome;
    if (c.command == kImport) {
      outcome = trocar(fmt::format("results --db '{}' import '{}'", database, file));
    } else if (c.command == kReplay) {
      outcome = run_program("trocar-hapticd", fmt::format("--device 'replay:{}' --tool needle --patient abdomen", file),
                            "timeout 60");
    } else if (c.command == kExpert) {
      const std::string poses = folder / "good.csv";
      std::ofstream(poses) << kPoses;
      outcome = trocar(fmt::format("session metrics '{}' --expert '{}'", poses, file));
    } else {
      outcome = trocar(fmt::format(fmt::runtime(c.command), file));
    }
    EXPECT_TRUE(outcome.exit_status == 1 || outcome.exit_status == 2) << c.text << "\n" << outcome.exit_status;
    EXPECT_EQ(outcome.out, "") << c.text;
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << c.text << "\n" << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(c.words), std::string::npos) << c.text << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(json_of(trocar("results --db '" + database + "' list --json"))["attempts"].size(), 0u);
}

}  // namespace
}  // namespace trocar::cli_test
