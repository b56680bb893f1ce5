#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "core/files/folders.h"
#include "database/database.h"
#include "database/sqlite.h"
#include "database/statements.h"
#include "database/testing/other_file_system.h"

namespace trocar::database {
namespace {
namespace fs = std::filesystem;
using testing::OtherFileSystem;
using testing::SharedMemory;

const std::vector<Migration> kSteps{{"CREATE TABLE rows (id {sequence}, writer BIGINT NOT NULL, data {bytes})"}};
constexpr int kJournalMark = 0x74657374;

Database opened(const fs::path& file) {
  auto database = Database::open({file, {}}, Missing::kCreate);
  EXPECT_TRUE(database) << database.error().text();
  const Status migrated = migrate(*database, kJournalMark, kSteps);
  EXPECT_TRUE(migrated) << migrated.error().text();
  return *std::move(database);
}

/// One transaction of `rows` rows of 4 kB: beyond the cache it is written to the file before it is committed.
Status add_rows(Database& database, int writer, int rows) {
  return database.transaction("cannot be written", [&](soci::session& session) {
    for (int n = 0; n < rows; ++n)
      session << "INSERT INTO rows (writer, data) VALUES (:w, zeroblob(4096))", soci::use(writer);
  });
}

int count_rows(Database& database) {
  const auto counted = database.run("cannot be read", [](soci::session& session) {
    int n = 0;
    session << "SELECT count(*) FROM rows", soci::into(n);
    return n;
  });
  return counted.value_or(-1);
}

std::string mode_of_file(Database& database) {
  std::string mode;
  database.session() << "PRAGMA journal_mode", soci::into(mode);
  return mode;
}

/// Bytes 18 and 19 of the file: 2 for a write-ahead log (fileformat2.html, 1.3).
bool is_marked_as_log(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  char head[20] = {};
  in.read(head, sizeof head);
  return head[18] == 2 || head[19] == 2;
}

template <class Work>
pid_t start_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    work();
    _exit(0);
  }
  return child;
}

int status_of(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

class WithoutSharedMemory : public ::testing::TestWithParam<SharedMemory> {
 protected:
  TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "a.sqlite";
};

TEST(Journal, IsAWriteAheadLogWithSharedMemory) {
  const TemporaryFolder folder;
  Database database = opened(folder / "a.sqlite");
  EXPECT_EQ(mode_of_file(database), "wal");
  EXPECT_EQ(database.note(), "");
}

TEST(Journal, IsARollbackJournalOnANetworkFileSystem) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.sqlite";
  { Database with_log = opened(file); }
  ASSERT_TRUE(is_marked_as_log(file));
  soci::session session;
  open_sqlite(session, file, 1);
  const Journal journal = set_journal(session, file, "nfs");
  EXPECT_FALSE(journal.is_write_ahead);
  EXPECT_EQ(journal.obstacle, "nfs is a network file system");
  EXPECT_FALSE(is_marked_as_log(file));
  EXPECT_EQ(pragma_integer(session, "synchronous"), 2);
}

TEST(Journal, StaysAWriteAheadLogWhileAnotherProgramUsesIt) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.sqlite";
  Database other = opened(file);
  ASSERT_EQ(count_rows(other), 0);
  soci::session session;
  open_sqlite(session, file, 0);
  EXPECT_THROW(set_journal(session, file, "nfs"), soci::soci_error);
  EXPECT_TRUE(add_rows(other, 1, 1));
}

TEST(NetworkFileSystem, IsDistinguishedFromALocalOne) {
  EXPECT_FALSE(find_network_file_system("/proc/self/status"));
  EXPECT_FALSE(find_network_file_system("/no/such/folder/file"));
}

TEST_P(WithoutSharedMemory, UsesARollbackJournalAndReportsIt) {
  const OtherFileSystem other(GetParam());
  Database database = opened(file_);
  EXPECT_EQ(mode_of_file(database), "delete");
  EXPECT_FALSE(is_marked_as_log(file_));
  EXPECT_EQ(pragma_integer(database.session(), "synchronous"), 2);
  EXPECT_NE(database.note().find("rollback journal"), std::string::npos) << database.note();
  EXPECT_TRUE(add_rows(database, 1, 3));
  Database second = opened(file_);
  EXPECT_EQ(count_rows(second), 3);
  EXPECT_EQ(mode_of_file(second), "delete");
}

