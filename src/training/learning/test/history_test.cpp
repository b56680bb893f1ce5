#include "learning/history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::learning {
namespace {

storage::SessionInfo info_at(const std::string& time) {
  storage::SessionInfo info;
  info.started_utc = time;
  info.task = "liver-biopsy";
  info.patient_source = "biopsy-2";
  info.patient_seed = 7;
  info.level = "assisted";
  info.label_names.resize(256);
  return info;
}

scoring::Outcome outcome_of(double score) {
  scoring::Outcome outcome;
  outcome.score = score;
  outcome.is_passed = true;
  outcome.parts = {{"target", "Distance", 1.0, "mm", 15.0, 20.0}, {"risk", "Deduction", 0.0, "", -5.0, 0.0}};
  return outcome;
}

void write_session(const std::filesystem::path& path, const std::string& time, double score) {
  auto writer = storage::SessionWriter::create(path, info_at(time));
  ASSERT_TRUE(writer) << writer.error().text();
  ASSERT_TRUE(writer->append(telemetry::TickSample()));
  ASSERT_TRUE(writer->finish(outcome_of(score), {}));
}

TEST(History, ReadsAnAttemptFromASession) {
  const auto attempt = attempt_of({info_at("2026-02-28T23:59:58Z"), outcome_of(88.5)});
  ASSERT_TRUE(attempt) << attempt.error().text();
  EXPECT_EQ(attempt->task, "liver-biopsy");
  EXPECT_EQ(attempt->patient, "biopsy-2");
  EXPECT_EQ(attempt->patient_seed, 7u);
  EXPECT_EQ(attempt->level, TrainingMode::kAssisted);
  EXPECT_EQ(attempt->when.time_since_epoch().count(), 1772323198);  // date -u -d 2026-02-28T23:59:58Z +%s
  EXPECT_EQ(attempt->score, 88.5);
  EXPECT_TRUE(attempt->is_passed);
  ASSERT_EQ(attempt->part_shares.size(), 1u);  // a deduction has no share
  EXPECT_DOUBLE_EQ(attempt->part_shares.at("target"), 0.75);
}

TEST(History, KeepsScoreAndLevelEmptyIfAbsent) {
  EXPECT_FALSE(attempt_of({info_at("2026-02-28T23:59:58Z"), std::nullopt})->score);
  scoring::Outcome outcome;
  outcome.not_scored = "the needle never touched the skin";
  EXPECT_FALSE(attempt_of({info_at("2026-02-28T23:59:58Z"), outcome})->score);
  EXPECT_EQ(attempt_of({info_at("2026-02-28T23:59:58Z"), outcome})->ending, Ending::kNeverBegan);
  outcome = outcome_of(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(attempt_of({info_at("2026-02-28T23:59:58Z"), outcome})->score);
  storage::SessionInfo info = info_at("2026-02-28T23:59:58Z");
  info.level.clear();
  EXPECT_FALSE(attempt_of({info, outcome_of(1.0)})->level);
}

TEST(History, CountsAnUnscoredAttemptInTheBody) {
  const storage::SessionInfo info = info_at("2026-02-28T23:59:58Z");
  scoring::Outcome outcome;
  outcome.not_scored = "the gun was not fired";  // of an older program: without measures
  EXPECT_EQ(attempt_of({info, outcome})->ending, Ending::kUnscored);
  outcome.not_scored = "any other words";
  outcome.measures = {{"path_length", 12.0, "mm", {}, {}, {}}, {"skin_punctures", 0.0, "1", {}, {}, {}}};
  EXPECT_EQ(attempt_of({info, outcome})->ending, Ending::kNeverBegan);
  outcome.measures[1].value = 2.0;
  EXPECT_EQ(attempt_of({info, outcome})->ending, Ending::kUnscored);
  EXPECT_EQ(attempt_of({info, outcome_of(50.0)})->ending, Ending::kScored);
  EXPECT_EQ(attempt_of({info, outcome_of(std::nan(""))})->ending, Ending::kLost);
  EXPECT_EQ(attempt_of({info, std::nullopt})->ending, Ending::kLost);
}

TEST(History, CountsStateExcludedAttemptsWithReasons) {
  AttemptCounts counts;
  EXPECT_EQ(counts_text(counts), "0 attempts counted");
  for (int n = 0; n < 8; ++n) counts.add(Ending::kScored, true);
  for (int n = 0; n < 16; ++n) counts.add(Ending::kUnscored, false);
  EXPECT_EQ(counts_text(counts), "24 attempts counted (16 ended without a result)");
  counts.add(Ending::kNeverBegan, false);
  counts.add(Ending::kNeverBegan, false);
  counts.add(Ending::kLost, false);
  EXPECT_EQ(counts_text(counts),
            "24 attempts counted (16 ended without a result), 3 left out: 2 never began, 1 was lost to a crash");
  AttemptCounts all;
  all.add(counts);
  all.add(Ending::kRunning, false);
  EXPECT_EQ(all.counted(), 24);
  EXPECT_EQ(all.passed, 8);
  EXPECT_EQ(all.left_out(), 4);
}

TEST(History, RefusesAMalformedTime) {
  for (const char* time : {"", "yesterday", "2026-02-30T00:00:00Z", "2026-13-01T00:00:00Z", "2026-01-01T24:00:00Z",
                           "2026-01-01 00:00:00Z", "2026-01-01T00:00:00Zx", "-026-01-01T00:00:00Z"})
    EXPECT_FALSE(attempt_of({info_at(time), outcome_of(1.0)})) << time;
}

TEST(History, ListsAttemptsByTimeAndNamesDamagedSessions) {
  const TemporaryFolder folder;
  write_session(folder / "b.trocar", "2026-01-01T10:00:00Z", 10.0);
  write_session(folder / "a.session", "2026-01-02T10:00:00Z", 20.0);
  write_session(folder / "c.trocar", "2025-12-31T10:00:00Z", 30.0);
  ASSERT_TRUE(write_file_atomically(folder / "bad.trocar", "SQLite format 3"));
  ASSERT_TRUE(write_file_atomically(folder / "note.txt", "no session"));
  const auto history = read_history(folder.path());
  ASSERT_TRUE(history) << history.error().text();
  ASSERT_EQ(history->attempts.size(), 3u);
  EXPECT_EQ(history->attempts[0].score, 30.0);
  EXPECT_EQ(history->attempts[1].score, 10.0);
  EXPECT_EQ(history->attempts[2].score, 20.0);
  ASSERT_EQ(history->damaged.size(), 1u);
  EXPECT_NE(history->damaged[0].find("bad.trocar"), std::string::npos) << history->damaged[0];
}

TEST(History, IsEmptyForAMissingFolder) {
  const TemporaryFolder folder;
  const auto history = read_history(folder / "nothing");
  ASSERT_TRUE(history);
  EXPECT_TRUE(history->attempts.empty());
  ASSERT_TRUE(write_file_atomically(folder / "file", "x"));
  EXPECT_FALSE(read_history(folder / "file"));
}

}  // namespace
}  // namespace trocar::learning
