#include "exams/exam_result.h"

#include "core/testing/data_folder.h"
#include "exams/test/exam_fixture.h"

namespace trocar::exams {
namespace {

namespace fs = std::filesystem;
using config::Json;

/// An exam with its signed result.
struct SignedExam : ::testing::Test {
  SignedExam() : key(*signing::SigningKey::make()) {
    EXPECT_TRUE(seal_exam(session, record_exam(session, exam_info()), key));
    const auto made = sign_exam(session, {}, key);
    EXPECT_TRUE(made) << made.error().text();
    text = *read_file(result);
  }

  Verification verify(const std::string& changed) {
    std::ofstream(result, std::ios::binary) << changed;
    const auto verification = verify_exam(result, key.public_key());
    return verification ? *verification : Verification{Verdict::kChanged, verification.error().text()};
  }
  /// Seals and signs another session.
  fs::path sign(const std::string& name, const storage::SessionInfo& info) {
    const fs::path file = folder / (name + ".trocar");
    EXPECT_TRUE(seal_exam(file, record_exam(file, info), key));
    const auto made = sign_exam(file, {}, key);
    EXPECT_TRUE(made) << made.error().text();
    return made.value_or(fs::path());
  }
  Json json() const { return *config::parse_json(text, "result"); }

  TemporaryFolder folder;
  fs::path session = folder / "a.trocar", result = folder / "a.result.json";
  signing::SigningKey key;
  std::string text;
};

TEST_F(SignedExam, StatesTaskAndResult) {
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
  EXPECT_EQ(all["person"], "Ada Lovelace");
  EXPECT_EQ(all["patient_hash"], exam_info().patient_hash);
  const Verification verification = verify(text);
  EXPECT_EQ(verification.verdict, Verdict::kValid);
  EXPECT_TRUE(
      verification.text.starts_with("valid: 2026-02-03T04:05:06Z, liver-biopsy biopsy-2, 87 points, not passed"))
      << verification.text;
  ASSERT_EQ(verification.details.size(), 5u);
  EXPECT_EQ(verification.details[0], "person: Ada Lovelace (ada), who gave the PIN");
  EXPECT_EQ(verification.details[1],
            "body: biopsy-2 4711, hash 0123456789abcdef, in no earlier attempt of the person (sessions of the "
            "station)");
  EXPECT_TRUE(verification.details[3].starts_with("proves: ")) << verification.details[3];
  EXPECT_TRUE(verification.details[4].starts_with("does not prove: who held the needle")) << verification.details[4];
}

TEST_F(SignedExam, StatesThatNoPersonWasChosen) {
  storage::SessionInfo info = exam_info();
  info.person_id.clear();
  const auto verification = verify_exam(sign("b", info), key.public_key());
  EXPECT_EQ(verification->details[0], "person: nobody was chosen on the start page");
}

TEST_F(SignedExam, DetectsEveryChangedMember) {
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

TEST_F(SignedExam, DetectsEveryChangedByte) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    EXPECT_FALSE(verify(changed).is_valid()) << at;
  }
}

TEST_F(SignedExam, DetectsADuplicateMember) {
  // Another reader of JSON could take the first one.
  std::string twice = text;
  twice.replace(twice.find("  \"passed\": false"), 0, "  \"passed\": true,\n");
  EXPECT_EQ(verify(twice).verdict, Verdict::kChanged);
  EXPECT_EQ(verify(text + " ").verdict, Verdict::kChanged);
}

TEST_F(SignedExam, DetectsATruncatedSignature) {
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
  // A forger seals and signs with a key of their own.
  fs::remove(result);
  fs::remove(session);
  fs::remove(seal_file_of(session));
  ASSERT_TRUE(seal_exam(session, record_exam(session, exam_info(), 100.0), *other));
  ASSERT_TRUE(sign_exam(session, {}, *other));
  EXPECT_EQ(verify_exam(result, key.public_key())->verdict, Verdict::kOtherKey);
}

TEST_F(SignedExam, DetectsAReplacedSessionAndNotesAMissingOne) {
  fs::remove(session);
  const auto alone = verify_exam(result, key.public_key());
  ASSERT_TRUE(alone);
  EXPECT_EQ(alone->verdict, Verdict::kValid);
  EXPECT_NE(alone->text.find("not checked"), std::string::npos) << alone->text;
  record_exam(session, exam_info(), 99.0);
  const auto replaced = verify_exam(result, key.public_key());
  ASSERT_TRUE(replaced);
  EXPECT_EQ(replaced->verdict, Verdict::kChanged);
  EXPECT_NE(replaced->text.find("session a.trocar"), std::string::npos) << replaced->text;
}

TEST_F(SignedExam, DetectsAJournalBesideTheSession) {
  for (const std::filesystem::path& beside : storage::session_files(session)) {
    if (beside == session) continue;
    ASSERT_TRUE(write_file_atomically(beside, "what a reader would see instead"));
    const auto found = verify_exam(result, key.public_key());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->verdict, Verdict::kChanged) << beside;
    EXPECT_NE(found->text.find("a journal lies beside"), std::string::npos) << found->text;
    std::filesystem::remove(beside);
  }
  EXPECT_TRUE(verify_exam(result, key.public_key())->is_valid());
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
  const auto verification = verify_exam(sign("b", info), key.public_key());
  EXPECT_EQ(verification->verdict, Verdict::kOtherVersion);
  EXPECT_NE(verification->text.find("program version 0.0.1"), std::string::npos) << verification->text;
  info = exam_info();
  info.force_version = 1;
  const auto of_older_forces = verify_exam(sign("c", info), key.public_key());
  EXPECT_EQ(of_older_forces->verdict, Verdict::kOtherVersion);
  EXPECT_NE(of_older_forces->text.find("version 1 of the forces"), std::string::npos) << of_older_forces->text;
}

