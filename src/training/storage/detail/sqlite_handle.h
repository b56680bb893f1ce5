#pragma once

#include "storage/detail/database.h"

namespace trocar::storage::detail {

/// SQLite's own handle of an open session, for functions that SOCI does not offer.
inline sqlite_api::sqlite3* handle_of(soci::session& database) {
  return static_cast<soci::sqlite3_session_backend*>(database.get_backend())->conn_;
}

}  // namespace trocar::storage::detail
