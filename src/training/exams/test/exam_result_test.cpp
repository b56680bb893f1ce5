#include "exams/exam_result.h"

#include <gtest/gtest.h>

#include <fstream>

#include "config/json.h"
#include "core/files/atomic_file.h"
#include "core/files/data_dir.h"
#include "core/files/temporary_folder.h"
#include "core/testing/data_folder.h"
#include "core/version.h"
#include "haptics/force_version.h"
#include "storage/session_file.h"

namespace trocar::exams {
namespace {

namespace fs = std::filesystem;
using config::Json;

storage::SessionInfo exam_info() {
  storage::SessionInfo info;
  info.program_version = kVersion;
  info.force_version = haptics::kForceVersion;
  info.started_utc = "2026-02-03T04:05:06Z";
  info.task = "liver-biopsy";
  info.patient_source = "biopsy-2";
  info.patient_hash = "0123456789abcdef";
  info.patient_seed = 4711;
  info.level = "exam";
  info.operator_name = "trainee";
  info.device = "virtual";
  info.label_names.resize(256);
  return info;
}

void write_session(const fs::path& file, const storage::SessionInfo& info, double score = 87.25,
                   bool is_finished = true) {
  auto writer = storage::SessionWriter::create(file, info);
  ASSERT_TRUE(writer) << writer.error().text();
  ASSERT_TRUE(writer->append(telemetry::TickSample()));
  scoring::Outcome outcome;
  outcome.score = score;
  outcome.fails = {"the lung was touched"};
  outcome.parts = {{"target", "Distance to the target", 1.5, "mm", 18.0, 20.0}};
  if (is_finished) {
    ASSERT_TRUE(writer->finish(outcome, {}));
  }
}

/// An exam with its signed result.
struct SignedExam : ::testing::Test {
  SignedExam() : key(*signing::SigningKey::make()) {
    write_session(session, exam_info());
    const auto made = sign_exam(session, {}, key);
    EXPECT_TRUE(made) << made.error().text();
    text = *read_file(result);
  }

  Verification verify(const std::string& changed) {
    std::ofstream(result, std::ios::binary) << changed;
    const auto verification = verify_exam(result, key.public_key());
    return verification ? *verification : Verification{Verdict::kChanged, verification.error().text()};
  }
  Json json() const { return *config::parse_json(text, "result"); }

  TemporaryFolder folder;
  fs::path session = folder / "a.trocar", result = folder / "a.result.json";
  signing::SigningKey key;
  std::string text;
};

TEST_F(SignedExam, SaysWhatWasAskedAndReached) {
  const Json all = json();
  EXPECT_EQ(all["task"], "liver-biopsy");
  EXPECT_EQ(all["exam_number"], 4711);
  EXPECT_EQ(all["difficulty"], 2);
  EXPECT_EQ(all["body_was_known"], false);
  EXPECT_EQ(all["score"], 87.25);
  EXPECT_EQ(all["passed"], false);
  EXPECT_EQ(all["fails"][0], "the lung was touched");
  EXPECT_EQ(all["program_version"], kVersion);
  EXPECT_EQ(all["force_version"], haptics::kForceVersion);
  const Verification verification = verify(text);
  EXPECT_EQ(verification.verdict, Verdict::kValid);
  EXPECT_TRUE(
      verification.text.starts_with("valid: 2026-02-03T04:05:06Z, liver-biopsy biopsy-2, 87 points, not passed"))
      << verification.text;
}

TEST_F(SignedExam, EveryChangedMemberIsFound) {
  const Json all = json();
  ASSERT_GE(all.size(), 20u);
  for (const auto& [name, value] : all.items()) {
    if (name == "format") continue;
    for (const Json& other : {Json("x"), Json(12345), Json(nullptr)}) {
      Json changed = all;
      changed[name] = other;
      if (changed == all) continue;
      const Verification verification = verify(config::json_text(changed) + "\n");
      EXPECT_EQ(verification.verdict, name == "public_key" ? Verdict::kOtherKey : Verdict::kChanged) << name;
    }
    Json without = all;
    without.erase(name);
    EXPECT_FALSE(verify(config::json_text(without) + "\n").is_valid()) << name;
  }
  Json more = all;
  more["remark"] = "passed";
  EXPECT_FALSE(verify(config::json_text(more) + "\n").is_valid());
}

TEST_F(SignedExam, EveryChangedByteIsFound) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_FALSE(verify(changed).is_valid()) << at;
  }
}

TEST_F(SignedExam, AMemberThatIsGivenTwiceIsFound) {
  // Another reader of JSON could take the first one.
  std::string twice = text;
  twice.replace(twice.find("  \"passed\": false"), 0, "  \"passed\": true,\n");
  EXPECT_EQ(verify(twice).verdict, Verdict::kChanged);
  EXPECT_EQ(verify(text + " ").verdict, Verdict::kChanged);
}

TEST_F(SignedExam, ATruncatedSignatureIsFound) {
  Json all = json();
  const std::string signature = all["signature"];
  for (const std::size_t length : {std::size_t{0}, std::size_t{1}, signature.size() - 2}) {
    all["signature"] = signature.substr(0, length);
    EXPECT_EQ(verify(config::json_text(all) + "\n").verdict, Verdict::kChanged) << length;
  }
  EXPECT_FALSE(verify(text.substr(0, text.size() / 2)).is_valid());
}

