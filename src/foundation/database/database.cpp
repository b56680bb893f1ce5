#include "database/database.h"

#include <fmt/format.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "core/files/atomic_file.h"
#include "core/files/private_file.h"
#include "database/guarded.h"
#include "database/server_connection.h"
#include "database/sqlite_handle.h"

namespace trocar::database {
namespace fs = std::filesystem;
namespace {

constexpr int kWaitForWriter_s = 10;
constexpr int kMostConflicts = 5;  ///< Repetitions of a transaction that others have hindered.

Status prepare_file(const fs::path& path, Missing missing) {
  std::error_code error;
  // SQLite alone may open the file and refuse it: closing it here would drop the locks of all connections of this
  // process (POSIX), and another process would remove the log that they use.
  if (fs::is_directory(path, error)) return fail("is a folder, not a database", path.string(), "name a file");
  if (fs::exists(path, error)) return {};
  if (missing == Missing::kRefuse) return fail("no such database", path.string(), "check the path");
  TROCAR_TRY_STATUS(make_parent_folder(path));
  // The names of people are in it. Another program may make it at the same time.
  Status made = write_private_file(path, "");
  return made || !fs::exists(path, error) ? made : Status();
}

Journal set_up_sqlite(soci::session& session, const fs::path& file) {
  open_sqlite(session, file, kWaitForWriter_s);
  Journal journal = set_journal(session, file, find_network_file_system(file));
  session << "PRAGMA synchronous = FULL";
  session << "PRAGMA foreign_keys = ON";
  session << "PRAGMA trusted_schema = OFF";
  session << "PRAGMA secure_delete = ON";  // otherwise deleted and changed names stay readable in the file
  return journal;
}

std::optional<Error> sqlite_error(int code, const std::string& where) {
  switch (code & 0xff) {  // the primary code
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Error{"another program is using the database", where, "try again in a moment"};
    case SQLITE_FULL:
      return Error{"the disk is full", where, "free space; nothing of this was written"};
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return Error{"the database is damaged", where,
                   "restore a backup, or save the readable part: sqlite3 FILE .recover"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return Error{"the database cannot be written", where, "check the permissions of the file and its folder"};
    case SQLITE_CANTOPEN:
      return Error{"the file cannot be read", where, "check the permissions of the file and its folder"};
    case SQLITE_IOERR:
      return Error{"reading or writing the disk failed", where, "check the disk and its free space"};
    default:
      return std::nullopt;
  }
}

bool is_not_a_database(const std::exception& error) {
  const auto* const sqlite = dynamic_cast<const soci::sqlite3_soci_error*>(&error);
  return sqlite != nullptr && (sqlite->result() & 0xff) == SQLITE_NOTADB;
}

/// The error of an exception in plain words. `session`: null before there is a connection.
Error error_of(const DatabaseUrl& url, const std::exception& error, soci::session* session) {
  std::optional<Error> known;
  if (url.is_sqlite()) {
    const auto* const sqlite = dynamic_cast<const soci::sqlite3_soci_error*>(&error);
    if (sqlite != nullptr || session != nullptr)
      known = sqlite_error(sqlite != nullptr ? sqlite->result() : sqlite_api::sqlite3_errcode(handle_of(*session)),
                           url.shown());
  } else {
    known = server_error(error, url.shown());
  }
  return known ? *known : Error{reason_of(error), url.shown(), "check the database", 1};
}

}  // namespace

Database::Database(DatabaseUrl url, Connection connection)
    : url_(std::move(url)), session_(std::move(connection.session)), journal_(std::move(connection.journal)) {}
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;
Database::~Database() = default;

Database::Connection Database::connect(const DatabaseUrl& url) {
  Connection made{std::make_unique<soci::session>(), {}};
  if (url.is_sqlite()) {
    made.journal = set_up_sqlite(*made.session, url.file);
  } else {
    open_server(*made.session, url.server);
  }
  return made;
}

std::string Database::note() const {
  if (journal_.obstacle.empty()) return {};
  return fmt::format(
      "the database has no write-ahead log ({}): {} is written with a rollback journal; programs wait for each other — "
      "use PostgreSQL for several computers",
      journal_.obstacle, url_.shown());
}

Result<Database> Database::open(const DatabaseUrl& url, Missing missing) {
  if (url.is_sqlite()) TROCAR_TRY_STATUS(prepare_file(url.file, missing));
  try {
    return Database(url, connect(url));
  } catch (const std::exception& error) {
    if (is_not_a_database(error)) return fail("is not a database", url.shown(), "name another file");
    Error reason = error_of(url, error, nullptr);
    reason.what = "the database cannot be opened: " + reason.what;
    return tl::unexpected(std::move(reason));
  }
}

bool Database::reconnect() noexcept {
  try {
    Connection made = connect(url_);
    session_ = std::move(made.session);
    journal_ = std::move(made.journal);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

/// Empty: no transaction.
const char* Database::begin_of(Kind kind) const noexcept {
  if (kind == Kind::kRead) return "";
  if (kind == Kind::kSnapshot) return is_sqlite() ? "BEGIN" : "BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY";
  return is_sqlite() ? "BEGIN IMMEDIATE" : "BEGIN";
}

Status Database::execute(const char* what, Kind kind, const std::function<bool(soci::session&)>& work) {
  int conflicts = 0;
  for (bool is_repeated = false;;) {
    bool is_open = false, is_committing = false;
    try {
      if (const std::string begin = begin_of(kind); !begin.empty()) {
        *session_ << begin;
        is_open = true;
      }
      const bool is_kept = work(*session_);
      is_committing = true;
      if (is_open) *session_ << (is_kept ? "COMMIT" : "ROLLBACK");
      return {};
    } catch (const std::exception& error) {
      Error translated = translate(what, error);
      const bool has_lost = !is_sqlite() && is_lost(*session_);
      if (is_open && !has_lost) {
        try {
          *session_ << "ROLLBACK";
        } catch (const std::exception&) {
          // SQLite has undone it already, as after a full disk.
        }
      }
      if (!has_lost && is_open && is_conflict(error) && ++conflicts <= kMostConflicts) continue;
      if (!has_lost) return tl::unexpected(std::move(translated));
      const bool is_connected = reconnect(), is_unknown = kind == Kind::kWrite && is_open && is_committing;
      if (is_connected && !std::exchange(is_repeated, true) && !is_unknown) continue;
      if (is_unknown)
        return fail("the connection was lost while data were committed: they may have been written or not",
                    url_.shown(), "repeat it: what was written already is recognised");
      return fail("the connection to the database was lost", url_.shown(), "check the network and the server");
    }
  }
}

Result<bool> Database::empty_log(std::chrono::milliseconds wait) {
  if (!is_sqlite() || !journal_.is_write_ahead) return true;
  const auto set_wait = [this](std::chrono::milliseconds time) {
    sqlite_api::sqlite3_busy_timeout(handle_of(*session_), static_cast<int>(time.count()));
  };
  set_wait(wait);
  const auto emptied = run("the write-ahead log cannot be emptied", [](soci::session& session) {
    int is_busy = 0, pages = 0, moved = 0;
    session << "PRAGMA wal_checkpoint(TRUNCATE)", soci::into(is_busy), soci::into(pages), soci::into(moved);
    return is_busy == 0;
  });
  set_wait(std::chrono::seconds(kWaitForWriter_s));
  return emptied;
}

Error Database::translate(const char* what, const std::exception& error) const {
  Error reason = error_of(url_, error, session_.get());
  reason.what = std::string(what) + ": " + reason.what;
  return reason;
}

}  // namespace trocar::database
