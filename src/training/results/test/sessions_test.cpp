#include "results/sessions.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "core/files/output_file.h"
#include "database/testing/other_file_system.h"
#include "results_lab.h"
#include "storage/session_file.h"

namespace trocar::results {
namespace {
namespace fs = std::filesystem;

class Sessions : public ResultsTest {
 protected:
  storage::SessionInfo info(const std::string& person_id) const {
    storage::SessionInfo info;
    info.program_version = "1";
    info.started_utc = "2026-01-02T03:04:05Z";
    info.task = "liver-biopsy";
    info.patient_name = "biopsy-2";
    info.patient_source = "biopsy-2";
    info.patient_hash = "hash";
    info.operator_name = "trainee";
    info.level = "guided";
    info.attempt_id = make_id();
    info.person_id = person_id;
    info.plan_P.line_P = {Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0)};
    info.tissue_names = {"air", "skin"};
    info.layer_names = {"skin"};
    info.label_names.resize(256);
    return info;
  }
  /// Ticks of a needle that advances by 10 mm/s; a peak of the force lasts one tick, at 0.5 s.
  static void append_ticks(storage::SessionWriter& writer, int ticks) {
    for (int n = 0; n < ticks; ++n) {
      telemetry::TickSample sample;
      sample.time_s = 0.001 * n;
      sample.tip_mm = Vec3(0.0, 0.01 * n, 0.0);
      telemetry::set_at_rest(sample);
      sample.depth_mm = 0.01 * n;
      sample.tissue = 1;
      sample.f_prepuncture_n = n == 500 ? -3.25 : -0.5;
      if (n == 501) sample.events[0] = {telemetry::EventKind::kPuncture, 0};
      ASSERT_TRUE(writer.append(sample));
    }
  }
  storage::SessionInfo write(const fs::path& file, const std::string& person_id, bool is_finished) const {
    const storage::SessionInfo written = info(person_id);
    auto writer = storage::SessionWriter::create(file, written);
    EXPECT_TRUE(writer) << writer.error().text();
    append_ticks(*writer, 2000);
    scoring::Outcome outcome;
    outcome.score = 77.5;
    outcome.is_passed = true;
    outcome.parts = {{"target", "Distance to the target", 3.0, "mm", 20.0, 30.0}};
    outcome.hints = {{"Slower", 1.0}};
    outcome.measures = {{"path_length", 20.0, "mm", {}, {}, {}}};
    if (is_finished) {
      EXPECT_TRUE(writer->finish(outcome, {}));
    }
    return written;
  }
  static learning::Curriculum curriculum() {
    return {{}, {{"liver-biopsy", "Liver biopsy", {{"biopsy-1", 1}, {"biopsy-2", 2}}, {}}}};
  }
};
TROCAR_BOTH_DATABASES(Sessions);

TEST_P(Sessions, BecomeAttemptsWithPathForcesAndRecording) {
  const Person anna = add("Anna");
  const fs::path file = folder_ / "a.session";
  const storage::SessionInfo written = write(file, anna.id, true);
  const auto is_new = import_session(*repository_, file, {}, curriculum());
  ASSERT_TRUE(is_new) << is_new.error().text();
  EXPECT_TRUE(*is_new);
  EXPECT_FALSE(*import_session(*repository_, file, {}, curriculum()));
  const AttemptRecord record = load_attempt(*repository_, written.attempt_id)->value();
  EXPECT_EQ(record.attempt.person_id, anna.id);
  EXPECT_EQ(record.attempt.the_case.difficulty, 2);
  EXPECT_EQ(record.attempt.score, 77.5);
  EXPECT_EQ(record.attempt.started, std::chrono::sys_days(std::chrono::year(2026) / 1 / 2) + std::chrono::hours(3) +
                                        std::chrono::minutes(4) + std::chrono::seconds(5));
  EXPECT_NEAR(record.attempt.duration_s, 1.999, 1e-9);
  ASSERT_EQ(record.measures.size(), 1u);
  ASSERT_EQ(record.parts.size(), 1u);
  EXPECT_EQ(record.parts[0].value, "3.0 mm");
  const Trace& trace = record.trace;
  ASSERT_EQ(trace.time_s.size(), 50u);  // 2 s at 25 a second
  EXPECT_NEAR(trace.time_s[1], 0.04, 1e-9);
  EXPECT_NEAR(trace.depth_mm[10], 10.0 * trace.time_s[10], 0.01);
  EXPECT_EQ(trace.tissues.at(static_cast<std::size_t>(trace.tissue[10])), "skin");
  // A peak that is shorter than the interval is still there.
  EXPECT_NEAR(*std::ranges::min_element(trace.force_n), -3.25, 1e-9);
  EXPECT_EQ(std::ranges::count_if(trace.force_n, [](double n) { return n < -1.0; }), 1);
  ASSERT_EQ(trace.events.size(), 1u);
  EXPECT_EQ(trace.events[0].text, "puncture:skin");
  EXPECT_EQ(trace.plan_target_mm[2], 6.0);
  // The session file comes back byte by byte.
  const fs::path back = folder_ / "back.session";
  ASSERT_TRUE(export_session(*repository_, written.attempt_id, back));
  EXPECT_EQ(*read_file(back), *read_file(file));
  EXPECT_FALSE(export_session(*repository_, written.attempt_id, back));  // never over a file
}

TEST_P(Sessions, LeftOnAStationAreImportedAtTheNextStart) {
  const Person anna = add("Anna");
  const fs::path folder = folder_ / "sessions";
  fs::create_directory(folder);
  const storage::SessionInfo finished = write(folder / "a.session", anna.id, true);
  const storage::SessionInfo cut = write(folder / "b.session", anna.id, false);
  write(folder / "c.session", {}, true);           // nobody practised
  write(folder / "d.session", "another's", true);  // of another database
  std::ofstream(folder / "e.session") << "damaged";
  auto imported = import_left_sessions(*repository_, folder, curriculum());
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->added, 2);
  EXPECT_EQ(imported->damaged.size(), 1u);
  EXPECT_EQ(find_attempt(*repository_, finished.attempt_id)->value().state, State::kFinished);
  const Attempt interrupted = find_attempt(*repository_, cut.attempt_id)->value();
  EXPECT_EQ(interrupted.state, State::kInterrupted);
  EXPECT_FALSE(interrupted.score);
  imported = import_left_sessions(*repository_, folder, curriculum());
  EXPECT_EQ(imported->added, 0);
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 2u);
}

