#include "exams/exam_seal.h"

#include <algorithm>

#include "core/testing/data_folder.h"
#include "exams/test/exam_fixture.h"

namespace trocar::exams {
namespace {

namespace fs = std::filesystem;
using config::Json;

/// A sealed exam without a result.
struct SealedExam : ::testing::Test {
  SealedExam() : key(*signing::SigningKey::make()), end(record_exam(session, exam_info())) {
    const auto made = seal_exam(session, end, key);
    EXPECT_TRUE(made) << made.error().text();
  }
  /// The reason why the session cannot be signed; empty: it was signed.
  std::string refusal(const fs::path& file, const signing::SigningKey& with) const {
    const auto made = sign_exam(file, {}, with);
    if (!made) return made.error().text();
    fs::remove(*made);
    return {};
  }
  std::string refusal() const { return refusal(session, key); }

  TemporaryFolder folder;
  fs::path session = folder / "a.trocar", seal = folder / "a.seal.json";
  signing::SigningKey key;
  ExamEnd end;
};

TEST_F(SealedExam, BindsPersonTaskBodyVersionTablesAndRecording) {
  EXPECT_EQ(refusal(), "");
  const Json json = *config::load_json(seal);
  EXPECT_EQ(json["attempt_id"], exam_info().attempt_id);
  EXPECT_EQ(json["person"], "Ada Lovelace");
  EXPECT_EQ(json["person_id"], "ada");
  EXPECT_EQ(json["person_checked_by"], "PIN");
  EXPECT_EQ(json["task"], "liver-biopsy");
  EXPECT_EQ(json["patient"], "biopsy-2");
  EXPECT_EQ(json["exam_number"], 4711);
  EXPECT_EQ(json["patient_hash"], "0123456789abcdef");
  EXPECT_EQ(json["level"], "exam");
  EXPECT_EQ(json["program_version"], kVersion);
  EXPECT_EQ(json["data_sha256"], *digest_of_data(data_dir()));
  EXPECT_EQ(json["ticks_hash"], end.ticks_hash);
  EXPECT_EQ(json["session_sha256"].get<std::string>().size(), 64u);
}

TEST_F(SealedExam, RefusesToSignAnEditedSession) {
  const std::string bytes = *read_file(session);
  ASSERT_GT(bytes.size(), 10'000u);
  // Every 997th byte, the first and the last ones: header, pages, text, free space.
  for (std::size_t at = 0; at < bytes.size();
       at += at < 64 || at + 64 >= bytes.size() ? 1 : std::min<std::size_t>(997, bytes.size() - 64 - at)) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    overwrite(session, changed);
    EXPECT_NE(refusal(), "") << at;
  }
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2}) {
    overwrite(session, bytes.substr(0, size));
    EXPECT_NE(refusal(), "") << size;
  }
  overwrite(session, bytes + '\0');
  EXPECT_NE(refusal(), "") << "longer";
  overwrite(session, bytes);
  EXPECT_EQ(refusal(), "");
}

TEST_F(SealedExam, RefusesToSignASubstitutedSession) {
  record_exam(folder / "b.trocar", exam_info(), 99.0);
  fs::rename(folder / "b.trocar", session);
  EXPECT_NE(refusal().find("not the sealed one"), std::string::npos) << refusal();
}

TEST_F(SealedExam, DetectsSwappedSeals) {
  storage::SessionInfo other = exam_info();
  other.attempt_id = "other", other.person_id = "bob";
  ASSERT_TRUE(seal_exam(folder / "b.trocar", record_exam(folder / "b.trocar", other), key));
  fs::rename(seal, folder / "c");
  fs::rename(folder / "b.seal.json", seal);
  fs::rename(folder / "c", folder / "b.seal.json");
  EXPECT_NE(refusal().find("not the sealed one"), std::string::npos) << refusal();
  EXPECT_NE(refusal(folder / "b.trocar", key).find("not the sealed one"), std::string::npos);
}

TEST_F(SealedExam, RenamedSessionNeedsARenamedSeal) {
  fs::rename(session, folder / "renamed.trocar");
  EXPECT_NE(refusal(folder / "renamed.trocar", key).find("has no seal"), std::string::npos);
  fs::rename(seal, folder / "renamed.seal.json");
  const auto made = sign_exam(folder / "renamed.trocar", {}, key);
  ASSERT_TRUE(made) << made.error().text();
  EXPECT_EQ((*config::load_json(*made))["person"], "Ada Lovelace") << "the content is the sealed one";
  EXPECT_TRUE(verify_exam(*made, key.public_key())->is_valid());
}

