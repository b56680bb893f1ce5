#include "database/sqlite_handle.h"

#include <fmt/format.h>

namespace trocar::database {

void open_sqlite(soci::session& session, const std::filesystem::path& path, int timeout_s) {
  const std::string absolute = std::filesystem::absolute(path).string();
  if (absolute.find('"') != std::string::npos) throw soci::soci_error("a quotation mark in the path");
  session.open(soci::sqlite3, fmt::format("dbname=\"{}\" timeout={}", absolute, timeout_s));
}

int pragma_integer(soci::session& session, const std::string& name) {
  int value = 0;
  session << "PRAGMA " + name, soci::into(value);
  return value;
}

}  // namespace trocar::database
