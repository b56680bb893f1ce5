#pragma once

#include "storage/detail/database.h"
#include "storage/session_file.h"

namespace trocar::storage::detail {

/// Writes the tables info, tissues, layers, labels and phases. Throws soci::soci_error.
void write_info(soci::session& database, const SessionInfo& info);
/// Reads them back. Throws soci::soci_error, also if a value is missing or not a number.
SessionInfo read_info(soci::session& database);

}  // namespace trocar::storage::detail
