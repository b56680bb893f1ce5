#include "storage/detail/timed_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace trocar::storage::detail {
namespace {

constexpr std::size_t kRowsAFetch = 1024;

}  // namespace

std::string schema_of(const TimedTable& table) {
  return fmt::format("CREATE TABLE {} ({} REAL NOT NULL, PRIMARY KEY ({})) WITHOUT ROWID", table.name,
                     fmt::join(table.columns, " REAL NOT NULL, "), table.columns.front());
}

bool all_finite(std::span<const double> row) noexcept {
  return std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
}

void TimedBuffer::add(std::span<const double> row) {
  if (!all_finite(row) || row.front() <= last_s_) return;
  last_s_ = row.front();
  for (std::size_t c = 0; c < row.size(); ++c) columns_[c].push_back(row[c]);
}

void TimedBuffer::write(soci::session& database) {
  if (is_empty()) return;
  soci::statement insert(database);
  for (std::vector<double>& column : columns_) insert.exchange(soci::use(column));
  insert.alloc();
  insert.prepare(fmt::format("INSERT INTO {} ({}) VALUES (:{})", table_.name, fmt::join(table_.columns, ", "),
                             fmt::join(table_.columns, ", :")));
  insert.define_and_bind();
  insert.execute(true);
}

void TimedBuffer::clear() noexcept {
  for (std::vector<double>& column : columns_) column.clear();
}

std::vector<std::vector<double>> read_rows(soci::session& database, const TimedTable& table) {
  std::vector<std::vector<double>> rows;
  if (!has_table(database, table.name)) return rows;
  std::vector<std::vector<double>> columns(table.columns.size(), std::vector<double>(kRowsAFetch));
  soci::statement select(database);
  for (std::vector<double>& column : columns) select.exchange(soci::into(column));
  select.alloc();
  select.prepare(
      fmt::format("SELECT {} FROM {} ORDER BY {}", fmt::join(table.columns, ", "), table.name, table.columns.front()));
  select.define_and_bind();
  select.execute();
  while (select.fetch()) {
    if (rows.size() > table.most_rows) throw soci::soci_error(fmt::format("too many rows of {}", table.name));
    for (std::size_t i = 0; i < columns.front().size(); ++i) {
      std::vector<double>& row = rows.emplace_back();
      for (const std::vector<double>& column : columns) row.push_back(column[i]);
    }
    for (std::vector<double>& column : columns) column.resize(kRowsAFetch);
  }
  return rows;
}

}  // namespace trocar::storage::detail
