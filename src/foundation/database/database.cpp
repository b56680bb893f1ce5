#include "database/database.h"

#include <fmt/format.h>
#include <libpq-fe.h>
#include <soci/postgresql/soci-postgresql.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <array>
#include <exception>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/output_file.h"
#include "core/result.h"
#include "database/sqlite.h"
#include "database/statements.h"

namespace trocar::database {

/// Opens a connection to a PostgreSQL server. Limits of time are added where the URL has none. Throws soci::soci_error.
void open_server(soci::session& session, const std::string& url);

/// True if the connection is broken.
bool is_lost(soci::session& session) noexcept;

/// True if another transaction has hindered this one, and a repetition may succeed: a deadlock, or a row with the same
/// key that was written at the same time.
bool is_conflict(const std::exception& error) noexcept;

/// An error of the server in plain words; empty: none of the known ones.
std::optional<Error> server_error(const std::exception& error, const std::string& where);

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

namespace {

/// Seconds, and milliseconds for tcp_user_timeout: a station has to notice a server that is gone.
constexpr std::array kDefaults{std::pair{"connect_timeout", "5"}, std::pair{"tcp_user_timeout", "10000"},
                               std::pair{"keepalives_idle", "10"}, std::pair{"keepalives_interval", "5"},
                               std::pair{"application_name", "trocar"}};

void ignore_notice(void*, const char*) {}

PGconn* connection_of(soci::session& session) noexcept {
  auto* const backend = static_cast<soci::postgresql_session_backend*>(session.get_backend());
  return backend == nullptr ? nullptr : backend->conn_;
}

struct Known {
  std::string_view sqlstate;  ///< Or its first two characters (the class). PostgreSQL documentation, appendix A.
  const char* what;
  const char* advice;
};
constexpr std::array kKnown{
    Known{"28", "the server refuses the user or the password", "check both in the URL"},
    Known{"3D000", "the server has no such database", "ask its administrator to make it (createdb)"},
    Known{"42501", "the user may not do this",
          "a program with the rights of the owner makes or updates the tables; ask the administrator for other rights"},
    Known{"40", "another program wrote the same data at the same time", "try again"},
    Known{"53100", "the server's disk is full", "ask its administrator; nothing of this was written"},
    Known{"53300", "the server has too many connections", "try again, or ask its administrator"},
    Known{"25006", "the database can only be read", "connect to the server that can be written"},
    Known{"XX001", "the database is damaged", "ask its administrator to restore a backup"},
    Known{"XX002", "the database is damaged", "ask its administrator to restore a backup"},
};

/// The messages that libpq gives before a server has answered, when there is no SQLSTATE.
std::optional<Error> connection_error(std::string_view text, const std::string& where) {
  const auto has = [&](std::string_view words) { return text.find(words) != std::string_view::npos; };
  if (has("password authentication failed") || has("no password supplied"))
    return Error{"the server refuses the user or the password", where, "check both in the URL"};
  if (has("database \"") && has("does not exist"))
    return Error{"the server has no such database", where, "ask its administrator to make it (createdb)"};
  if (has("could not translate host name"))
    return Error{"the server's name is unknown", where, "check the host in the URL"};
  if (has("Connection refused") || has("No such file or directory") || has("timeout expired") || has("timed out"))
    return Error{"no server answers", where, "check host and port, and that the server runs"};
  if (has("invalid URI") || has("invalid connection option") || has("invalid port") || has("invalid sslmode"))
    return Error{"the URL is not understood", where, "give postgresql://USER:PASSWORD@HOST:PORT/NAME", 2};
  return std::nullopt;
}

}  // namespace

void open_server(soci::session& session, const std::string& url) {
  std::string text = url;
  for (const auto& [key, value] : kDefaults) {
    if (text.find(std::string(key) + "=") != std::string::npos) continue;
    text += text.find('?') == std::string::npos ? '?' : '&';
    text += std::string(key) + "=" + value;
  }
  session.open(soci::postgresql, text);
  PQsetNoticeProcessor(connection_of(session), &ignore_notice, nullptr);
  session << "SET client_min_messages = error";
  session << "SET extra_float_digits = 3";  // doubles come back bit by bit
}

bool is_lost(soci::session& session) noexcept {
  PGconn* const connection = connection_of(session);
  return connection == nullptr || PQstatus(connection) == CONNECTION_BAD;
}

bool is_conflict(const std::exception& error) noexcept {
  const auto* known = dynamic_cast<const soci::postgresql_soci_error*>(&error);
  if (known == nullptr) return false;
  // unique_violation, foreign_key_violation, serialization_failure, deadlock_detected
  for (const std::string_view conflict : {"23505", "23503", "40001", "40P01"})
    if (known->sqlstate() == conflict) return true;
  return false;
}

std::optional<Error> server_error(const std::exception& error, const std::string& where) {
  if (const auto* known = dynamic_cast<const soci::postgresql_soci_error*>(&error)) {
    const std::string sqlstate = known->sqlstate();
    for (const Known& one : kKnown)
      if (sqlstate.starts_with(one.sqlstate)) return Error{one.what, where, one.advice};
  }
  return connection_error(error.what(), where);
}

}  // namespace trocar::database
