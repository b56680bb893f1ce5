#include "storage/detail/database.h"

#include <fmt/format.h>

#include "storage/detail/action_table.h"
#include "storage/detail/checksums.h"
#include "storage/detail/columns.h"
#include "storage/detail/parameters_table.h"
#include "storage/detail/shape_table.h"
#include "storage/detail/transducer_table.h"
#include "storage/detail/xray_table.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {
namespace {

/// The words of the enumerators instead of their numbers.
template <class Enum>
std::string words_of(const char* column, Enum value) {
  std::string text = fmt::format("CASE t.{}", column);
  for (int i = 0; i <= static_cast<int>(last_of(value)); ++i)
    text += fmt::format(" WHEN {} THEN '{}'", i, to_string(static_cast<Enum>(i)));
  return text + fmt::format(" END AS {}", column);
}

/// Columns of the view, which has names instead of the table's numbers.
std::string view_columns() {
  std::string list;
  const telemetry::TickSample sample;
  visit_columns(sample, [&](const char* name, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    if (!list.empty()) list += ", ";
    if constexpr (std::is_same_v<Field, std::uint8_t>)
      list += fmt::format("(SELECT name FROM tissues WHERE id = t.{0}) AS {0}", name);
    else if constexpr (std::is_same_v<Field, telemetry::InsertionPhase>)
      list += fmt::format("(SELECT name FROM phases WHERE id = t.{0}) AS {0}", name);
    else if constexpr (std::is_enum_v<Field>)
      list += words_of(name, field);
    else if constexpr (std::is_same_v<Field, telemetry::TickEvents>)
      list += fmt::format(
          "coalesce((SELECT group_concat(text, ';') FROM ({} UNION ALL SELECT text FROM (SELECT text FROM events e"
          " WHERE e.tick = t.tick ORDER BY slot))), '') AS {}",
          parameters_events_sql(), name);
    else
      list += fmt::format("t.{}", name);
  });
  return list;
}

}  // namespace

void open_database(soci::session& database, const std::filesystem::path& path) {
  constexpr int kWaitForWriter_s = 5;
  database::open_sqlite(database, path, kWaitForWriter_s);
}

void open_existing(soci::session& database, const std::filesystem::path& path) {
  open_database(database, path);
  try {
    pragma_integer(database, "application_id");
  } catch (const soci::soci_error&) {
    // The write-ahead log of a killed program, in a folder whose file system shares no memory.
    if (!std::filesystem::exists(path.string() + "-wal")) throw;
    database::read_without_shared_memory(database);
  }
}

bool has_table(soci::session& database, const std::string& name) {
  int count = 0;
  database << "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = :name", soci::use(name),
      soci::into(count);
  return count > 0;
}

std::vector<std::string> schema_statements() {
  std::string ticks = "CREATE TABLE ticks (tick INTEGER PRIMARY KEY";
  const telemetry::TickSample sample;
  visit_stored_columns(sample, [&](const char* name, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    ticks += fmt::format(", {} {}", name, kIsReal<Field> ? "REAL" : "INTEGER NOT NULL");
  });
  std::vector<std::string> statements{fmt::format("PRAGMA application_id = {}", kApplicationId),
                                      fmt::format("PRAGMA user_version = {}", kSessionFormatVersion),
                                      "CREATE TABLE info (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"};
  for (const char* table : {"tissues", "layers", "labels", "phases"})
    statements.push_back(fmt::format("CREATE TABLE {} (id INTEGER PRIMARY KEY, name TEXT NOT NULL)", table));
  statements.push_back(ticks + ")");
  statements.emplace_back(
      "CREATE TABLE events (tick INTEGER NOT NULL, slot INTEGER NOT NULL, kind INTEGER NOT NULL, id INTEGER NOT NULL, "
      "text TEXT NOT NULL, PRIMARY KEY (tick, slot)) WITHOUT ROWID");
  statements.push_back(schema_of(transducer_table()));
  statements.push_back(schema_of(xray_table()));
  statements.push_back(schema_of(action_table()));
  statements.push_back(shape_schema());
  for (std::string& statement : checksum_schema()) statements.push_back(std::move(statement));
  for (std::string& statement : parameters_schema()) statements.push_back(std::move(statement));
  statements.emplace_back(
      "CREATE TABLE outcome (score REAL, target_reached INTEGER NOT NULL, fired_tick INTEGER, json TEXT NOT NULL)");
  statements.push_back(
      fmt::format("CREATE VIEW session_rows AS SELECT {} FROM ticks t ORDER BY t.tick", view_columns()));
  return statements;
}

}  // namespace trocar::storage::detail
