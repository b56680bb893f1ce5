#include "storage/detail/parameters_table.h"

#include <fmt/ranges.h>

#include <cmath>

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {
namespace {

constexpr char kBetweenSettings = ';', kBetweenOptions = '\n';

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

std::vector<std::string> parameters_schema() {
  return {
      "CREATE TABLE parameters (tick INTEGER PRIMARY KEY, time_s REAL NOT NULL, settings TEXT NOT NULL, options TEXT "
      "NOT NULL, tissue_table_toml TEXT NOT NULL)",
      "CREATE TABLE interruptions (tick INTEGER NOT NULL, from_s REAL NOT NULL, to_s REAL NOT NULL, reason TEXT NOT "
      "NULL)"};
}

std::string parameters_events_sql() {
  return "SELECT printf('interruption:%.3f', to_s - from_s) AS text FROM interruptions i WHERE i.tick = t.tick "
         "UNION ALL SELECT 'set:' || replace(settings, ';', ';set:') FROM parameters p WHERE p.tick = t.tick AND "
         "settings <> ''";
}

void ParametersBuffer::write(soci::session& database) {
  for (const SessionParameters& row : parameters_) {
    const int tick = static_cast<int>(row.tick);
    const std::string settings = fmt::format("{}", fmt::join(row.settings, ";"));
    const std::string options = fmt::format("{}", fmt::join(row.options, "\n"));
    database << "INSERT INTO parameters (tick, time_s, settings, options, tissue_table_toml) VALUES (:tick, :time, "
                ":settings, :options, :table)",
        soci::use(tick), soci::use(row.time_s), soci::use(settings), soci::use(options),
        soci::use(row.tissue_table_toml);
  }
  for (const auto& [interruption, first] : interruptions_) {
    const int tick = static_cast<int>(first);
    database << "INSERT INTO interruptions (tick, from_s, to_s, reason) VALUES (:tick, :from, :to, :reason)",
        soci::use(tick), soci::use(interruption.from_s), soci::use(interruption.to_s), soci::use(interruption.reason);
  }
}

void ParametersBuffer::clear() noexcept {
  parameters_.clear();
  interruptions_.clear();
}

std::vector<SessionParameters> read_parameters(soci::session& database, std::size_t tick_count) {
  std::vector<SessionParameters> all;
  if (!has_table(database, "parameters")) return all;
  int tick = 0;
  SessionParameters row;
  std::string settings, options;
  soci::statement select =
      (database.prepare << "SELECT tick, time_s, settings, options, tissue_table_toml FROM parameters ORDER BY tick",
       soci::into(tick), soci::into(row.time_s), soci::into(settings), soci::into(options),
       soci::into(row.tissue_table_toml));
  select.execute();
  std::size_t bytes = 0;
  while (select.fetch()) {
    bytes += settings.size() + options.size() + row.tissue_table_toml.size();
    if (bytes > kMaxParameterBytes || all.size() >= kMaxChanges)
      throw soci::soci_error("the changes of parameters are too long");
    if (tick < 0 || static_cast<std::size_t>(tick) >= tick_count || !std::isfinite(row.time_s))
      throw soci::soci_error("a change of parameters is out of range");
    row.tick = static_cast<std::size_t>(tick);
    row.settings = split(settings, kBetweenSettings);
    row.options = split(options, kBetweenOptions);
    all.push_back(row);
  }
  return all;
}

std::vector<tasks::Interruption> read_interruptions(soci::session& database) {
  std::vector<tasks::Interruption> all;
  if (!has_table(database, "interruptions")) return all;
  tasks::Interruption row;
  soci::statement select = (database.prepare << "SELECT from_s, to_s, reason FROM interruptions ORDER BY from_s",
                            soci::into(row.from_s), soci::into(row.to_s), soci::into(row.reason));
  select.execute();
  while (select.fetch()) {
    if (!std::isfinite(row.from_s) || !(row.to_s >= row.from_s) || row.reason.size() > kMaxNameBytes ||
        all.size() >= kMaxChanges)
      throw soci::soci_error("an interruption is out of range");
    all.push_back(row);
  }
  return all;
}

}  // namespace trocar::storage::detail
