// Sessions where SQLite has no write-ahead log.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "database/testing/other_file_system.h"
#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;
using database::testing::OtherFileSystem;
using database::testing::SharedMemory;
using testing::example_info;
using testing::example_outcome;
using testing::example_sample;

class SessionWithoutLog : public ::testing::TestWithParam<SharedMemory> {
 protected:
  /// Appends `ticks` samples and dies as by kill -9, at the latest before the write after `writes`.
  void write_and_be_killed(std::size_t ticks, int writes = std::numeric_limits<int>::max()) const {
    const pid_t child = ::fork();
    if (child == 0) {
      const OtherFileSystem other(GetParam());
      OtherFileSystem::die_after(writes);
      auto writer = SessionWriter::create(path_, example_info());
      for (std::size_t n = 0; writer && n < ticks; ++n)
        if (!writer->append(example_sample(n))) ::_exit(3);
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
  }
  void expect_first_samples(const Session& session) const {
    for (std::size_t n = 0; n < session.samples.size(); ++n)
      ASSERT_EQ(session.samples[n].tip_mm, example_sample(n).tip_mm);
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_ / "s.session";
  fs::path journal_ = folder_ / "s.session-journal";
};

TEST_P(SessionWithoutLog, IsCompleteWithANote) {
  const OtherFileSystem other(GetParam());
  auto writer = SessionWriter::create(path_, example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  EXPECT_NE(writer->note().find("rollback journal"), std::string::npos) << writer->note();
  for (std::size_t n = 0; n < 1234; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  ASSERT_TRUE(writer->finish(example_outcome(), {}));
  const auto session = load_session(path_);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 1234u);
  EXPECT_EQ(session->ticks_hash, writer->ticks_hash());
  for (const fs::path& file : session_files(path_)) EXPECT_EQ(fs::exists(file), file == path_) << file;
}

TEST_P(SessionWithoutLog, LosesLessThanASecondWhenKilled) {
  for (const std::size_t ticks : {1u, 500u, 501u, 2750u}) {
    fs::remove(path_);
    write_and_be_killed(ticks);
    const OtherFileSystem other(GetParam());
    const auto session = load_session(path_);
    ASSERT_TRUE(session) << session.error().text();
    EXPECT_LE(session->samples.size(), ticks);
    EXPECT_GE(session->samples.size() + 501, ticks);
    EXPECT_FALSE(session->outcome);
    expect_first_samples(*session);
  }
}

// Killed before any of its writes, the file is what the last commit left, or the last but one.
TEST_P(SessionWithoutLog, IsIntactAfterAKillAtAnyWrite) {
  int interrupted_commits = 0;
  std::size_t longest = 0;
  for (int writes = 0; writes < 320; writes += 7) {
    for (const fs::path& file : session_files(path_)) fs::remove(file);
    write_and_be_killed(1600, writes);
    interrupted_commits += fs::exists(journal_) ? 1 : 0;
    const OtherFileSystem other(GetParam());
    const auto session = load_session(path_);
    if (!session) {
      // Before its first commit there is no session.
      EXPECT_EQ(longest, 0u) << session.error().text();
      continue;
    }
    expect_first_samples(*session);
    EXPECT_EQ(session->samples.size() % 500, 0u);
    EXPECT_GE(session->samples.size(), longest);
    longest = session->samples.size();
  }
  EXPECT_EQ(longest, 1500u);
  EXPECT_GT(interrupted_commits, 5);
}

TEST_P(SessionWithoutLog, IsCopiedWithItsRollbackJournal) {
  for (int writes = 150; !fs::exists(journal_) && writes < 200; ++writes) {
    for (const fs::path& file : session_files(path_)) fs::remove(file);
    write_and_be_killed(1600, writes);
  }
  ASSERT_TRUE(fs::exists(journal_));
  const fs::path copy = folder_ / "copy.session";
  ASSERT_TRUE(copy_session(path_, copy));
  EXPECT_TRUE(fs::exists(journal_));
  EXPECT_FALSE(fs::exists(copy.string() + "-journal"));
  const auto session = load_session(copy);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), load_session(path_)->samples.size());
}

TEST_P(SessionWithoutLog, IsReadableAndNotRenamedWhileBeingWritten) {
  const OtherFileSystem other(GetParam());
  auto writer = SessionWriter::create(path_, example_info());
  ASSERT_TRUE(writer);
  for (std::size_t n = 0; n < 1001; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
  const auto session = load_session(path_);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->samples.size(), 500u);
  const auto aside = set_aside_incomplete_session(path_);
  ASSERT_FALSE(aside);
  EXPECT_NE(aside.error().text().find("another program is writing"), std::string::npos) << aside.error().text();
  EXPECT_TRUE(writer->append(example_sample(1001)));
  EXPECT_TRUE(writer->finish(example_outcome(), {}));
  EXPECT_EQ(load_session(path_)->samples.size(), 1002u);
}

TEST_P(SessionWithoutLog, IsRenamedWhenItsProgramWasKilled) {
  write_and_be_killed(1200);
  const OtherFileSystem other(GetParam());
  const auto name = set_aside_incomplete_session(path_);
  ASSERT_TRUE(name) << name.error().text();
  ASSERT_TRUE(*name);
  EXPECT_EQ(load_session(**name)->samples.size(), 1000u);
  EXPECT_TRUE(SessionWriter::create(path_, example_info()));
}

TEST_P(SessionWithoutLog, LosesNothingWhileAnotherProgramReads) {
  const OtherFileSystem other(GetParam());
  auto writer = SessionWriter::create(path_, example_info());
  ASSERT_TRUE(writer);
  std::size_t tick = 0;
  const auto append_until = [&](std::size_t end) {
    for (; tick < end; ++tick) ASSERT_TRUE(writer->append(example_sample(tick)));
  };
  append_until(501);
  EXPECT_EQ(writer->saved_ticks(), 500u);
  {
    soci::session reader;
    detail::open_database(reader, path_);
    soci::rowset<soci::row> rows = reader.prepare << "SELECT * FROM ticks";
    ASSERT_NE(rows.begin(), rows.end());  // in the middle of reading
    append_until(2100);
    EXPECT_EQ(writer->saved_ticks(), 500u);
  }
  append_until(2600);
  EXPECT_GE(writer->saved_ticks(), 2000u);
  ASSERT_TRUE(writer->finish(example_outcome(), {}));
  const auto session = load_session(path_);
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->samples.size(), 2600u);
  expect_first_samples(*session);
}

// The session of a killed program is copied from a local folder to a network drive, with its log.
TEST_P(SessionWithoutLog, ALogOfAKilledProgramIsRead) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto writer = SessionWriter::create(path_, example_info());
    for (std::size_t n = 0; writer && n < 1200; ++n)
      if (!writer->append(example_sample(n))) ::_exit(3);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(fs::exists(path_.string() + "-wal"));
  const OtherFileSystem other(GetParam());
  const auto session = load_session(path_);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 1000u);
}

INSTANTIATE_TEST_SUITE_P(SharedMemory, SessionWithoutLog,
                         ::testing::Values(SharedMemory::kMissing, SharedMemory::kFails));

}  // namespace
}  // namespace trocar::storage
