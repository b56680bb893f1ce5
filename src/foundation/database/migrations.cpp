#include "database/migrations.h"

#include <fmt/format.h>

#include "database/sqlite_handle.h"

namespace trocar::database {
namespace {

/// Any number that other programs do not use for the same lock: only one program at a time migrates a server's
/// database.
constexpr long long kMigrationLock = 0x74726372;

std::string with_types(std::string statement, bool is_sqlite) {
  const auto replace = [&](std::string_view word, std::string_view type) {
    for (std::size_t at = 0; (at = statement.find(word, at)) != std::string::npos; at += type.size())
      statement.replace(at, word.size(), type);
  };
  replace("{bytes}", is_sqlite ? "BLOB" : "BYTEA");
  replace("{sequence}", is_sqlite ? "INTEGER PRIMARY KEY AUTOINCREMENT" : "BIGSERIAL PRIMARY KEY");
  return statement;
}

int count_tables(soci::session& session, bool is_sqlite, const std::string& named) {
  int count = 0;
  const std::string query =
      is_sqlite ? "SELECT count(*) FROM sqlite_master WHERE type = 'table'"
                : "SELECT count(*) FROM information_schema.tables WHERE table_schema = current_schema()";
  const std::string name = is_sqlite ? "name" : "table_name";
  session << query + (named.empty() ? "" : " AND " + name + " = '" + named + "'"), soci::into(count);
  return count;
}

/// The version in the table `schema_version`; 0: a new database; empty: another program's.
std::optional<int> read_version(soci::session& session, bool is_sqlite) {
  if (count_tables(session, is_sqlite, "schema_version") == 0)
    return count_tables(session, is_sqlite, "") == 0 ? std::optional(0) : std::nullopt;
  int version = 0;
  session << "SELECT version FROM schema_version", soci::into(version);
  return version;
}

}  // namespace

Status migrate(Database& database, int application_id, std::span<const Migration> migrations) {
  const bool is_sqlite = database.is_sqlite();
  const std::string where = database.url().shown();
  const int newest = static_cast<int>(migrations.size());
  const auto foreign = [&]() -> Status {
    return fail("belongs to another program", where, "name another database, or an empty one");
  };
  // Reading first: opening a database that is up to date does not wait for a writer.
  TROCAR_TRY(const std::optional<int> found, database.run("the database cannot be read", [&](soci::session& session) {
    return read_version(session, is_sqlite);
  }));
  if (found == newest) return {};
  return database.transaction("the database cannot be brought up to date", [&](soci::session& session) -> Status {
    if (!is_sqlite) session << "SELECT pg_advisory_xact_lock(" + std::to_string(kMigrationLock) + ")";
    const std::optional<int> version = read_version(session, is_sqlite);
    if (!version) return foreign();
    if (is_sqlite && *version > 0 && pragma_integer(session, "application_id") != application_id) return foreign();
    if (*version > newest)
      return fail(fmt::format("the database has schema {}, this program knows up to {}", *version, newest), where,
                  "use the newer program that wrote it");
    for (int step = *version; step < newest; ++step)
      for (const std::string& statement : migrations[static_cast<std::size_t>(step)])
        session << with_types(statement, is_sqlite);
    if (*version == 0) {
      session << "CREATE TABLE schema_version (version INTEGER NOT NULL)";
      session << "INSERT INTO schema_version VALUES (0)";
      if (is_sqlite) session << fmt::format("PRAGMA application_id = {}", application_id);
    }
    session << fmt::format("UPDATE schema_version SET version = {}", newest);
    return {};
  });
}

}  // namespace trocar::database
