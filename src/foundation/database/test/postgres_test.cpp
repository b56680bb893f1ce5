#include <gtest/gtest.h>

#include <thread>

#include "database/statements.h"
#include "database/testing/postgres_server.h"

namespace trocar::database {
namespace {

const std::vector<Migration> kSchema{
    {"CREATE TABLE numbers (id {sequence}, value BIGINT NOT NULL UNIQUE, real DOUBLE PRECISION, data {bytes})"}};

class Postgres : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!testing::PostgresServer::programs().empty()) server_ = std::make_unique<testing::PostgresServer>();
  }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    if (!server_) GTEST_SKIP() << "PostgreSQL is not installed";
    ASSERT_TRUE(server_->is_running());
    url_ = server_->make_database();
  }

  Database open() const {
    auto database = Database::open(url_, Missing::kRefuse);
    EXPECT_TRUE(database) << database.error().text();
    return *std::move(database);
  }
  static Status add(Database& database, long long value) {
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

  static inline std::unique_ptr<testing::PostgresServer> server_;
  DatabaseUrl url_;
};

TEST_F(Postgres, RollsBackAFailedTransaction) {
  Database database = open();
  ASSERT_TRUE(migrate(database, 1, kSchema));
  ASSERT_TRUE(add(database, 1));
  const Status twice = database.transaction("cannot be written", [](soci::session& session) {
    session << "INSERT INTO numbers (value) VALUES (2)";
    session << "INSERT INTO numbers (value) VALUES (1)";
  });
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().what.find('\n'), std::string::npos);
  EXPECT_EQ(count(database), 1);
  EXPECT_TRUE(add(database, 4));
}

TEST_F(Postgres, KeepsEveryByteAndBit) {
  Database database = open();
  ASSERT_TRUE(migrate(database, 1, kSchema));
  std::string bytes;
  for (int n = 0; n < 1024; ++n) bytes += static_cast<char>(n % 256);
  const double real = 0.1 + 0.2;
  ASSERT_TRUE(database.transaction("x", [&](soci::session& session) {
    const std::string bound = bind_bytes(database, bytes);
    session << "INSERT INTO numbers (value, real, data) VALUES (1, :r, " + bytes_in(database, ":d") + ")",
        soci::use(real), soci::use(bound);
  }));
  std::string read_bytes;
  double read_real = 0.0;
  ASSERT_TRUE(database.run("x", [&](soci::session& session) {
    std::string text;
    session << "SELECT real, " + bytes_out(database, "data") + " FROM numbers", soci::into(read_real), soci::into(text);
    read_bytes = from_bytes(database, text);
  }));
  EXPECT_EQ(read_bytes, bytes);
  EXPECT_EQ(read_real, real);
}

TEST_F(Postgres, MigratesOnceUnderConcurrency) {
  std::vector<Status> done(6);
  {
    std::vector<std::jthread> threads;
    for (Status& one : done)
      threads.emplace_back([&] {
        auto database = Database::open(url_, Missing::kRefuse);
        one = database ? migrate(*database, 1, kSchema) : Status(tl::unexpected(database.error()));
        for (int n = 0; one && n < 20; ++n) one = add(*database, (&one - done.data()) * 100 + n);
      });
  }
  for (const Status& one : done) EXPECT_TRUE(one) << one.error().text();
  Database database = open();
  EXPECT_EQ(count(database), 120);
}

TEST_F(Postgres, RefusesANewerSchema) {
  Database database = open();
  const std::vector<Migration> newer{kSchema[0], {"ALTER TABLE numbers ADD COLUMN name TEXT"}};
  ASSERT_TRUE(migrate(database, 1, newer));
  const Status older = migrate(database, 1, kSchema);
  ASSERT_FALSE(older);
  EXPECT_NE(older.error().what.find("schema 2, this program knows up to 1"), std::string::npos);
}

TEST_F(Postgres, ReportsWhyItCannotBeOpened) {
  const auto error_of = [](const std::string& url) {
    const auto database = Database::open({{}, url}, Missing::kRefuse);
    return database ? std::string("opened") : database.error().text();
  };
  EXPECT_NE(error_of(server_->url("postgres", "wrong")).find("refuses the user or the password"), std::string::npos);
  EXPECT_EQ(error_of(server_->url("postgres", "wrong")).find("wrong"), std::string::npos);
  EXPECT_NE(error_of(server_->url("nothing")).find("no such database"), std::string::npos);
  EXPECT_NE(error_of("postgresql://a@127.0.0.1:1/b").find("no server answers"), std::string::npos);
  EXPECT_NE(error_of("postgresql://a@h/b?nonsense=1").find("the URL is not understood"), std::string::npos);
}

TEST_F(Postgres, ReconnectsAfterARestartOfTheServer) {
  Database database = open();
  ASSERT_TRUE(migrate(database, 1, kSchema));
  ASSERT_TRUE(add(database, 1));
  server_->stop();
  const Status lost = add(database, 2);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().what, "the connection to the database was lost");
  server_->run();
  EXPECT_TRUE(add(database, 3));
  EXPECT_EQ(count(database), 2);
  server_->stop();
  server_->run();
  EXPECT_EQ(count(database), 2);  // the work is repeated on a new connection
}

}  // namespace
}  // namespace trocar::database
