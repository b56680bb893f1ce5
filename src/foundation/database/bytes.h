#pragma once

#include <string>
#include <string_view>

#include "database/database.h"

namespace trocar::database {

/// Binary data as SOCI's strings: `INSERT … VALUES (` + bytes_in(database, ":x") + `)` with soci::use(bound), and
/// `SELECT ` + bytes_out(database, "x") with soci::into(text); then `bound = bind_bytes(…)` and `from_bytes(…)`.
std::string bytes_in(const Database& database, const std::string& placeholder);
std::string bytes_out(const Database& database, const std::string& column);
std::string bind_bytes(const Database& database, std::string_view bytes);
/// Throws soci::soci_error if the database returned something else.
std::string from_bytes(const Database& database, std::string text);

}  // namespace trocar::database
