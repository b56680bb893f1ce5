#pragma once

#include <soci/soci.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/result.h"
#include "database/sqlite.h"
#include "database/statements.h"

namespace trocar::storage::detail {

/// "trcr": PRAGMA application_id of a session, which identifies it for `file` and for this program.
inline constexpr int kApplicationId = 0x74726372;

/// Opens the SQLite file (created if it is missing). Throws soci::soci_error.
void open_database(soci::session& database, const std::filesystem::path& path);

/// The same for a file that exists; its killed program's log is read also where it cannot be shared.
void open_existing(soci::session& database, const std::filesystem::path& path);

/// Throws soci::soci_error.
bool has_table(soci::session& database, const std::string& name);

/// The statements that give a new session its identity, tables and view.
std::vector<std::string> schema_statements();

using database::guarded;
using database::handle_of;
using database::pragma_integer;
using database::reason_of;

/// Longest text or row that is read from a session; a longer one is an error before it is loaded.
inline constexpr int kMaxTextBytes = 4 << 20;
/// Limit of all text together that is read from the table `info`.
inline constexpr std::size_t kMaxInfoBytes = std::size_t{16} << 20;
inline constexpr std::size_t kMaxInfoRows = 1024;
inline constexpr std::size_t kMaxNames = 1024;  ///< Names of tissues, layers, labels.
inline constexpr std::size_t kMaxNameBytes = 4096;
inline constexpr std::size_t kMaxShapeRows = 1'000'000;
inline constexpr std::size_t kMaxTransducerRows = 1'000'000;               ///< 2.8 hours at 100 Hz.
inline constexpr std::size_t kMaxParameterBytes = std::size_t{256} << 20;  ///< Each change holds a tissue table.
inline constexpr std::size_t kMaxChanges = 100'000;  ///< Changes of parameters, and interruptions.
inline constexpr std::size_t kMaxBlocks = 50'000;    ///< Blocks of ticks; 7 hours of half seconds.

/// A session that is opened for reading; its contents are not trusted. Nothing can be changed. Views, triggers and the
/// schema's own functions are off. Texts are bounded by kMaxTextBytes. The total work is bounded by a number of
/// SQLite's virtual machine steps that grows with the size of the file. A statement beyond these bounds fails.
class GuardedDatabase {
 public:
  /// Throws soci::soci_error.
  explicit GuardedDatabase(const std::filesystem::path& path);
  GuardedDatabase(const GuardedDatabase&) = delete;
  GuardedDatabase& operator=(const GuardedDatabase&) = delete;

  soci::session& session() noexcept { return session_; }
  /// Throws unless the name is an ordinary table: no view, no virtual table, no computed column.
  void require_table(const std::string& name);
  bool has_table(const std::string& name);
  bool is_exhausted() const noexcept { return steps_left_ <= 0; }  ///< The bound of work was reached.

 private:
  static int count_steps(void* self) noexcept;

  std::int64_t steps_left_;
  soci::session session_;
};

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

/// Checkpoints the write-ahead log of a session on a thread of its own: copies what was committed into the database
/// file, so that a recording program does not wait for the disk. The writer's connection then neither checkpoints nor
/// syncs (`wal_autocheckpoint` = 0, `synchronous` = OFF). A checkpoint syncs both files, as with `synchronous` =
/// NORMAL.
class WalCheckpointer {
 public:
  /// Opens a second connection. Error: it does not open, or no thread can start; then the writer checkpoints itself.
  Status start(const std::filesystem::path& session, std::chrono::milliseconds interval = std::chrono::seconds(5));
  /// Waits for the running checkpoint and closes the connection; the destructor does, too.
  void stop() noexcept { thread_ = {}; }

 private:
  std::jthread thread_;
};

}  // namespace trocar::storage::detail
