// Patients that breathe, by command: the model's figures and picture, an attempt, its replay, and what is refused.
#include <gtest/gtest.h>

#include "cli/program.h"
#include "config/json.h"

namespace trocar::cli_test {
namespace {

class Breathing : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const Outcome made = trocar("patient generate abdomen --voxel-mm 3 --out '" + patient() + "'");
    ASSERT_EQ(made.exit_status, 0) << made.err;
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string patient() { return *folder_ / "patient"; }
  static std::string file(const std::string& name) { return *folder_ / name; }
  static Outcome run(const std::string& options, const std::string& session) {
    return trocar("run liver-biopsy --patient '" + patient() + "' --json " + options + " --out '" + file(session) +
                  "'");
  }
  static std::string ticks_hash(const Outcome& outcome) {
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    return config::Json::parse(outcome.out).at("ticks_hash").get<std::string>();
  }

 private:
  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(Breathing, ModelIsShownAndMadeAgain) {
  const std::string command = "patient motion '" + patient() + "' --json";
  const Outcome shown = trocar(command + " --show '" + file("motion.png") + "'");
  ASSERT_EQ(shown.exit_status, 0) << shown.err;
  const config::Json model = config::Json::parse(shown.out);
  double liver_mm = 0.0;
  for (const config::Json& row : model.at("structures"))
    if (row.at("name") == "liver") liver_mm = -row.at("deep_mm").at(2).get<double>();
  EXPECT_NEAR(liver_mm, 24.4, 1.0);
  EXPECT_TRUE(std::filesystem::file_size(file("motion.png")) > 10'000);
  const Outcome again = trocar(command + " --force");
  ASSERT_EQ(again.exit_status, 0) << again.err;
  EXPECT_EQ(config::Json::parse(again.out).at("hash"), model.at("hash")) << "the folder's patient gives the same model";
  for (const std::string& wrong : {" --show '" + file("motion.png") + "'", " --show '" + file("x.txt") + "'",
                                   " --show '" + file("none/x.png") + "'", std::string(" --ct-inhaled 12")}) {
    const Outcome refused = trocar(command + wrong);
    EXPECT_EQ(refused.exit_status, 2) << wrong;
    EXPECT_EQ(line_count(refused.err), 1) << refused.err;
  }
  EXPECT_FALSE(std::filesystem::exists(file("none")));
}

TEST_F(Breathing, AttemptIsReplayedToTheBit) {
  const std::string rest = ticks_hash(run("--operator expert --breathing none", "rest.session"));
  const std::string breathes = ticks_hash(run("--operator expert --breathing quiet,seed=4", "breathes.session"));
  EXPECT_NE(rest, breathes);
  const Outcome replay = run("--operator 'replay:" + file("breathes.session") + "'", "replay.session");
  EXPECT_EQ(ticks_hash(replay), breathes);
  const Outcome refused = run("--breathing deep --operator 'replay:" + file("breathes.session") + "'", "other.session");
  EXPECT_EQ(refused.exit_status, 2) << refused.err;
}

TEST_F(Breathing, RefusesWhatIsNoBreath) {
  for (const char* const options : {"--breathing loud", "--breathing 41", "--breathing 38", "--breathing quiet,rate=1",
                                    "--breathing none --phase 0.5", "--phase 1.5"}) {
    const Outcome refused = run(std::string("--operator expert ") + options, "refused.session");
    EXPECT_EQ(refused.exit_status, 2) << options << refused.out;
    EXPECT_FALSE(std::filesystem::exists(file("refused.session"))) << options;
  }
}

}  // namespace
}  // namespace trocar::cli_test
