#include <fmt/format.h>

#include "storage/detail/database.h"
#include "storage/detail/shared_lock.h"
#include "storage/session_file.h"

namespace trocar::storage {
namespace fs = std::filesystem;
using namespace detail;
namespace {

/// True for a session without an outcome. One without ticks may not have its tables yet.
bool is_incomplete(soci::session& database) {
  if (pragma_integer(database, "application_id") != kApplicationId) return false;
  int tables = 0;
  int outcomes = 0;
  database << "SELECT count(*) FROM sqlite_master WHERE name = 'outcome' AND type = 'table'", soci::into(tables);
  if (tables > 0) database << "SELECT count(*) FROM outcome", soci::into(outcomes);
  return outcomes == 0;
}

/// A free name next to the session: first.incomplete.session, first.incomplete-2.session …
fs::path free_name(const fs::path& path) {
  std::error_code ignored;
  for (int n = 1;; ++n) {
    const std::string number = n == 1 ? std::string() : fmt::format("-{}", n);
    const fs::path name =
        path.parent_path() / fmt::format("{}.incomplete{}{}", path.stem().string(), number, path.extension().string());
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

/// One file with a rollback journal, which no other program uses. Throws soci::soci_error.
void take_alone(soci::session& database) {
  constexpr int kWaitForReader_ms = 200;
  set_wait(database, kWaitForReader_ms);
  std::string mode;
  database << "PRAGMA journal_mode = DELETE", soci::into(mode);
  if (mode != "delete") throw soci::soci_error("it is locked");
  database << "BEGIN EXCLUSIVE";
  database << "COMMIT";
}

/// True for the file of an interrupted program: an incomplete session, now in one file, or an empty file.
Result<bool> make_single(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  if (fs::file_size(path, ignored) == 0) return true;
  bool is_left = false;
  bool is_checked = false;
  const Status status = guarded("cannot write: another program is writing this session", path,
                                "wait for it, or choose another name", [&] {
                                  soci::session database;
                                  open_existing(database, path);
                                  is_left = is_incomplete(database);
                                  is_checked = true;
                                  if (is_left) take_alone(database);
                                });
  if (!is_checked) return false;  // not a database: a file of another program
  TROCAR_TRY_STATUS(status);
  return is_left;
}

}  // namespace

std::vector<fs::path> session_files(const fs::path& path) {
  return {path, path.string() + "-wal", path.string() + "-shm", path.string() + "-journal"};
}

Status copy_session(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy_file(from, to, error);
  for (const char* log : {"-wal", "-journal"}) {
    const fs::path beside = from.string() + log;
    if (!error && fs::exists(beside)) fs::copy_file(beside, to.string() + log, error);
  }
  if (error) return fail("the session cannot be copied: " + error.message(), from.string(), "check the free space");
  TROCAR_TRY_STATUS(make_single(to));
  return {};
}

Result<std::optional<fs::path>> set_aside_incomplete_session(const fs::path& path) {
  TROCAR_TRY(const bool is_left, make_single(path));
  if (!is_left) return std::nullopt;
  const fs::path name = free_name(path);
  std::error_code error;
  fs::rename(path, name, error);
  if (error)
    return fail("cannot rename the incomplete session: " + error.message(), path.string(), "choose another name");
  return name;
}

}  // namespace trocar::storage
