#pragma once

#include <soci/soci.h>

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "core/result.h"
#include "database/database_url.h"
#include "database/sqlite.h"

namespace trocar::database {

/// Whether a database that does not exist is made (SQLite only; a server's database is made by its administrator).
enum class Missing { kCreate, kRefuse };

namespace detail {
template <class T>
inline constexpr bool is_result = false;
template <class T>
inline constexpr bool is_result<Result<T>> = true;
}  // namespace detail

/// An open connection. One thread at a time. Its sessions of SOCI throw; `run` and `transaction` catch.
class Database {
 public:
  /// Errors, one line each: cannot be created or read, not a database, damaged, no such server, wrong password.
  static Result<Database> open(const DatabaseUrl& url, Missing missing);
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;
  ~Database();

  const DatabaseUrl& url() const noexcept { return url_; }
  bool is_sqlite() const noexcept { return url_.is_sqlite(); }
  /// What the user has to know of an SQLite file without a write-ahead log, in one line; empty: nothing.
  std::string note() const;
  soci::session& session() noexcept { return *session_; }

  /// Runs reading statements: `work(soci::session&)` returns T or Result<T>. `what`: "the attempts cannot be read".
  /// Errors of the database name it. A lost connection is made again and the work repeated once.
  template <class Work>
  auto run(const char* what, const Work& work) {
    return attempt(what, Kind::kRead, work);
  }
  /// Runs reading statements that all see one state of the database, whatever others write meanwhile.
  template <class Work>
  auto snapshot(const char* what, const Work& work) {
    return attempt(what, Kind::kSnapshot, work);
  }
  /// Runs statements as one transaction: everything is written, or nothing if `work` fails. Other writers wait. The
  /// work is repeated once if the connection was lost before it was committed, and a few times if another program wrote
  /// the same rows at the same time; if the connection is lost during the commit, the error says that it is not known
  /// whether the data were written. So work has to bear a repetition.
  template <class Work>
  auto transaction(const char* what, const Work& work) {
    return attempt(what, Kind::kWrite, work);
  }
  /// Moves the write-ahead log of an SQLite file into the file and empties it, so that it holds no deleted data. False:
  /// another connection still read an older state of the database after `wait`.
  Result<bool> empty_log(std::chrono::milliseconds wait);

 private:
  enum class Kind { kRead, kSnapshot, kWrite };
  const char* begin_of(Kind kind) const noexcept;
  struct Connection {
    std::unique_ptr<soci::session> session;
    Journal journal;  ///< Of an SQLite file.
  };
  Database(DatabaseUrl url, Connection connection);
  static Connection connect(const DatabaseUrl& url);

  template <class Work>
  auto attempt(const char* what, Kind kind, const Work& work) {
    using Returned = std::invoke_result_t<const Work&, soci::session&>;
    using Returns = std::conditional_t<detail::is_result<Returned>, Returned, Result<Returned>>;
    std::optional<Returns> returned;
    const Status status = execute(what, kind, [&](soci::session& session) -> bool {
      if constexpr (std::is_void_v<Returned>) {
        work(session);
        returned.emplace();
      } else {
        returned.emplace(work(session));
      }
      return returned->has_value();
    });
    if (!status) return Returns(tl::unexpected(status.error()));
    return *std::move(returned);
  }
  /// `work` returns false to undo the transaction.
  Status execute(const char* what, Kind kind, const std::function<bool(soci::session&)>& work);
  Error translate(const char* what, const std::exception& error) const;
  bool reconnect() noexcept;

  DatabaseUrl url_;
  std::unique_ptr<soci::session> session_;
  Journal journal_;
};

}  // namespace trocar::database
