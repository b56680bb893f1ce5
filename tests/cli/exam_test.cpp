// trocar exam: drawing, signing, verifying.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"
#include "cli/short_session.h"

namespace trocar::cli_test {
namespace {

void write_exam(const std::string& file, const std::string& level = "exam") {
  write_session(file, {.patient = "biopsy-2", .seed = 4711, .level = level});
}

TEST(Exam, ASignedResultIsVerifiedHereAndElsewhere) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar", result = folder / "a.result.json";
  const std::string state = " --state '" + folder / "state" + "'";
  write_exam(session);
  const Outcome without_key = trocar("exam verify '" + session + "'" + state);
  EXPECT_EQ(without_key.exit_status, 2) << without_key.err;
  const Outcome made = trocar("exam sign '" + session + "'" + state);
  ASSERT_EQ(made.exit_status, 0) << made.err;
  EXPECT_EQ(made.out, result + "\n");
  const Outcome key = trocar("exam key" + state);
  EXPECT_EQ(key.out.size(), 65u);
  std::ofstream(folder / "station.pub") << key.out;
  for (const std::string& trusted :
       {state, " --key " + key.out.substr(0, 64), " --key '" + folder / "station.pub" + "'"}) {
    const Outcome verified = trocar("exam verify '" + result + "'" + trusted);
    EXPECT_EQ(verified.exit_status, 0) << verified.err;
    EXPECT_TRUE(verified.out.starts_with("valid")) << verified.out;
    EXPECT_EQ(line_count(verified.out), 1);
  }
  const Outcome other = trocar("exam verify '" + result + "' --key " + std::string(64, 'a'));
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_TRUE(other.err.starts_with("error: other key")) << other.err;
  std::string text = read_text(result);
  text.replace(text.find("91.0"), 4, "99.0");
  std::ofstream(result) << text;
  const Outcome changed = trocar("exam verify '" + result + "'" + state);
  EXPECT_EQ(changed.exit_status, 1);
  EXPECT_TRUE(changed.err.starts_with("error: changed")) << changed.err;
  EXPECT_EQ(line_count(changed.err), 1);
}

TEST(Exam, RefusesWhatCannotBeAnExam) {
  const TemporaryFolder folder;
  write_exam(folder / "guided.trocar", "guided");
  const std::string state = " --state '" + folder / "state" + "'";
  EXPECT_EQ(trocar("exam sign '" + folder / "guided.trocar" + "'" + state).exit_status, 2);
  EXPECT_EQ(trocar("exam verify '" + folder / "nothing.json" + "' --key abc").exit_status, 2);
  EXPECT_EQ(trocar("exam draw liver-biopsy --difficulty 6").exit_status, 2);
  EXPECT_EQ(trocar("exam draw no-such-task").exit_status, 2);
  const Outcome practised = trocar("exam draw liver-biopsy --number 1");
  EXPECT_EQ(practised.exit_status, 2);
  EXPECT_NE(practised.err.find("there is no exam 1"), std::string::npos) << practised.err;
}

}  // namespace
}  // namespace trocar::cli_test
