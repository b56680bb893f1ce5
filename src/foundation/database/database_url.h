#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::database {

/// Where a database lies.
struct DatabaseUrl {
  std::filesystem::path file;  ///< SQLite; empty: a PostgreSQL server.
  std::string server;          ///< "postgresql://user:password@host:port/name?sslmode=require"; empty: SQLite.

  bool is_sqlite() const noexcept { return server.empty(); }
  /// For people and messages: without a password.
  std::string shown() const;
};

/// Reads "FILE", "sqlite:FILE" or "postgresql://…" ("postgres://" is the same). Errors (exit status 2): empty, another
/// scheme, a server without a database name.
Result<DatabaseUrl> parse_url(std::string_view text);

}  // namespace trocar::database
