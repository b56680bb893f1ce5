#include <fmt/format.h>

#include <map>

#include "core/files/atomic_file.h"
#include "core/parse_number.h"
#include "learning/history.h"
#include "results/attempts_csv.h"
#include "results/csv_text.h"
#include "results/detail/attempt_writer.h"
#include "results/detail/people_table.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr const char* kUseExport = "use a file of trocar results export";

/// The rows of a file with the places of its columns.
class Table {
 public:
  static Result<Table> read(const std::filesystem::path& file) {
    TROCAR_TRY(const std::string text, read_file(file, kMostBytes));
    Table table;
    table.where_ = file.string();
    TROCAR_TRY(table.rows_, parse_csv(text, table.where_));
    if (table.rows_.empty()) return fail("the file is empty", table.where_, kUseExport);
    for (std::size_t n = 0; n < table.rows_.front().size(); ++n) table.columns_[plain_text(table.rows_.front()[n])] = n;
    for (const char* column : {"attempt", "person", "group", "task", "started_utc", "state"})
      if (!table.columns_.contains(column))
        return fail(fmt::format("the column \"{}\" is missing", column), table.where_, kUseExport);
    for (std::size_t n = 1; n < table.rows_.size(); ++n)
      if (table.rows_[n].size() != table.rows_.front().size())
        return fail(fmt::format("the row has {} fields, not {}", table.rows_[n].size(), table.rows_.front().size()),
                    table.place(n, ""), kUseExport);
    return table;
  }

  std::size_t rows() const { return rows_.size(); }  ///< With the header, row 0.
  const std::map<std::string, std::size_t, std::less<>>& columns() const { return columns_; }
  std::string text(std::size_t row, std::string_view column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() ? std::string() : plain_text(rows_[row][found->second]);
  }
  std::string place(std::size_t row, std::string_view column) const {
    return fmt::format("{}, row {}{}{}", where_, row + 1, column.empty() ? "" : ", column ", column);
  }
  /// Empty: an empty field. Error: no number.
  template <class Number>
  Result<std::optional<Number>> number(std::size_t row, std::string_view column) const {
    // A negative number was written without an apostrophe.
    const auto found = columns_.find(column);
    const std::string field = found == columns_.end() ? std::string() : rows_[row][found->second];
    if (field.empty()) return std::optional<Number>();
    const auto value = find_leading_number<Number>(field);
    if (!value || !value->rest.empty())
      return fail(fmt::format("\"{}\" is no number", field), place(row, column), kUseExport);
    return std::optional<Number>(value->value);
  }

 private:
  std::string where_;
  std::vector<std::vector<std::string>> rows_;
  std::map<std::string, std::size_t, std::less<>> columns_;
};

bool is_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// "path_length (mm)"
Measure measure_of(const std::string& column, double value) {
  const std::size_t unit = column.find(" (");
  if (unit == std::string::npos || !column.ends_with(')')) return {column, {}, value};
  return {column.substr(0, unit), column.substr(unit + 2, column.size() - unit - 3), value};
}

Status read_values(const Table& table, std::size_t row, AttemptRecord& record) {
  for (const auto& [name, place] : table.columns()) {
    if (!name.starts_with(kPartColumn) && !name.starts_with(kMetricColumn)) continue;
    if (name.ends_with(" of")) continue;
    TROCAR_TRY(const auto value, table.number<double>(row, name));
    if (!value) continue;
    if (name.starts_with(kMetricColumn)) {
      record.measures.push_back(measure_of(name.substr(kMetricColumn.size()), *value));
    } else {
      TROCAR_TRY(const auto most, table.number<double>(row, name + " of"));
      record.parts.push_back({name.substr(kPartColumn.size()), *value, most.value_or(0.0)});
    }
  }
  return {};
}

Result<AttemptRecord> read_row(const Table& table, std::size_t row) {
  AttemptRecord record;
  Attempt& attempt = record.attempt;
  attempt.id = table.text(row, "attempt");
  if (!is_id(attempt.id)) return fail("the attempt has no valid key", table.place(row, "attempt"), kUseExport);
  const auto state = find_state(table.text(row, "state"));
  if (!state) return fail("the state is unknown", table.place(row, "state"), kUseExport);
  const auto started = learning::parse_utc(table.text(row, "started_utc"));
  if (!started) return fail("the time is none", table.place(row, "started_utc"), kUseExport);
  TROCAR_TRY(const auto seed, table.number<std::uint64_t>(row, "seed"));
  TROCAR_TRY(const auto difficulty, table.number<int>(row, "case"));
  TROCAR_TRY(attempt.score, table.number<double>(row, "score"));
  TROCAR_TRY(const auto duration_s, table.number<double>(row, "duration_s"));
  if (attempt.score && !(*attempt.score >= 0.0 && *attempt.score <= 100.0))
    return fail("the score is not 0 to 100", table.place(row, "score"), kUseExport);
  attempt.the_case = {table.text(row, "task"), table.text(row, "patient"), seed.value_or(1), table.text(row, "hash"),
                      difficulty};
  attempt.level = table.text(row, "level");
  attempt.operator_name = table.text(row, "operator");
  attempt.station = table.text(row, "station");
  attempt.started = *started;
  attempt.state = *state;
  attempt.is_passed = table.text(row, "passed") == "1";
  attempt.duration_s = duration_s.value_or(0.0);
  attempt.program_version = table.text(row, "version");
  TROCAR_TRY_STATUS(read_values(table, row, record));
  return record;
}

/// The person of a row, added if there is none of this name.
Result<std::string> person_of(soci::session& session, const Table& table, std::size_t row, Seconds now,
                              ImportedRows& imported) {
  const auto with_place = [&](Error error) {
    error.where = table.place(row, "person");
    return tl::unexpected(std::move(error));
  };
  const auto name = clean_name(table.text(row, "person"), "the name of a person");
  if (!name) return with_place(name.error());
  if (const auto found = find_person_named(session, name_key(*name))) return found->id;
  const auto group = find_group(table.text(row, "group"));
  if (!group) return fail("the group is unknown", table.place(row, "group"), "use trainee or expert");
  const auto added =
      add_person(session, {*name, *group, table.text(row, "course"), table.text(row, "simulated") == "1", {}}, now);
  if (!added) return with_place(added.error());
  ++imported.people;
  return added->id;
}

}  // namespace

Result<ImportedRows> import_attempts(Repository& repository, const std::filesystem::path& file, Seconds now) {
  TROCAR_TRY(const Table table, Table::read(file));
  database::Database& database = repository.database();
  return database.transaction("the attempts cannot be written", [&](soci::session& session) -> Result<ImportedRows> {
    ImportedRows imported;
    AttemptWriter writer(session, database);
    std::map<std::string, std::string> people;
    for (std::size_t row = 1; row < table.rows(); ++row) {
      TROCAR_TRY(AttemptRecord record, read_row(table, row));
      std::string& person = people[table.text(row, "person")];
      if (person.empty()) {
        TROCAR_TRY(person, person_of(session, table, row, now, imported));
      }
      record.attempt.person_id = person;
      TROCAR_TRY(const std::optional<State> written, writer.merge(record));
      ++(written ? imported.added : imported.present);
      if (written) imported.counts.add(ending_of(*written), record.attempt.is_passed);
    }
    return imported;
  });
}

}  // namespace trocar::results
