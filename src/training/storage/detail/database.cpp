#include "storage/detail/database.h"

#include <fmt/format.h>

#include <condition_variable>
#include <memory>
#include <mutex>

#include "core/live/live_schedule.h"
#include "core/start_thread.h"
#include "storage/detail/checksums.h"
#include "storage/detail/columns.h"
#include "storage/detail/parameters_table.h"
#include "storage/detail/timed_table.h"
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

namespace {

// Reading a tick of about 500 bytes takes about 150 steps, up to three times.
constexpr std::int64_t kLeastSteps = 20'000'000;
constexpr std::int64_t kStepsAByte = 4;
constexpr int kStepsACall = 10'000;

std::int64_t size_of(const std::filesystem::path& path) {
  std::int64_t bytes = 0;
  for (const char* suffix : {"", "-wal"}) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path.string() + suffix, error);
    if (!error) bytes += static_cast<std::int64_t>(size);
  }
  return bytes;
}

void switch_to(sqlite_api::sqlite3* handle, int option, int value) {
  sqlite_api::sqlite3_db_config(handle, option, value, nullptr);
}

}  // namespace

GuardedDatabase::GuardedDatabase(const std::filesystem::path& path)
    : steps_left_(kLeastSteps + kStepsAByte * size_of(path)) {
  open_existing(session_, path);
  sqlite_api::sqlite3* const handle = handle_of(session_);
  switch_to(handle, SQLITE_DBCONFIG_DEFENSIVE, 1);
  switch_to(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0);
  switch_to(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0);
  switch_to(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0);
  sqlite_api::sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kMaxTextBytes);
  sqlite_api::sqlite3_limit(handle, SQLITE_LIMIT_ATTACHED, 0);
  sqlite_api::sqlite3_progress_handler(handle, kStepsACall, &GuardedDatabase::count_steps, this);
  session_ << "PRAGMA cell_size_check = ON";
  session_ << "PRAGMA query_only = ON";
}

int GuardedDatabase::count_steps(void* self) noexcept {
  auto& steps_left = static_cast<GuardedDatabase*>(self)->steps_left_;
  steps_left -= kStepsACall;
  return steps_left <= 0 ? 1 : 0;
}

bool GuardedDatabase::has_table(const std::string& name) {
  int count = 0;
  session_ << "SELECT count(*) FROM sqlite_master WHERE name = :name", soci::use(name), soci::into(count);
  return count > 0;
}

void GuardedDatabase::require_table(const std::string& name) {
  int tables = 0;
  int computed = 0;
  session_ << "SELECT count(*) FROM sqlite_master WHERE name = :name AND type = 'table' AND rootpage > 0",
      soci::use(name), soci::into(tables);
  if (tables != 1) throw soci::soci_error(fmt::format("\"{}\" is not a table", name));
  session_ << "SELECT count(*) FROM pragma_table_xinfo(:name) WHERE hidden <> 0", soci::use(name), soci::into(computed);
  if (computed != 0) throw soci::soci_error(fmt::format("the table \"{}\" has computed columns", name));
}

void SharedLock::take(soci::session& database) {
  sqlite_api::sqlite3* const handle = handle_of(database);
  sqlite_api::sqlite3_stmt* prepared = nullptr;
  const int state = sqlite_api::sqlite3_prepare_v2(handle, "SELECT key FROM info", -1, &prepared, nullptr);
  statement_.reset(prepared);
  if (state != SQLITE_OK || sqlite_api::sqlite3_step(prepared) != SQLITE_ROW)
    throw soci::soci_error(sqlite_api::sqlite3_errmsg(handle));
}

void set_wait(soci::session& database, int wait_ms) noexcept {
  sqlite_api::sqlite3_busy_timeout(handle_of(database), wait_ms);
}

bool is_busy(soci::session& database) noexcept {
  return (sqlite_api::sqlite3_errcode(handle_of(database)) & 0xff) == SQLITE_BUSY;
}

namespace {

constexpr int kNice = 5;

/// The writer starts the log again from its beginning if all of it was copied. What was committed during a checkpoint
/// is therefore copied at once, which is quicker than the first time. An error (another connection is busy, a full
/// disk) leaves the log whole; the next checkpoint tries again, and the last one, by the writer at the end, reports it.
void checkpoint(sqlite_api::sqlite3* database) {
  constexpr int kMostTries = 4;
  int pages = -1, copied = 0;
  for (int n = 0; n < kMostTries && pages != copied; ++n)
    sqlite_api::sqlite3_wal_checkpoint_v2(database, nullptr, SQLITE_CHECKPOINT_PASSIVE, &pages, &copied);
}

}  // namespace

Status WalCheckpointer::start(const std::filesystem::path& session, std::chrono::milliseconds interval) {
  const auto database = std::make_shared<soci::session>();
  TROCAR_TRY_STATUS(guarded("cannot open the session a second time", session, "free some file handles", [&] {
    open_database(*database, session);
    *database << "PRAGMA synchronous = NORMAL";
  }));
  TROCAR_TRY(thread_, start_stoppable_thread("checkpoint", [database, interval](const std::stop_token& stop) {
               lower_priority(kNice);
               std::mutex mutex;
               std::condition_variable_any wake;
               std::unique_lock lock(mutex);
               while (!wake.wait_for(lock, stop, interval, [&stop] { return stop.stop_requested(); }))
                 checkpoint(handle_of(*database));
             }));
  return {};
}

}  // namespace trocar::storage::detail
