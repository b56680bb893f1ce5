#pragma once

#include "storage/detail/guarded_database.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// Reads all of a session that can be read and fits its checksums; what does not is noted in `session.damage` and left
/// out. Gives the outcome's JSON, empty where there is none. Throws soci::soci_error where a table is none.
std::string salvage(GuardedDatabase& database, Session& session);

}  // namespace trocar::storage::detail
