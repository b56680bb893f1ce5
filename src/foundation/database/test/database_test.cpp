#include "database/database.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "core/files/folders.h"
#include "database/statements.h"

namespace trocar::database {
namespace {
namespace fs = std::filesystem;

constexpr int kMark = 0x74657374;
const std::vector<Migration> kFirst{
    {"CREATE TABLE numbers (id {sequence}, value BIGINT NOT NULL UNIQUE, data {bytes})"}};
const std::vector<Migration> kSecond{kFirst[0], {"ALTER TABLE numbers ADD COLUMN name TEXT NOT NULL DEFAULT ''"}};

class DatabaseFile : public ::testing::Test {
 protected:
  Database open(Missing missing = Missing::kCreate) {
    auto database = Database::open({file_, {}}, missing);
    EXPECT_TRUE(database) << database.error().text();
    return *std::move(database);
  }
  static Status add(Database& database, int value) {
    return database.transaction("cannot be written", [&](soci::session& session) {
      session << "INSERT INTO numbers (value) VALUES (:v)", soci::use(value);
    });
  }
  static int count(Database& database) {
    return database
        .run("cannot be read",
             [](soci::session& session) {
               int n = 0;
               session << "SELECT count(*) FROM numbers", soci::into(n);
               return n;
             })
        .value_or(-1);
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "new" / "a.sqlite";
};

TEST_F(DatabaseFile, IsCreatedForThisUserOnly) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  struct stat status {};
  ASSERT_EQ(stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

/// True if another process sees a lock of this one on the bytes that SQLite locks (fileformat2.html, 1.2: lock bytes).
bool is_locked_for_others(const fs::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = 0x40000000;
    lock.l_len = 512;
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    const bool is_known = descriptor >= 0 && fcntl(descriptor, F_GETLK, &lock) == 0;
    _exit(is_known && lock.l_type != F_UNLCK ? 1 : 0);
  }
  int status = 0;
  return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 1;
}

// Without its lock another process believes to be alone, and removes the log that this one still uses.
TEST_F(DatabaseFile, StaysLockedWhenReopened) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  ASSERT_TRUE(is_locked_for_others(file_));
  {
    Database second = open(Missing::kRefuse);
    EXPECT_EQ(count(second), 0);
    EXPECT_TRUE(is_locked_for_others(file_));
  }
  EXPECT_TRUE(is_locked_for_others(file_));
}

TEST_F(DatabaseFile, RollsBackAFailedTransaction) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  ASSERT_TRUE(add(database, 1));
  const Status twice = database.transaction("cannot be written", [](soci::session& session) {
    session << "INSERT INTO numbers (value) VALUES (2)";
    session << "INSERT INTO numbers (value) VALUES (1)";  // not unique
  });
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().what.find("soci"), std::string::npos);
  const Status refused = database.transaction("cannot be written", [](soci::session& session) -> Status {
    session << "INSERT INTO numbers (value) VALUES (3)";
    return fail("refused");
  });
  EXPECT_EQ(refused.error().what, "refused");
  EXPECT_EQ(count(database), 1);
  EXPECT_TRUE(add(database, 4));  // the connection can still be used
}

TEST_F(DatabaseFile, IsMigratedStepByStepAndOnlyUpwards) {
  {
    Database database = open();
    ASSERT_TRUE(migrate(database, kMark, kFirst));
    ASSERT_TRUE(add(database, 7));
  }
  {
    Database database = open();
    ASSERT_TRUE(migrate(database, kMark, kSecond));
    ASSERT_TRUE(migrate(database, kMark, kSecond));
    EXPECT_EQ(count(database), 1);
  }
  Database database = open();
  const Status older = migrate(database, kMark, kFirst);
  ASSERT_FALSE(older);
  EXPECT_NE(older.error().what.find("schema 2, this program knows up to 1"), std::string::npos);
  EXPECT_EQ(count(database), 1);
}

