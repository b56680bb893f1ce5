// trocar exam: drawing, signing, verifying.
#include <gtest/gtest.h>

#include <fstream>

#include "cli/program.h"
#include "cli/short_session.h"
#include "core/files/folders.h"
#include "exams/exam_seal.h"

namespace trocar::cli_test {
namespace {

void write_exam(const std::string& file, const std::string& level = "exam") {
  write_session(file, {.patient = "biopsy-2", .seed = 4711, .level = level});
}

/// Seals the session with the key of the station, as the trainer does when an exam ends.
void seal_session(const std::string& file, const std::string& state_folder) {
  const auto session = storage::load_session(file);
  ASSERT_TRUE(session) << session.error().text();
  const auto key = signing::open_station_key(std::filesystem::path(state_folder) / exams::kStationKeyFile);
  ASSERT_TRUE(key) << key.error().text();
  exams::ExamEnd end{session->info, *session->outcome, session->ticks_hash, {}, {}};
  end.data_sha256 = *exams::digest_of_data(data_dir());
  const auto sealed = exams::seal_exam(file, end, *key);
  ASSERT_TRUE(sealed) << sealed.error().text();
}

TEST(Exam, VerifiesASignedResultOnAnyStation) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar", result = folder / "a.result.json";
  const std::string state = " --state '" + folder / "state" + "'";
  write_exam(session);
  const Outcome without_key = trocar("exam verify '" + session + "'" + state);
  EXPECT_EQ(without_key.exit_status, 2) << without_key.err;
  seal_session(session, folder / "state");
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
    EXPECT_NE(verified.out.find("\nperson: nobody was chosen"), std::string::npos) << verified.out;
    EXPECT_NE(verified.out.find("\ndoes not prove: who held the needle"), std::string::npos) << verified.out;
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

TEST(Exam, RefusesNonExamSessions) {
  const TemporaryFolder folder;
  write_exam(folder / "guided.trocar", "guided");
  const std::string state = " --state '" + folder / "state" + "'";
  EXPECT_EQ(trocar("exam sign '" + folder / "guided.trocar" + "'" + state).exit_status, 2);
  EXPECT_EQ(trocar("exam verify '" + folder / "nothing.json" + "' --key abc").exit_status, 2);
  EXPECT_EQ(trocar("exam draw liver-biopsy --difficulty 6").exit_status, 2);
  EXPECT_EQ(trocar("exam draw no-such-task").exit_status, 2);
  const Outcome practised = trocar("exam draw liver-biopsy --number 1");
  EXPECT_EQ(practised.exit_status, 2);
  EXPECT_NE(practised.err.find("whole number from 2 to 999999"), std::string::npos) << practised.err;
}

TEST(Exam, GivesNoVerdictIfNotVerifiable) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar";
  const std::string state = " --state '" + folder / "state" + "'";
  write_exam(session);
  seal_session(session, folder / "state");
  ASSERT_EQ(trocar("exam sign '" + session + "'" + state).exit_status, 0);
  const std::string good = read_text(folder / "a.result.json");
  const auto verify = [&](const std::string& text) {
    std::ofstream(folder / "b.json") << text;
    return trocar("exam verify '" + folder / "b.json" + "'" + state);
  };
  std::string no_number = good;
  no_number.replace(no_number.find("91.0"), 4, "NaN");
  for (const std::string& text : {std::string(), std::string("null"), std::string("[]"), std::string("{}"),
                                  good.substr(0, good.size() / 2), no_number, std::string(200000, '[')})
    expect_refused(verify(text), 2, "b.json");
  expect_refused(verify(good + " "), 1, "changed");
  expect_refused(trocar("exam verify '" + session + "'" + state), 2, "a.trocar");
  expect_refused(trocar("exam verify '" + folder.path().string() + "'" + state), 2, folder.path().string());
  expect_refused(trocar("exam verify '" + folder / "none.json" + "'" + state), 2, "none.json");
  const std::string with_key = "exam verify '" + folder / "a.result.json" + "' --key ";
  expect_refused(trocar(with_key + "'" + folder.path().string() + "'"), 2, folder.path().string());
  expect_refused(trocar(with_key + "/dev/zero"), 2, "/dev/zero");
  expect_refused(trocar(with_key + "''"), 2, "--key is empty");
  std::filesystem::resize_file(session, 10000);
  expect_refused(trocar("exam verify '" + folder / "a.result.json" + "'" + state), 1, "changed: the session a.trocar");
}

TEST(Exam, ADamagedSessionIsNotSigned) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar";
  const std::string state = " --state '" + folder / "state" + "'";
  write_exam(session);
  std::filesystem::resize_file(session, std::filesystem::file_size(session) / 2);
  expect_refused(trocar("exam sign '" + session + "'" + state), 1, "a.trocar");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.result.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "state"));
  expect_refused(trocar("exam sign '" + folder / "none.trocar" + "'" + state), 1, "none.trocar");
  expect_refused(trocar("exam sign ''" + state), 2, "SESSION is empty");
  expect_refused(trocar("exam key --state /proc/nothing"), 1, "/proc/nothing");
}

TEST(Exam, RefusesToSignAnUnsealedOrChangedSession) {
  const TemporaryFolder folder;
  const std::string session = folder / "a.trocar", state = " --state '" + folder / "state" + "'";
  write_exam(session);
  const Outcome no_key = trocar("exam sign '" + session + "'" + state);
  expect_refused(no_key, 1, "this station has no key, so it has sealed no exam");
  EXPECT_FALSE(std::filesystem::exists(folder / "state")) << "no key is made";
  seal_session(session, folder / "state");
  std::filesystem::remove(session);
  write_session(session, {.patient = "biopsy-2", .seed = 4711, .level = "exam", .score = 99.0});
  expect_refused(trocar("exam sign '" + session + "'" + state), 1, "not the sealed one");
  std::filesystem::remove(folder / "a.seal.json");
  expect_refused(trocar("exam sign '" + session + "'" + state), 1, "the exam has no seal");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.result.json"));
}

TEST(Exam, RefusesMissingSessionFolders) {
  const TemporaryFolder folder;
  const std::string none = " --sessions '" + folder / "none" + "'";
  expect_refused(trocar("exam draw liver-biopsy" + none), 2, "no such folder");
  write_exam(folder / "a.trocar");
  seal_session(folder / "a.trocar", folder / "state");
  expect_refused(trocar("exam sign '" + folder / "a.trocar" + "' --state '" + folder / "state" + "'" + none), 2,
                 "no such folder");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.result.json"));
}

}  // namespace
}  // namespace trocar::cli_test
