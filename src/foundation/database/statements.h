#pragma once

#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "database/database.h"

namespace trocar::database {

/// Binary data as SOCI's strings: `INSERT … VALUES (` + bytes_in(database, ":x") + `)` with soci::use(bound), and
/// `SELECT ` + bytes_out(database, "x") with soci::into(text); then `bound = bind_bytes(…)` and `from_bytes(…)`.
std::string bytes_in(const Database& database, const std::string& placeholder);
std::string bytes_out(const Database& database, const std::string& column);
std::string bind_bytes(const Database& database, std::string_view bytes);
/// Throws soci::soci_error if the database returned something else.
std::string from_bytes(const Database& database, std::string text);

/// The database's message, in one line without SOCI's function names.
std::string reason_of(const std::exception& error);

/// Runs `work` and converts SOCI's exceptions into an Error.
template <class Work>
Status guarded(const char* what, const std::filesystem::path& path, const char* advice, const Work& work) {
  try {
    work();
    return {};
  } catch (const std::exception& error) {
    return fail(std::string(what) + ": " + reason_of(error), path.string(), advice);
  }
}

/// The statements that lead from version n - 1 of a schema to n; n is the place in the list, from 1. "{bytes}" stands
/// for the type of binary data, "{sequence}" for a key that counts upwards by itself and is never used twice.
using Migration = std::vector<std::string>;

/// Brings a database to the newest version. All steps are one transaction. `application_id` marks an SQLite file, which
/// has to be empty or to have the same mark. Errors: another program's file, a newer version (which this program cannot
/// read), those of the database.
Status migrate(Database& database, int application_id, std::span<const Migration> migrations);

}  // namespace trocar::database
