// A replay takes everything from its session.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <string_view>

#include "core/text.h"
#include "haptics/force_version.h"
#include "program.h"
#include "storage/session_file.h"

namespace trocar::cli_test {
namespace {

/// An expert's attempt whose every argument is another one than the usual.
class ReplayCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    session_ = *folder_ / "first.session";
    recorded_ =
        json_of(trocar("run liver-biopsy --patient layers-liver --patient-seed 3 --seed 42 --device omni "
                       "--needle biopsy-18g --rate 500 --profile tented --set skin.fp=4 --force-model combined "
                       "--operator expert --json --out '" +
                       session_ + "'"));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static Outcome replay(const std::string& arguments, const std::string& out) {
    return trocar("run --operator 'replay:" + session_ + "' --json --out '" + (*folder_ / out) + "' " + arguments);
  }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline std::string session_;
  static inline config::Json recorded_;
};

TEST_F(ReplayCommand, RestoresAllFromTheSession) {
  ASSERT_FALSE(recorded_.is_null());
  const config::Json again = json_of(replay("", "again.session"));
  for (const char* same : {"task", "patient", "patient_hash", "patient_seed", "seed", "device", "force_model", "needle",
                           "ticks", "target_reached", "risks_touched", "hints"})
    EXPECT_EQ(again[same], recorded_[same]) << same;
  EXPECT_EQ(again["seed"], 42);
  EXPECT_EQ(again["patient_seed"], 3);
  EXPECT_EQ(again["device"], "omni");
  EXPECT_NEAR(again["score"].get<double>(), recorded_["score"].get<double>(), 1e-6);
  ASSERT_EQ(again["punctures"].size(), recorded_["punctures"].size());
  for (std::size_t n = 0; n < again["punctures"].size(); ++n)
    EXPECT_NEAR(again["punctures"][n]["peak_n"].get<double>(), recorded_["punctures"][n]["peak_n"].get<double>(), 1e-6);
}

TEST_F(ReplayCommand, RefusesOptionsThatContradictTheSession) {
  for (const std::string contradiction :
       {"--seed 7", "--patient-seed 9", "--device premium", "--rate 1000", "--needle nobody", "lumbar",
        "--patient layers-ascites", "--patient-seed 9 --patient layers-liver"}) {
    const Outcome outcome = replay(contradiction, "none.session");
    EXPECT_EQ(outcome.exit_status, 2) << contradiction << outcome.err;
    EXPECT_NE(outcome.err.find("session"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(
      replay("liver-biopsy --seed 42 --patient-seed 3 --patient layers-liver --device omni --rate 500", "same.session")
          .exit_status,
      0)
      << "what is the same is no contradiction";
}

TEST_F(ReplayCommand, ReplaysIntoAnotherPatientOnlyOnRequest) {
  const Outcome meant = replay("--other-patient --patient-seed 4", "other.session");
  const config::Json other = json_of(meant);
  EXPECT_NE(other["patient_hash"], recorded_["patient_hash"]);
  EXPECT_EQ(other["patient_seed"], 4);
  const Outcome pointless = trocar("run liver-biopsy --patient layers-liver --operator expert --other-patient --out '" +
                                   (*folder_ / "pointless.session") + "'");
  EXPECT_EQ(pointless.exit_status, 2);
}

TEST_F(ReplayCommand, WarnsOfDeliberatelyChangedTissues) {
  const Outcome outcome = replay("--set skin.fp=5", "stiffer.session");
  const config::Json stiffer = json_of(outcome);
  EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_NEAR(stiffer["punctures"][0]["peak_n"].get<double>(), 5.0, 0.05);
  EXPECT_NEAR(recorded_["punctures"][0]["peak_n"].get<double>(), 4.0, 0.04);
}

TEST_F(ReplayCommand, ListsSetNumbersInCsvAndReport) {
  const std::string csv = *folder_ / "first.csv", html = *folder_ / "first.html";
  ASSERT_EQ(trocar("session export '" + session_ + "' --csv '" + csv + "'").exit_status, 0);
  ASSERT_EQ(trocar("session report '" + session_ + "' --out '" + html + "'").exit_status, 0);
  EXPECT_NE(read_text(csv).find("set:skin.fp=4"), std::string::npos);
  EXPECT_NE(read_text(html).find("skin.fp=4"), std::string::npos);
}

TEST_F(ReplayCommand, ReportsBitwiseEqualTicks) {
  const config::Json same = json_of(replay("", "bits.session"));
  EXPECT_EQ(same["ticks_hash"], recorded_["ticks_hash"]);
  EXPECT_EQ(same["ticks_hash"].get<std::string>().size(), 32u);
  EXPECT_EQ(same["same_ticks_as_session"], true);
  EXPECT_EQ(json_of(replay("--set skin.fp=5", "other_bits.session"))["same_ticks_as_session"], false);
  EXPECT_FALSE(recorded_.contains("same_ticks_as_session"));
}

/// The session as another version of the force code would have recorded it.
void write_with_forces(int version, const std::string& from, const std::string& to) {
  auto session = storage::load_session(from);
  ASSERT_TRUE(session) << session.error().text();
  session->info.force_version = version;
  auto writer = storage::SessionWriter::create(to, session->info);
  ASSERT_TRUE(writer) << writer.error().text();
  for (const telemetry::TickSample& sample : session->samples) ASSERT_TRUE(writer->append(sample));
  for (const storage::SessionParameters& parameters : session->parameters) ASSERT_TRUE(writer->append(parameters));
  ASSERT_TRUE(writer->finish(*session->outcome, session->shots));
}

TEST_F(ReplayCommand, ReportsAnotherForceVersion) {
  const std::string older = *folder_ / "older.session", newer = *folder_ / "newer.session";
  ASSERT_NO_FATAL_FAILURE(write_with_forces(1, session_, older));
  ASSERT_NO_FATAL_FAILURE(write_with_forces(haptics::kForceVersion + 1, session_, newer));
  const std::array<const char*, 6> commands{"trocar run --operator 'replay:{}' --out '{}'",
                                            "trocar session export '{}' --csv '{}'",
                                            "trocar session motion '{}' --csv '{}'",
                                            "trocar session report '{}' --out '{}'",
                                            "trocar session metrics '{}' >'{}'",
                                            "trocar-hapticd --device 'replay:{}' --test </dev/null >'{}'"};
  int files = 0;
  for (const std::string command : commands) {
    const auto told = [&](const std::string& session) {
      const std::string line = fmt::format(fmt::runtime(command), session, *folder_ / fmt::format("out{}", ++files));
      const auto name = line.find(' ');
      const Outcome outcome = run_program(line.substr(0, name), line.substr(name + 1));
      EXPECT_EQ(outcome.exit_status, 0) << line << outcome.err;
      const auto at = outcome.err.find("warning: recorded with version ");
      if (at == std::string::npos) return std::string();
      EXPECT_EQ(outcome.err.find("recorded with version", at + 20), std::string::npos) << outcome.err;
      return outcome.err.substr(at, outcome.err.find('\n', at) - at);
    };
    EXPECT_EQ(told(session_), "") << command;
    const std::string here = fmt::format("this program has version {}: ", haptics::kForceVersion);
    EXPECT_NE(told(older).find("version 1 of the forces, " + here), std::string::npos) << command;
    const std::string next = fmt::format("version {} of the forces, ", haptics::kForceVersion + 1);
    EXPECT_NE(told(newer).find(next + here), std::string::npos) << command;
  }
}

using Position = std::array<double, 3>;

double distance_mm(const Position& a, const Position& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Three numbers after `head`, separated by `separator`.
Position position_in(const std::string& text, const std::string& head, char separator) {
  Position p{};
  EXPECT_TRUE(text.starts_with(head)) << text;
  std::string_view rest = std::string_view(text).substr(std::min(head.size(), text.size()));
  for (double& value : p) {
    const auto number = find_leading_number<double>(rest);
    if (!number) {
      ADD_FAILURE() << "no number: " << rest;
      return {};
    }
    value = number->value;
    rest = number->rest;
    EXPECT_TRUE(rest.starts_with(separator));
    rest.remove_prefix(std::min<std::size_t>(1, rest.size()));
  }
  return p;
}

/// Where a replaying server has its stylus at first, in its test mode, which ends with its input.
Position shown_position(const std::string& file) {
  const TemporaryFolder folder;
  const std::string shown = folder / "shown";
  const std::string until_shown =
      "for n in $(seq 600); do grep -qs ^state '" + shown + "' && break; sleep 0.1; done | ";
  const Outcome outcome =
      run_program("trocar-hapticd", "--device 'replay:" + file + "' --test >'" + shown + "'", until_shown);
  EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
  const std::string text = read_text(shown);
  const auto first = text.find("state\t");
  EXPECT_NE(first, std::string::npos) << text;
  return first == std::string::npos ? Position{} : position_in(text.substr(first), "state\t", '\t');
}

TEST_F(ReplayCommand, ServerReplaysSessionAndMotionFilesAlike) {
  const std::string csv = *folder_ / "motion.csv";
  ASSERT_EQ(trocar("session motion '" + session_ + "' --csv '" + csv + "'").exit_status, 0);
  const std::string text = read_text(csv);
  const Position first = position_in(text.substr(text.find('\n') + 1), "0,", ',');
  EXPECT_GT(std::hypot(first[0], first[1], first[2]), 20.0) << "a server that shows zeros would be noticed";
  constexpr double kMoved_mm = 10.0;  // the server shows a pose of the first tenths of a second
  EXPECT_LT(distance_mm(shown_position(csv), first), kMoved_mm);
  EXPECT_LT(distance_mm(shown_position(session_), first), kMoved_mm);
}

TEST_F(ReplayCommand, ServerRefusesANonMotionFileInOneLine) {
  std::ofstream(*folder_ / "damaged.session") << read_text(session_).substr(0, 30'000);
  std::ofstream(*folder_ / "text.csv") << "time,x\n0,1\n";
  for (const char* file : {"damaged.session", "text.csv", "none.csv"}) {
    const Outcome outcome = run_program("trocar-hapticd", "--device 'replay:" + (*folder_ / file) + "' --test");
    EXPECT_EQ(outcome.exit_status, 1) << file;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
  }
}

TEST(Seeds, OperatorSeedDoesNotChangeTheAnatomy) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& arguments, const std::string& out) {
    return json_of(trocar("run liver-biopsy --patient layers-liver --operator novice --json --out '" + (folder / out) +
                          "' " + arguments));
  };
  const config::Json first = run("", "first"), other_hand = run("--seed 2", "hand"),
                     other_body = run("--patient-seed 2", "body");
  EXPECT_EQ(first["patient_seed"], 1);
  EXPECT_EQ(first["patient_hash"], other_hand["patient_hash"]);
  EXPECT_NE(first["score"], other_hand["score"]);
  EXPECT_NE(first["patient_hash"], other_body["patient_hash"]);
  EXPECT_EQ(other_body["seed"], 1);
}

}  // namespace
}  // namespace trocar::cli_test
