#include "database/statements.h"

#include <fmt/format.h>

#include <algorithm>

#include "database/sqlite.h"

namespace trocar::database {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

std::string to_hex(std::string_view bytes) {
  std::string hex;
  hex.reserve(2 * bytes.size());
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    hex += kDigits[value >> 4U];
    hex += kDigits[value & 15U];
  }
  return hex;
}

std::string from_hex(std::string_view hex) {
  std::string bytes;
  bytes.reserve(hex.size() / 2);
  for (std::size_t n = 0; n + 1 < hex.size(); n += 2) {
    const std::size_t high = kDigits.find(hex[n]), low = kDigits.find(hex[n + 1]);
    if (high == std::string_view::npos || low == std::string_view::npos)
      throw soci::soci_error("binary data are damaged");
    bytes += static_cast<char>(high * 16 + low);
  }
  return bytes;
}

}  // namespace

std::string bytes_in(const Database& database, const std::string& placeholder) {
  // SQLite keeps a bound text as text, with its NUL bytes, unless it is told otherwise.
  return database.is_sqlite() ? "CAST(" + placeholder + " AS BLOB)" : "decode(" + placeholder + ", 'hex')";
}

std::string bytes_out(const Database& database, const std::string& column) {
  return database.is_sqlite() ? column : "encode(" + column + ", 'hex')";
}

std::string bind_bytes(const Database& database, std::string_view bytes) {
  return database.is_sqlite() ? std::string(bytes) : to_hex(bytes);
}

std::string from_bytes(const Database& database, std::string text) {
  return database.is_sqlite() ? text : from_hex(text);
}

std::string reason_of(const std::exception& error) {
  std::string text = error.what();
  if (const std::size_t end = text.find(" while "); end != std::string::npos) text.resize(end);
  if (const std::size_t colon = text.rfind(": "); colon != std::string::npos) text.erase(0, colon + 2);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

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
