#include "storage/detail/transducer_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "storage/detail/guarded_database.h"

namespace trocar::storage::detail {
namespace {

using Row = std::array<double, kTransducerColumns.size()>;

constexpr std::size_t kRowsAFetch = 1024;

bool is_finite(const Row& row) {
  return std::all_of(row.begin(), row.end(), [](double value) { return std::isfinite(value); });
}

Row row_of(const TransducerSample& sample) {
  const Vec3& p = sample.X_PT.p();
  const Eigen::Quaterniond q(sample.X_PT.R());
  return {sample.time_s, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), sample.contact_n};
}

TransducerSample sample_of(const Row& row) {
  const auto& [time_s, x, y, z, qw, qx, qy, qz, contact_n] = row;
  const Eigen::Quaterniond q(qw, qx, qy, qz);
  constexpr double kLeastNorm = 0.5;  // stored as a unit quaternion
  if (!is_finite(row) || q.norm() < kLeastNorm) throw soci::soci_error("a pose of the transducer is invalid");
  return {time_s, Pose(q.normalized().toRotationMatrix(), Vec3(x, y, z)), contact_n};
}

bool has_table(soci::session& database) {
  int count = 0;
  database << "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'transducer'", soci::into(count);
  return count > 0;
}

}  // namespace

std::string transducer_schema() {
  return fmt::format("CREATE TABLE transducer ({} REAL NOT NULL, PRIMARY KEY (time_s)) WITHOUT ROWID",
                     fmt::join(kTransducerColumns, " REAL NOT NULL, "));
}

void TransducerBuffer::add(const TransducerSample& sample) {
  const Row row = row_of(sample);
  if (!is_finite(row) || sample.time_s <= last_s_) return;
  last_s_ = sample.time_s;
  for (std::size_t c = 0; c < row.size(); ++c) columns_[c].push_back(row[c]);
}

void TransducerBuffer::write(soci::session& database) {
  if (is_empty()) return;
  soci::statement insert(database);
  for (std::vector<double>& column : columns_) insert.exchange(soci::use(column));
  insert.alloc();
  insert.prepare(fmt::format("INSERT INTO transducer ({}) VALUES (:{})", fmt::join(kTransducerColumns, ", "),
                             fmt::join(kTransducerColumns, ", :")));
  insert.define_and_bind();
  insert.execute(true);
}

void TransducerBuffer::clear() noexcept {
  for (std::vector<double>& column : columns_) column.clear();
}

std::vector<TransducerSample> read_transducer(soci::session& database) {
  std::vector<TransducerSample> samples;
  if (!has_table(database)) return samples;
  std::array<std::vector<double>, kTransducerColumns.size()> columns;
  soci::statement select(database);
  for (std::vector<double>& column : columns) {
    column.resize(kRowsAFetch);
    select.exchange(soci::into(column));
  }
  select.alloc();
  select.prepare(fmt::format("SELECT {} FROM transducer ORDER BY time_s", fmt::join(kTransducerColumns, ", ")));
  select.define_and_bind();
  select.execute();
  while (select.fetch()) {
    if (samples.size() > kMaxTransducerRows) throw soci::soci_error("too many poses of the transducer");
    for (std::size_t i = 0; i < columns[0].size(); ++i) {
      Row row;
      for (std::size_t c = 0; c < row.size(); ++c) row[c] = columns[c][i];
      samples.push_back(sample_of(row));
    }
    for (std::vector<double>& column : columns) column.resize(kRowsAFetch);
  }
  return samples;
}

}  // namespace trocar::storage::detail
