#include "storage/detail/guarded_database.h"

#include <fmt/format.h>

namespace trocar::storage::detail {
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

}  // namespace trocar::storage::detail
