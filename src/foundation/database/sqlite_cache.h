#pragma once

#include <cstddef>

#include "database/database.h"

namespace trocar::database {

/// Lets SQLite keep more pages of a file in memory during the lifetime of an object, for a transaction that writes to
/// many places. Nothing for a server.
class SqliteCache {
 public:
  SqliteCache(Database& database, std::size_t bytes);
  ~SqliteCache();
  SqliteCache(const SqliteCache&) = delete;
  SqliteCache& operator=(const SqliteCache&) = delete;

 private:
  void set(long long kibibytes);
  Database& database_;
};

}  // namespace trocar::database
