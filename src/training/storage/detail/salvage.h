#pragma once

#include "storage/detail/database.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// Reads all parts of a session that are readable and match their checksums. Other parts are listed in `session.damage`
/// and left out. Returns the outcome's JSON, empty if there is none. Throws soci::soci_error if a table is not an
/// ordinary table.
std::string salvage(GuardedDatabase& database, Session& session);

}  // namespace trocar::storage::detail
