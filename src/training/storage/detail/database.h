#pragma once

#include <soci/soci.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "database/guarded.h"
#include "database/sqlite_handle.h"
#include "database/sqlite_journal.h"

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

}  // namespace trocar::storage::detail
