#pragma once

#include <string>

#include "cli/commands.h"
#include "database/database_url.h"

namespace trocar::cli {

inline constexpr const char* kDatabaseHelp =
    "Database of results: a file, or postgresql://… [$TROCAR_DB, else the user's results.sqlite]";

/// The database of an option --db; results::default_url() if it is empty.
Result<database::DatabaseUrl> database_of(const std::string& option);

/// Adds `account` with add, list, remove and password to `serve`.
void add_serve_account_commands(Command& serve, Action& action);

}  // namespace trocar::cli