TEST_F(SignedExam, AnotherStationsKeyIsNamed) {
  const auto other = signing::SigningKey::make();
  const auto verification = verify_exam(result, other->public_key());
  ASSERT_TRUE(verification);
  EXPECT_EQ(verification->verdict, Verdict::kOtherKey);
  // A forger signs with a key of their own.
  fs::remove(result);
  ASSERT_TRUE(sign_exam(session, {}, *other));
  EXPECT_EQ(verify_exam(result, key.public_key())->verdict, Verdict::kOtherKey);
}

TEST_F(SignedExam, AReplacedSessionIsFoundAndAMissingOneNoted) {
  fs::remove(session);
  const auto alone = verify_exam(result, key.public_key());
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->verdict, Verdict::kValid);
  EXPECT_NE(alone->text.find("not checked"), std::string::npos) << alone->text;
  write_session(session, exam_info(), 99.0);
  const auto replaced = verify_exam(result, key.public_key());
  ASSERT_TRUE(replaced);
  EXPECT_EQ(replaced->verdict, Verdict::kChanged);
  EXPECT_NE(replaced->text.find("session a.trocar"), std::string::npos) << replaced->text;
}

TEST_F(SignedExam, OtherTablesAndVersionsAreNamed) {
  {
    const testing::OwnDataFolder data;
    data.change("tasks/liver-biopsy.toml", "pass_mark = 70.0", "pass_mark = 1.0");
    const auto verification = verify_exam(result, key.public_key());
    ASSERT_TRUE(verification);
    EXPECT_EQ(verification->verdict, Verdict::kOtherVersion);
    EXPECT_NE(verification->text.find("other data tables"), std::string::npos) << verification->text;
  }
  storage::SessionInfo info = exam_info();
  info.program_version = "0.0.1";
  write_session(folder / "b.trocar", info);
  ASSERT_TRUE(sign_exam(folder / "b.trocar", {}, key));
  const auto verification = verify_exam(folder / "b.result.json", key.public_key());
  EXPECT_EQ(verification->verdict, Verdict::kOtherVersion);
  EXPECT_NE(verification->text.find("program version 0.0.1"), std::string::npos) << verification->text;
  info = exam_info();
  info.force_version = 1;
  write_session(folder / "c.trocar", info);
  ASSERT_TRUE(sign_exam(folder / "c.trocar", {}, key));
  const auto of_older_forces = verify_exam(folder / "c.result.json", key.public_key());
  EXPECT_EQ(of_older_forces->verdict, Verdict::kOtherVersion);
  EXPECT_NE(of_older_forces->text.find("version 1 of the forces"), std::string::npos) << of_older_forces->text;
}

TEST_F(SignedExam, IsNotSignedTwiceNorAnythingThatIsNoExam) {
  const auto again = sign_exam(session, {}, key);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().text().find("signed already"), std::string::npos);
  storage::SessionInfo info = exam_info();
  info.level = "guided";
  write_session(folder / "b.trocar", info);
  EXPECT_FALSE(sign_exam(folder / "b.trocar", {}, key));
  write_session(folder / "c.trocar", exam_info(), 1.0, false);
  const auto interrupted = sign_exam(folder / "c.trocar", {}, key);
  ASSERT_FALSE(interrupted);
  EXPECT_NE(interrupted.error().text().find("interrupted"), std::string::npos);
  EXPECT_FALSE(sign_exam(folder / "missing.trocar", {}, key));
}

TEST_F(SignedExam, SaysIfTheBodyWasKnown) {
  using namespace std::chrono;
  const sys_seconds begin = sys_days(year(2026) / 2 / 3) + hours(4) + minutes(5) + seconds(6);
  const auto known = [&](const std::string& patient, std::uint64_t seed, sys_seconds when) {
    fs::remove(result);
    const std::vector<learning::PastAttempt> history{{"liver-biopsy", patient, seed, {}, when}};
    EXPECT_TRUE(sign_exam(session, history, key));
    return (*config::load_json(result))["body_was_known"].get<bool>();
  };
  EXPECT_FALSE(known("biopsy-2", 4711, begin));  // the exam itself
  EXPECT_TRUE(known("biopsy-2", 4711, begin - hours(1)));
  EXPECT_FALSE(known("biopsy-2", 4711, begin + hours(1)));
  EXPECT_FALSE(known("biopsy-2", 1, begin - hours(1)));
  EXPECT_FALSE(known("biopsy-3", 4711, begin - hours(1)));
}

TEST_F(SignedExam, AFileThatIsNoResultIsRefused) {
  for (const char* other : {"", "{}", "[1]", "hello", "{\"format\": \"other\"}"}) {
    fs::remove(result);
    ASSERT_TRUE(write_file_atomically(result, other));
    const auto verification = verify_exam(result, key.public_key());
    ASSERT_FALSE(verification) << other;
    EXPECT_EQ(verification.error().exit_status, 2);
  }
}

TEST(DigestOfData, ChangesWithAByteAndAName) {
  const std::string before = *digest_of_data(data_dir());
  EXPECT_EQ(before, *digest_of_data(data_dir()));
  {
    const testing::OwnDataFolder data;
    EXPECT_EQ(*digest_of_data(data_dir()), before);
    data.change("tissues.toml", " ", "  ");
    EXPECT_NE(*digest_of_data(data_dir()), before);
  }
  const testing::OwnDataFolder data;
  fs::rename(data_dir() / "needles.toml", data_dir() / "needle.toml");
  EXPECT_NE(*digest_of_data(data_dir()), before);
}

}  // namespace
}  // namespace trocar::exams
