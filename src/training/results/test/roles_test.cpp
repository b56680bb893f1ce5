// The roles of packaging/postgresql_roles.sql: every other test of PostgreSQL in this module runs with the writer's
// rights.
#include "results/detail/schema.h"
#include "results_lab.h"

namespace trocar::results {
namespace {

class Roles : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!database::testing::PostgresServer::programs().empty())
      server_ = std::make_unique<database::testing::PostgresServer>();
  }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    if (!server_) GTEST_SKIP() << "PostgreSQL is not installed";
    auto made = server_->make_database_with_roles();
    ASSERT_TRUE(made) << made.error().text();
    roles_ = *std::move(made);
  }
  static Status run(const database::DatabaseUrl& url, const std::string& statement) {
    TROCAR_TRY(auto database, database::Database::open(url, database::Missing::kRefuse));
    return database.run("refused", [&](soci::session& session) { session << statement; });
  }

  static inline std::unique_ptr<database::testing::PostgresServer> server_;
  database::testing::PostgresServer::Roles roles_;
};

TEST_F(Roles, WriterCannotCreateTables) {
  const auto made = Repository::open(roles_.writer);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text().find("the user may not do this"), std::string::npos) << made.error().text();
  EXPECT_NE(made.error().text().find("owner"), std::string::npos) << made.error().text();
  ASSERT_TRUE(Repository::open(roles_.owner));
  EXPECT_TRUE(Repository::open(roles_.writer));
}

TEST_F(Roles, WriterCanOnlyChangeRows) {
  ASSERT_TRUE(Repository::open(roles_.owner));
  EXPECT_TRUE(run(roles_.writer, "DELETE FROM people"));
  for (const char* statement :
       {"DROP TABLE people", "ALTER TABLE people ADD COLUMN x TEXT", "CREATE TABLE x (y TEXT)", "TRUNCATE people",
        "CREATE INDEX x ON people (added_s)", "CREATE SCHEMA x", "SELECT setval('attempts_sequence_seq', 1)",
        "SELECT setval('notes_number_seq', 1)", "CREATE ROLE x"})
    EXPECT_FALSE(run(roles_.writer, statement)) << statement;
}

/// An update makes tables and changes others while the writers' rights stay.
TEST_F(Roles, AreKeptByAnUpdate) {
  {
    auto old = database::Database::open(roles_.owner, database::Missing::kRefuse);
    ASSERT_TRUE(old);
    ASSERT_TRUE(database::migrate(*old, kApplicationId, detail::migrations().first(1)));
  }
  EXPECT_FALSE(Repository::open(roles_.writer)) << "an older schema needs the owner";
  ASSERT_TRUE(Repository::open(roles_.owner));
  auto writer = Repository::open(roles_.writer);
  ASSERT_TRUE(writer) << writer.error().text();
  const auto person = add_person(*writer, {"Anna"}, Seconds());
  ASSERT_TRUE(person) << person.error().text();
  EXPECT_TRUE(delete_person(*writer, person->id));
  for (const char* statement : {"SELECT nextval('notes_number_seq')", "DELETE FROM notes"})
    EXPECT_TRUE(run(roles_.writer, statement)) << statement;
}

/// A database that another user has made is taken over.
TEST_F(Roles, AreGrantedOnAnExistingDatabase) {
  const database::DatabaseUrl made = server_->make_database();
  {
    auto administrator = Repository::open(made);
    ASSERT_TRUE(administrator);
    ASSERT_TRUE(add_person(*administrator, {"Anna"}, Seconds()));
  }
  const auto roles = server_->give_roles(made);
  ASSERT_TRUE(roles) << roles.error().text();
  auto writer = Repository::open(roles->writer);
  ASSERT_TRUE(writer) << writer.error().text();
  EXPECT_TRUE(get_person_named(*writer, "Anna"));
  EXPECT_TRUE(run(roles->owner, "ALTER TABLE people ADD COLUMN x TEXT"));
}

}  // namespace
}  // namespace trocar::results
