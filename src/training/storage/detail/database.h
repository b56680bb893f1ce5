#pragma once

#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::storage::detail {

/// "trcr": PRAGMA application_id of a session, which identifies it for `file` and for this program.
inline constexpr int kApplicationId = 0x74726372;

/// Opens the SQLite file (created if it is missing). Throws soci::soci_error.
void open_database(soci::session& database, const std::filesystem::path& path);

/// The statements that give a new session its identity, tables and view.
std::vector<std::string> schema_statements();

/// A PRAGMA's integer value. Throws soci::soci_error.
int pragma_integer(soci::session& database, const std::string& name);

/// SQLite's message, without SOCI's function names.
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

}  // namespace trocar::storage::detail
