#pragma once

#include <soci/soci.h>

#include <exception>
#include <optional>
#include <string>

#include "core/result.h"

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

}  // namespace trocar::database
