#pragma once

#include <memory>

#include "storage/detail/database.h"

namespace trocar::storage::detail {

/// A reading statement that is not at its end, so that SQLite keeps the shared lock of a file with a rollback journal
/// also between two commits: other programs may read the file, and see that it is in use.
class SharedLock {
 public:
  /// The table `info` has more than one row. Throws soci::soci_error.
  void take(soci::session& database);
  void release() noexcept { statement_.reset(); }

 private:
  struct Finalize {
    void operator()(sqlite_api::sqlite3_stmt* statement) const { sqlite_api::sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite_api::sqlite3_stmt, Finalize> statement_;
};

/// Time (ms) for which a statement waits for other programs.
void set_wait(soci::session& database, int wait_ms) noexcept;

/// True if the last statement failed because another program uses the file.
bool is_busy(soci::session& database) noexcept;

}  // namespace trocar::storage::detail
