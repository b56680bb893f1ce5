#include "database/sqlite_cache.h"

#include <fmt/format.h>

namespace trocar::database {
namespace {

constexpr long long kUsual_kib = 2000;  ///< SQLite's own default.

}  // namespace

SqliteCache::SqliteCache(Database& database, std::size_t bytes) : database_(database) {
  set(static_cast<long long>(bytes >> 10));
}

SqliteCache::~SqliteCache() {
  set(kUsual_kib);
  if (database_.is_sqlite())
    static_cast<void>(
        database_.run("the memory cannot be freed", [](soci::session& session) { session << "PRAGMA shrink_memory"; }));
}

void SqliteCache::set(long long kibibytes) {
  if (!database_.is_sqlite()) return;
  static_cast<void>(database_.run("the cache cannot be set", [&](soci::session& session) {
    session << fmt::format("PRAGMA cache_size = -{}", kibibytes);
  }));
}

}  // namespace trocar::database