TEST_F(SignedExam, SignsTheTablesOfTheAttempt) {
  fs::remove(result);
  const testing::OwnDataFolder data;
  data.change("tasks/liver-biopsy.toml", "pass_mark = 70.0", "pass_mark = 1.0");
  ASSERT_TRUE(sign_exam(session, {}, key));
  EXPECT_EQ(verify_exam(result, key.public_key())->verdict, Verdict::kOtherVersion);
}

TEST_F(SignedExam, RefusesASecondSignatureAndNonExams) {
  const auto again = sign_exam(session, {}, key);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().text().find("signed already"), std::string::npos);
  storage::SessionInfo info = exam_info();
  info.level = "guided";
  record_exam(folder / "b.trocar", info);
  const auto guided = sign_exam(folder / "b.trocar", {}, key);
  ASSERT_FALSE(guided);
  EXPECT_NE(guided.error().text().find("its level is guided"), std::string::npos) << guided.error().text();
  record_exam(folder / "c.trocar", exam_info());
  EXPECT_NE(sign_exam(folder / "c.trocar", {}, key).error().text().find("has no seal"), std::string::npos);
  EXPECT_FALSE(sign_exam(folder / "missing.trocar", {}, key));
}

// Format 1 was signed at any time after the attempt: it stays what it was.
TEST_F(SignedExam, OlderResultIsVerifiableButProvesLess) {
  Json old = json();
  for (const char* added : {"attempt_id", "person", "person_id", "person_checked_by", "patient_seed", "sealed_utc",
                            "ticks_hash", "body_was_seen_unnamed", "known_by"})
    old.erase(added);
  old["format"] = "trocar exam result 1";
  sign_json(old, key);
  const Verification verification = verify(canonical_text(old));
  EXPECT_EQ(verification.verdict, Verdict::kValid) << verification.text;
  EXPECT_NE(verification.text.find("an older program, which proves less"), std::string::npos) << verification.text;
  ASSERT_EQ(verification.details.size(), 2u);
  EXPECT_NE(verification.details[1].find("names no person"), std::string::npos);
  old["score"] = 99.0;
  EXPECT_EQ(verify(canonical_text(old)).verdict, Verdict::kChanged);
  // The new text with the old format is no other signed text.
  Json relabelled = json();
  relabelled["format"] = "trocar exam result 1";
  EXPECT_EQ(verify(canonical_text(relabelled)).verdict, Verdict::kChanged);
}

TEST_F(SignedExam, RefusesASealAsAResult) {
  const auto verification = verify_exam(seal_file_of(session), key.public_key());
  ASSERT_FALSE(verification);
  EXPECT_NE(verification.error().text().find("is the seal of an exam"), std::string::npos);
}

TEST_F(SignedExam, RefusesANonResultFile) {
  for (const char* other : {"", "{}", "[1]", "hello", "{\"format\": \"other\"}"}) {
    fs::remove(result);
    ASSERT_TRUE(write_file_atomically(result, other));
    const auto verification = verify_exam(result, key.public_key());
    ASSERT_FALSE(verification) << other;
    EXPECT_EQ(verification.error().exit_status, 2);
  }
}

}  // namespace
}  // namespace trocar::exams
