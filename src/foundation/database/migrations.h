#pragma once

#include <span>
#include <string>
#include <vector>

#include "database/database.h"

namespace trocar::database {

/// The statements that lead from version n - 1 of a schema to n; n is the place in the list, from 1. "{bytes}" stands
/// for the type of binary data, "{sequence}" for a key that counts upwards by itself and is never used twice.
using Migration = std::vector<std::string>;

/// Brings a database to the newest version. All steps are one transaction. `application_id` marks an SQLite file, which
/// has to be empty or to have the same mark. Errors: another program's file, a newer version (which this program cannot
/// read), those of the database.
Status migrate(Database& database, int application_id, std::span<const Migration> migrations);

}  // namespace trocar::database
