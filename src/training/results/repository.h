#pragma once

#include <chrono>
#include <string>

#include "core/result.h"
#include "database/database.h"
#include "signing/token.h"

namespace trocar::results {

/// PRAGMA application_id of a database of results: "trre".
inline constexpr int kApplicationId = 0x74727265;

/// The database where nothing else is named: $TROCAR_DB, else results.sqlite in the folder of the user's data.
/// Error (exit status 2): $TROCAR_DB is no URL.
Result<database::DatabaseUrl> default_url();

/// The results of a station or a department: people, courses, cases, attempts, questionnaires, accounts. One
/// connection, one thread at a time; several programs and stations may use the same database at once. The functions of
/// this module that take a repository are transactions of their own: they write everything or nothing.
class Repository {
 public:
  /// Opens a database and brings its schema up to date. Errors: those of Database::open and migrate, above all a
  /// database of a newer program.
  static Result<Repository> open(const database::DatabaseUrl& url,
                                 database::Missing missing = database::Missing::kCreate);

  database::Database& database() noexcept { return database_; }
  const database::DatabaseUrl& url() const noexcept { return database_.url(); }

 private:
  explicit Repository(database::Database database) : database_(std::move(database)) {}
  database::Database database_;
};

/// Seconds since 1970, UTC, as the database keeps times.
using Seconds = std::chrono::sys_seconds;

using signing::make_id;  ///< Of a new row.

/// Takes deleted data out of the write-ahead log of an SQLite file, too. Functions that delete call it. False: another
/// connection read an older state of the database for longer than `wait`; the data are to be erased again later.
Result<bool> erase_deleted(Repository& repository, std::chrono::milliseconds wait = std::chrono::seconds(10));

/// A key that is another one after every deletion, by whatever program: values that were read before may show the
/// deleted data. Empty: nothing was deleted yet.
Result<std::string> last_deletion(Repository& repository);

}  // namespace trocar::results
