#include "storage/detail/shared_lock.h"

namespace trocar::storage::detail {

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

}  // namespace trocar::storage::detail
