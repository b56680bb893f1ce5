// States of a database that others change meanwhile.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "core/files/folders.h"
#include "database/testing/postgres_server.h"

namespace trocar::database {
namespace {

class WriteConflict : public ::testing::TestWithParam<std::string> {
 protected:
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    url_ = {folder_ / "a.sqlite", {}};
    if (GetParam() == "postgresql") {
      if (testing::PostgresServer::programs().empty()) GTEST_SKIP() << "PostgreSQL is not installed";
      if (!server_) server_ = std::make_unique<testing::PostgresServer>();
      url_ = server_->make_database();
    }
    first_.emplace(open());
    second_.emplace(open());
    ASSERT_TRUE(first_->transaction("x", [](soci::session& session) {
      session << "CREATE TABLE numbers (id INTEGER PRIMARY KEY, value INTEGER NOT NULL)";
      session << "INSERT INTO numbers VALUES (1, 0)";
      session << "INSERT INTO numbers VALUES (2, 0)";
    }));
  }
  Database open() const {
    auto database = Database::open(url_, Missing::kCreate);
    EXPECT_TRUE(database) << database.error().text();
    return *std::move(database);
  }
  static int sum(soci::session& session) {
    int value = 0;
    session << "SELECT sum(value) FROM numbers", soci::into(value);
    return value;
  }

  static inline std::unique_ptr<testing::PostgresServer> server_;
  TemporaryFolder folder_;
  DatabaseUrl url_;
  std::optional<Database> first_, second_;
};
INSTANTIATE_TEST_SUITE_P(Both, WriteConflict, ::testing::Values("sqlite", "postgresql"),
                         [](const ::testing::TestParamInfo<std::string>& tested) { return tested.param; });

TEST_P(WriteConflict, IsInvisibleInASnapshot) {
  ASSERT_TRUE(first_->snapshot("x", [&](soci::session& session) {
    EXPECT_EQ(sum(session), 0);
    ASSERT_TRUE(second_->transaction("x", [](soci::session& other) { other << "UPDATE numbers SET value = 1"; }));
    EXPECT_EQ(sum(session), 0);
  }));
  EXPECT_EQ(first_->snapshot("x", [](soci::session& session) { return sum(session); }).value(), 2);
}

/// Two that lock the same rows in another order: the server ends one of them, which is repeated.
TEST_P(WriteConflict, RetriesADeadlock) {
  std::atomic<int> arrived{0};
  const auto add = [&](Database& database, int from, int to) {
    bool is_first_try = true;
    return database.transaction("x", [&](soci::session& session) {
      session << "UPDATE numbers SET value = value + 1 WHERE id = :i", soci::use(from);
      // SQLite lets only one of them come so far.
      if (is_first_try && !database.is_sqlite()) {
        is_first_try = false;
        ++arrived;
        while (arrived < 2) std::this_thread::yield();
      }
      session << "UPDATE numbers SET value = value + 1 WHERE id = :i", soci::use(to);
    });
  };
  Status other;
  {
    const std::jthread thread([&] { other = add(*second_, 2, 1); });
    const Status own = add(*first_, 1, 2);
    EXPECT_TRUE(own) << own.error().text();
  }
  EXPECT_TRUE(other) << other.error().text();
  EXPECT_EQ(first_->run("x", [](soci::session& session) { return sum(session); }).value(), 4);
}

TEST_P(WriteConflict, FailsAfterRepeatedConflicts) {
  int tries = 0;
  const Status twice = first_->transaction("x", [&](soci::session& session) {
    ++tries;
    session << "INSERT INTO numbers VALUES (1, 5)";
  });
  EXPECT_FALSE(twice);
  EXPECT_LE(tries, 10);
  EXPECT_EQ(first_->run("x", [](soci::session& session) { return sum(session); }).value(), 0);
}

TEST(EmptyLog, TruncatesTheLogUnlessAReaderUsesIt) {
  const TemporaryFolder folder;
  auto database = Database::open({folder / "a.sqlite", {}}, Missing::kCreate),
       other = Database::open({folder / "a.sqlite", {}}, Missing::kCreate);
  ASSERT_TRUE(database && other);
  const auto write = [&] {
    ASSERT_TRUE(database->transaction("x", [](soci::session& session) {
      session << "CREATE TABLE IF NOT EXISTS texts (text TEXT)";
      session << "INSERT INTO texts VALUES ('a')";
    }));
  };
  const auto log_size = [&] { return std::filesystem::file_size(folder / "a.sqlite-wal"); };
  write();
  EXPECT_GT(log_size(), 0u);
  ASSERT_TRUE(other->snapshot("x", [&](soci::session& session) {
    int count = 0;
    session << "SELECT count(*) FROM texts", soci::into(count);
    write();
    EXPECT_FALSE(database->empty_log(std::chrono::milliseconds(0)).value());
    EXPECT_GT(log_size(), 0u);
  }));
  EXPECT_TRUE(database->empty_log(std::chrono::milliseconds(0)).value());
  EXPECT_EQ(log_size(), 0u);
}

}  // namespace
}  // namespace trocar::database