TEST_P(Sessions, CountWithoutAScoreIfTheNeedleWasInTheBody) {
  const Person anna = add("Anna");
  const auto state_with = [&](double punctures, const std::string& reason) {
    const fs::path file = folder_ / (make_id() + ".session");
    const storage::SessionInfo written = info(anna.id);
    auto writer = storage::SessionWriter::create(file, written);
    append_ticks(*writer, 100);
    scoring::Outcome outcome;
    outcome.not_scored = reason;
    outcome.measures = {{"skin_punctures", punctures, "1", {}, {}, {}}};
    EXPECT_TRUE(writer->finish(outcome, {}));
    const auto is_new = import_session(*repository_, file, {}, curriculum());
    EXPECT_TRUE(is_new && *is_new) << (is_new ? "" : is_new.error().text());
    EXPECT_FALSE(*import_session(*repository_, file, {}, curriculum())) << "it has ended";
    const AttemptRecord record = load_attempt(*repository_, written.attempt_id)->value();
    EXPECT_EQ(record.not_scored, reason);
    EXPECT_FALSE(record.attempt.score);
    return record.attempt.state;
  };
  EXPECT_EQ(state_with(1.0, "the gun was not fired"), State::kUnscored);
  EXPECT_EQ(state_with(0.0, "the needle never touched the skin"), State::kNeverBegan);
  const auto past = past_attempts(*repository_, anna.id);
  ASSERT_EQ(past->size(), 2u);
  EXPECT_EQ(past->front().ending, learning::Ending::kUnscored);
  EXPECT_TRUE(past->front().is_practice());
  EXPECT_FALSE(past->back().is_practice());
}

TEST_P(Sessions, LoseAtMostHalfASecondWhenKilled) {
  const Person anna = add("Anna");
  const fs::path file = folder_ / "killed.session";
  const storage::SessionInfo written = info(anna.id);
  const pid_t station = ::fork();
  if (station == 0) {
    auto writer = storage::SessionWriter::create(file, written);
    if (writer) append_ticks(*writer, 2750);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(station, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(*import_session(*repository_, file, {}, curriculum()));
  const Attempt attempt = find_attempt(*repository_, written.attempt_id)->value();
  EXPECT_EQ(attempt.state, State::kInterrupted);
  EXPECT_GE(attempt.duration_s, 2.75 - 0.5 - 0.001);
  // Its recording can be opened elsewhere, without the -wal file beside it.
  const fs::path back = folder_ / "back.session";
  ASSERT_TRUE(export_session(*repository_, written.attempt_id, back));
  const auto session = storage::load_session(back);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_TRUE(session->is_incomplete);
  EXPECT_GE(session->samples.size(), 2250u);
}

// On a network drive: neither the session nor the database has a write-ahead log.
TEST_P(Sessions, AreRecordedWithoutAWriteAheadLog) {
  const fs::path file = folder_ / "killed.session", kept = folder_ / "drive.sqlite";
  const database::testing::OtherFileSystem other(database::testing::SharedMemory::kFails);
  auto repository = Repository::open({kept, {}});
  ASSERT_TRUE(repository) << repository.error().text();
  EXPECT_NE(repository->database().note(), "");
  const auto anna = add_person(*repository, {"Anna"}, Seconds());
  ASSERT_TRUE(anna);
  const storage::SessionInfo written = info(anna->id);
  const pid_t station = ::fork();
  if (station == 0) {
    auto writer = storage::SessionWriter::create(file, written);
    if (writer) append_ticks(*writer, 1600);
    database::testing::OtherFileSystem::die_after(20);  // in the middle of the next commit
    if (writer) append_ticks(*writer, 600);
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(station, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(fs::exists(file.string() + "-journal"));
  ASSERT_TRUE(*import_session(*repository, file, {}, curriculum()));
  const fs::path back = folder_ / "back.session";
  ASSERT_TRUE(export_session(*repository, written.attempt_id, back));
  const auto session = storage::load_session(back);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 1500u);
}

TEST_P(Sessions, NeedAPersonOnImport) {
  const fs::path file = folder_ / "a.session";
  write(file, {}, true);
  const auto refused = import_session(*repository_, file, {}, curriculum());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit_status, 2);
  const Person anna = add("Anna");
  EXPECT_TRUE(import_session(*repository_, file, anna.id, curriculum()));
}

TEST_P(Sessions, OfOlderProgramsAreImportedOnce) {
  const Person anna = add("Anna");
  const fs::path file = folder_ / "old.session";
  storage::SessionInfo old = info({});
  old.attempt_id.clear();
  {
    auto writer = storage::SessionWriter::create(file, old);
    append_ticks(*writer, 100);
    ASSERT_TRUE(writer->finish({}, {}));
  }
  EXPECT_TRUE(*import_session(*repository_, file, anna.id, curriculum()));
  EXPECT_FALSE(*import_session(*repository_, file, anna.id, curriculum()));
  EXPECT_EQ(list_attempts(*repository_, {})->size(), 1u);
}

}  // namespace
}  // namespace trocar::results
