#pragma once

#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <filesystem>
#include <string>

namespace trocar::database {

/// Opens the SQLite file (created if it is missing), which waits `timeout_s` for another writer. Throws
/// soci::soci_error.
void open_sqlite(soci::session& session, const std::filesystem::path& path, int timeout_s);

/// A PRAGMA's integer value. Throws soci::soci_error.
int pragma_integer(soci::session& session, const std::string& name);

/// SQLite's own handle of an open session, for functions that SOCI does not offer.
inline sqlite_api::sqlite3* handle_of(soci::session& session) {
  return static_cast<soci::sqlite3_session_backend*>(session.get_backend())->conn_;
}

}  // namespace trocar::database