TEST_F(SealedExam, DetectsEveryChangedByteOfTheSeal) {
  const std::string text = *read_file(seal);
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    overwrite(seal, changed);
    EXPECT_FALSE(check_seal(session, key.public_key())) << at;
  }
  for (const std::string& other : {std::string(), std::string("{}"), std::string("[]"), text + " ", text.substr(1)}) {
    overwrite(seal, other);
    EXPECT_NE(refusal(), "") << other.substr(0, 10);
  }
  fs::remove(seal);
  EXPECT_NE(refusal().find("has no seal"), std::string::npos);
}

TEST_F(SealedExam, RefusesToSignOnAnotherStation) {
  EXPECT_NE(refusal(session, *signing::SigningKey::make()).find("another station"), std::string::npos);
}

TEST_F(SealedExam, IsSealedOnce) {
  EXPECT_NE(seal_exam(session, end, key).error().text().find("sealed already"), std::string::npos);
}

TEST(ExamSeal, RefusesASessionThatDiffersFromMemory) {
  const TemporaryFolder folder;
  const auto key = *signing::SigningKey::make();
  const fs::path session = folder / "a.trocar";
  const ExamEnd good = record_exam(session, exam_info());
  const auto refused = [&](auto change, const char* difference) {
    ExamEnd end = good;
    change(end);
    const auto made = seal_exam(session, end, key);
    ASSERT_FALSE(made) << difference;
    EXPECT_NE(made.error().text().find(difference), std::string::npos) << made.error().text();
    EXPECT_FALSE(fs::exists(seal_file_of(session)));
  };
  refused([](ExamEnd& end) { end.person.id = "bob"; }, "the person differs");
  refused([](ExamEnd& end) { end.info.attempt_id = "x"; }, "the attempt differs");
  refused([](ExamEnd& end) { end.info.task = "ptcd"; }, "the task differs");
  refused([](ExamEnd& end) { end.info.patient_seed = 1; }, "the body differs");
  refused([](ExamEnd& end) { end.info.patient_hash = "1"; }, "the body differs");
  refused([](ExamEnd& end) { end.info.program_version = "0"; }, "the program version differs");
  refused([](ExamEnd& end) { end.ticks_hash = "1"; }, "the motion differs");
  refused([](ExamEnd& end) { end.outcome.score = 99.0; }, "the outcome differs");
  refused([](ExamEnd& end) { end.outcome.is_passed = true; }, "the outcome differs");
  refused([](ExamEnd& end) { end.outcome.fails.clear(); }, "the outcome differs");
  refused([](ExamEnd& end) { end.data_sha256 = "1"; }, "tables were changed during the exam");
  EXPECT_TRUE(seal_exam(session, good, key));
}

TEST(ExamSeal, IsMadeForAnUnscoredExam) {
  const TemporaryFolder folder;
  const auto key = *signing::SigningKey::make();
  ExamEnd end{exam_info(), {}, {}, {"ada", "Ada", false}, *digest_of_data(data_dir())};
  auto writer = storage::SessionWriter::create(folder / "a.trocar", end.info);
  ASSERT_TRUE(writer->append(telemetry::TickSample()));
  end.outcome.not_scored = "the skin was not pierced";
  end.outcome.score = std::numeric_limits<double>::quiet_NaN();
  end.outcome.parts = {{"target", "Target", std::numeric_limits<double>::quiet_NaN(), "mm", 0.0, 20.0}};
  ASSERT_TRUE(writer->finish(end.outcome, {}));
  end.ticks_hash = writer->ticks_hash();
  const auto made = seal_exam(folder / "a.trocar", end, key);
  ASSERT_TRUE(made) << made.error().text();
  const Json json = *config::load_json(*made);
  EXPECT_TRUE(json["score"].is_null());
  EXPECT_EQ(json["person_checked_by"], "nothing");
}

TEST(ExamSeal, IsMadeOnlyForFinishedExams) {
  const TemporaryFolder folder;
  const auto key = *signing::SigningKey::make();
  storage::SessionInfo info = exam_info();
  info.level = "guided";
  const auto guided = seal_exam(folder / "b.trocar", record_exam(folder / "b.trocar", info), key);
  ASSERT_FALSE(guided);
  EXPECT_EQ(guided.error().exit_status, 2);
  const auto interrupted =
      seal_exam(folder / "c.trocar", record_exam(folder / "c.trocar", exam_info(), 1.0, false), key);
  ASSERT_FALSE(interrupted);
  EXPECT_NE(interrupted.error().text().find("interrupted"), std::string::npos);
  const ExamEnd end = record_exam(folder / "d.trocar", exam_info());
  overwrite(folder / "d.trocar-wal", "x");  // SQLite removes such a file: the session is not read before
  EXPECT_NE(seal_exam(folder / "d.trocar", end, key).error().text().find("in use"), std::string::npos);
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