TEST_F(DatabaseFile, RefusesAnotherProgramsFileUnchanged) {
  {
    Database database = open();
    ASSERT_TRUE(database.run("x", [](soci::session& session) { session << "CREATE TABLE theirs (a INTEGER)"; }));
  }
  Database database = open();
  const Status status = migrate(database, kMark, kFirst);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "belongs to another program");
  ASSERT_TRUE(database.run("x", [](soci::session& session) { session << "INSERT INTO theirs VALUES (1)"; }));
}

TEST_F(DatabaseFile, RefusesAnotherApplicationId) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  EXPECT_FALSE(migrate(database, kMark + 1, kSecond));
}

TEST_F(DatabaseFile, MigratesOnceUnderConcurrency) {
  std::vector<Status> done(6);
  {
    std::vector<std::jthread> threads;
    for (Status& one : done)
      threads.emplace_back([&] {
        auto database = Database::open({file_, {}}, Missing::kCreate);
        one = database ? migrate(*database, kMark, kSecond) : Status(tl::unexpected(database.error()));
        for (int n = 0; one && n < 20; ++n) {
          const int value = static_cast<int>(&one - done.data()) * 100 + n;
          one = add(*database, value);
        }
      });
  }
  for (const Status& one : done) EXPECT_TRUE(one) << one.error().text();
  Database database = open(Missing::kRefuse);
  EXPECT_EQ(count(database), 120);
}

TEST_F(DatabaseFile, ReportsAFullDisk) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  // As on a full disk: the file may not grow further.
  ASSERT_TRUE(database.run("x", [](soci::session& session) { session << "PRAGMA max_page_count = 1"; }));
  const std::string big(100'000, 'x');
  const Status status = database.transaction("the number cannot be written", [&](soci::session& session) {
    session << "INSERT INTO numbers (value, data) VALUES (1, :d)", soci::use(big);
  });
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().text().find("the number cannot be written: the disk is full"), std::string::npos);
  EXPECT_EQ(count(database), 0);
}

TEST_F(DatabaseFile, ReportsANonDatabaseFile) {
  fs::create_directories(file_.parent_path());
  const auto error_of = [&] { return Database::open({file_, {}}, Missing::kRefuse).error().what; };
  EXPECT_EQ(error_of(), "no such database");
  std::ofstream(file_) << "this is a letter, and no database";
  EXPECT_EQ(error_of(), "is not a database");
  EXPECT_EQ(fs::file_size(file_), 33U);
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_EQ(error_of(), "is a folder, not a database");
}

TEST_F(DatabaseFile, ReportsDamage) {
  {
    Database database = open();
    ASSERT_TRUE(migrate(database, kMark, kFirst));
    for (int n = 0; n < 50; ++n) ASSERT_TRUE(add(database, n));
  }
  std::fstream file(file_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(100);
  for (int n = 0; n < 4000; ++n) file.put('\x5a');
  file.close();
  auto database = Database::open({file_, {}}, Missing::kRefuse);
  const Error error = database ? migrate(*database, kMark, kSecond).error() : database.error();
  EXPECT_NE(error.what.find("damaged"), std::string::npos) << error.text();
}

TEST_F(DatabaseFile, RoundTripsEveryByte) {
  Database database = open();
  ASSERT_TRUE(migrate(database, kMark, kFirst));
  std::string bytes;
  for (int n = 0; n < 1024; ++n) bytes += static_cast<char>(n % 256);
  ASSERT_TRUE(database.transaction("x", [&](soci::session& session) {
    const std::string bound = bind_bytes(database, bytes);
    session << "INSERT INTO numbers (value, data) VALUES (1, " + bytes_in(database, ":d") + ")", soci::use(bound);
  }));
  const auto read = database.run("x", [&](soci::session& session) {
    std::string text;
    session << "SELECT " + bytes_out(database, "data") + " FROM numbers", soci::into(text);
    return from_bytes(database, text);
  });
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, bytes);
}

}  // namespace
}  // namespace trocar::database
