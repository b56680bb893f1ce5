#include "storage/detail/timed_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "storage/detail/database.h"

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

namespace {

/// A number of a file as an enumerator from 0 to `last`.
template <class Enum>
Enum read_enum(double number, Enum last) {
  if (!(number >= 0.0 && number <= static_cast<double>(last)) || number != std::floor(number))
    throw soci::soci_error("an action of the trainee is invalid");
  return static_cast<Enum>(number);
}

}  // namespace

const TimedTable& action_table() {
  static const TimedTable kTable{"actions",
                                 {"time_s", "kind", "amount", "substance", "share", "x_mm", "y_mm", "z_mm", "depth_mm"},
                                 kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const tasks::Action& action) {
  const Vec3& p = action.tip_A;
  buffer.add(std::array{action.time_s, static_cast<double>(action.kind), action.amount,
                        static_cast<double>(action.result.substance), action.result.share, p.x(), p.y(), p.z(),
                        action.depth_mm});
}

std::vector<tasks::Action> read_actions(soci::session& database) {
  std::vector<tasks::Action> actions;
  const auto rows = read_rows(database, action_table());
  for (const std::vector<double>& row : rows) {
    if (!all_finite(row)) throw soci::soci_error("an action of the trainee is invalid");
    actions.push_back({row[0],
                       read_enum(row[1], tasks::kLastAction),
                       row[2],
                       {read_enum(row[3], tasks::kLastSubstance), row[4]},
                       Vec3(row[5], row[6], row[7]),
                       row[8]});
  }
  return actions;
}

const TimedTable& transducer_table() {
  static const TimedTable kTable{
      "transducer", {"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "contact_n"}, kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const TransducerSample& sample) {
  const Vec3& p = sample.X_PT.p();
  const Eigen::Quaterniond q(sample.X_PT.R());
  buffer.add(std::array{sample.time_s, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), sample.contact_n});
}

std::vector<TransducerSample> read_transducer(soci::session& database) {
  std::vector<TransducerSample> samples;
  const auto rows = read_rows(database, transducer_table());
  samples.reserve(rows.size());
  for (const std::vector<double>& row : rows) {
    const Eigen::Quaterniond q(row[4], row[5], row[6], row[7]);
    constexpr double kLeastNorm = 0.5;  // stored as a unit quaternion
    if (!all_finite(row) || q.norm() < kLeastNorm) throw soci::soci_error("a pose of the transducer is invalid");
    samples.push_back({row[0], Pose(q.normalized().toRotationMatrix(), Vec3(row[1], row[2], row[3])), row[8]});
  }
  return samples;
}

const TimedTable& xray_table() {
  static const TimedTable kTable{"xray",
                                 {"time_s", "lao_deg", "cranial_deg", "x_mm", "y_mm", "z_mm", "field_mm", "beam_on",
                                  "contrast_ml", "beam_s", "air_kerma_mgy", "dose_area_gycm2"},
                                 kMaxTransducerRows};
  return kTable;
}

void add(TimedBuffer& buffer, const tasks::XrayUse& use) {
  const Vec3& p = use.isocentre_P;
  buffer.add(std::array{use.time_s, use.lao_deg, use.cranial_deg, p.x(), p.y(), p.z(), use.field_mm,
                        use.is_beam_on ? 1.0 : 0.0, use.contrast_ml, use.beam_s, use.air_kerma_mgy,
                        use.dose_area_gycm2});
}

std::vector<tasks::XrayUse> read_xray(soci::session& database) {
  std::vector<tasks::XrayUse> uses;
  const auto rows = read_rows(database, xray_table());
  for (const std::vector<double>& row : rows) {
    const bool is_dose = row[8] >= 0.0 && row[9] >= 0.0 && row[10] >= 0.0 && row[11] >= 0.0;
    if (!all_finite(row) || !is_dose) throw soci::soci_error("a dose of the X-ray is invalid");
    uses.push_back(
        {row[0], row[1], row[2], Vec3(row[3], row[4], row[5]), row[6], row[7] > 0.5, row[8], row[9], row[10], row[11]});
  }
  return uses;
}

}  // namespace trocar::storage::detail