// The last transaction of a killed program lies only in the log.
TEST_P(WithoutSharedMemory, ALogOfAKilledProgramIsRecovered) {
  const int status = status_of(start_child([&] {
    Database database = opened(file_);
    const bool is_added = add_rows(database, 1, 5).has_value();
    if (is_added) ::kill(::getpid(), SIGKILL);
  }));
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_GT(fs::file_size(file_.string() + "-wal"), 0u);
  const OtherFileSystem other(GetParam());
  Database database = opened(file_);
  EXPECT_EQ(count_rows(database), 5);
  EXPECT_EQ(mode_of_file(database), "delete");
  EXPECT_FALSE(fs::exists(file_.string() + "-wal"));
}

TEST_P(WithoutSharedMemory, TwoProgramsWriteWithoutLoss) {
  constexpr int kTransactions = 15;
  { Database made = opened(file_); }
  std::vector<pid_t> children;
  for (int writer = 1; writer <= 2; ++writer)
    children.push_back(start_child([&] {
      const OtherFileSystem other(GetParam());
      Database database = opened(file_);
      for (int n = 0; n < kTransactions; ++n)
        if (!add_rows(database, writer, 2) || count_rows(database) < 2 * (n + 1)) _exit(1);
    }));
  for (const pid_t child : children) EXPECT_EQ(status_of(child), 0);
  Database database = opened(file_);
  EXPECT_EQ(count_rows(database), 2 * 2 * kTransactions);
}

// 1000 rows of 4 kB do not fit into SQLite's cache of 2 MB, so that parts of the transaction are in the file.
TEST_P(WithoutSharedMemory, RollsBackAKilledTransaction) {
  int undone = 0;
  for (int writes = 5; writes < 3000; writes += 501) {
    fs::remove(file_);
    const int status = status_of(start_child([&] {
      const OtherFileSystem other(GetParam());
      Database database = opened(file_);
      if (!add_rows(database, 1, 10)) _exit(1);
      OtherFileSystem::die_after(writes);
      static_cast<void>(add_rows(database, 2, 1000));
      ::kill(::getpid(), SIGKILL);
    }));
    ASSERT_TRUE(WIFSIGNALED(status));
    undone += fs::exists(file_.string() + "-journal") ? 1 : 0;
    const OtherFileSystem other(GetParam());
    Database database = opened(file_);
    const int rows = count_rows(database);
    EXPECT_TRUE(rows == 10 || rows == 1010) << rows << " after " << writes << " writes";
    EXPECT_TRUE(add_rows(database, 3, 1));
    int check_rows = 0;
    database.session() << "SELECT count(*) FROM pragma_integrity_check WHERE integrity_check <> 'ok'",
        soci::into(check_rows);
    EXPECT_EQ(check_rows, 0);
  }
  EXPECT_GT(undone, 2);
}

INSTANTIATE_TEST_SUITE_P(SharedMemory, WithoutSharedMemory,
                         ::testing::Values(SharedMemory::kMissing, SharedMemory::kFails));

TEST(Journal, ReadsAReadOnlyFile) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.sqlite";
  {
    const OtherFileSystem other(SharedMemory::kMissing);  // without a mark of a log in the file
    Database database = opened(file);
    ASSERT_TRUE(add_rows(database, 1, 2));
  }
  fs::permissions(file, fs::perms{0444});
  fs::permissions(folder.path(), fs::perms{0555});
  const int status = status_of(start_child([&] {
    constexpr uid_t kNobody = 65534;  // Root may write anywhere.
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) _exit(2);
    Database database = opened(file);
    if (count_rows(database) != 2 || !database.note().empty()) _exit(3);
    const Status added = add_rows(database, 1, 1);
    _exit(!added && added.error().what.find("cannot be written") != std::string::npos ? 0 : 4);
  }));
  fs::permissions(folder.path(), fs::perms::owner_all);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace trocar::database
