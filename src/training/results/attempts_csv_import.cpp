#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>

#include "config/nearest_word.h"
#include "core/files/atomic_file.h"
#include "core/parse_number.h"
#include "learning/history.h"
#include "metrics/metric.h"
#include "results/attempts_csv.h"
#include "results/csv_text.h"
#include "results/detail/attempt_writer.h"
#include "results/detail/people_table.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr const char* kUseExport = "use a file of trocar results export";
constexpr double kRoundOff = 1e-6;       ///< Of points.
constexpr double kScoreRoundOff = 0.01;  ///< Of a sum of points.

constexpr double kLongest_s = 86'400.0;  ///< Of an attempt: a day.

/// The columns that a file may have beside those of parts and metrics.
bool is_column(std::string_view name) {
  const auto is_named = [&](std::string_view kind) {
    return name.starts_with(kind) && name.size() > kind.size() && name[kind.size()] != ' ' && name[kind.size()] != '(';
  };
  return std::ranges::find(kAttemptColumns, name) != kAttemptColumns.end() || is_named(kPartColumn) ||
         is_named(kMetricColumn);
}

/// What a metric of the catalogue cannot be; empty: it can. Others are not known here.
std::string impossible(const std::string& metric, double value) {
  for (const metrics::MetricDescription& known : metrics::metric_catalogue()) {
    if (metric != known.name) continue;
    const bool may_be_negative = metric == "spectral_arc_length" || metric == "log_dimensionless_jerk";
    if (value < 0.0 && !may_be_negative) return "negative";
    const bool is_yes_or_no = metric == "first_pass_success" || metric == "end_in_target";
    if (is_yes_or_no && value != 0.0 && value != 1.0) return "neither 0 nor 1";
    if (std::string_view(known.unit) == "%" && value > 100.0) return "above 100 %";
  }
  return {};
}

bool has_control_characters(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

/// "path_length (mm)"
Measure measure_of(const std::string& column, double value) {
  const std::size_t unit = column.find(" (");
  if (unit == std::string::npos || !column.ends_with(')')) return {column, {}, value};
  return {column.substr(0, unit), column.substr(unit + 2, column.size() - unit - 3), value};
}

/// A metric of the catalogue in another unit, or one that is spelled almost like one of it; empty: neither. Others are
/// of another version of the program.
std::string fault_of_metric(const Measure& column) {
  std::vector<std::string_view> names;
  for (const metrics::MetricDescription& known : metrics::metric_catalogue()) {
    if (column.name == known.name) return column.unit == known.unit ? "" : fmt::format("its unit is {}", known.unit);
    names.emplace_back(known.name);
  }
  const std::string_view nearest = config::nearest_word(column.name, names);
  return nearest.empty() ? std::string() : fmt::format("did you mean \"{}\"?", nearest);
}

/// The rows of a file with the places of its columns.
class Table {
 public:
  static Result<Table> read(const std::filesystem::path& file) {
    TROCAR_TRY(const std::string text, read_file(file, kMostBytes));
    Table table;
    table.where_ = file.string();
    TROCAR_TRY(table.rows_, parse_csv(text, table.where_));
    if (table.rows_.empty()) return fail("the file is empty", table.where_, kUseExport);
    TROCAR_TRY_STATUS(table.read_header());
    const std::size_t fields = table.rows_.front().fields.size();
    for (std::size_t n = 1; n < table.rows_.size(); ++n)
      if (const std::size_t found = table.rows_[n].fields.size(); found != fields)
        return fail(fmt::format("the row has {} fields, the header {}", found, fields), table.place(n, ""),
                    "put commas between the fields of a row, and decimal points into numbers");
    return table;
  }

  std::size_t rows() const { return rows_.size(); }  ///< With the header, row 0.
  const std::map<std::string, std::size_t, std::less<>>& columns() const { return columns_; }
  std::string text(std::size_t row, std::string_view column) const { return plain_text(field(row, column)); }
  std::string place(std::size_t row, std::string_view column) const {
    return fmt::format("{}, line {}{}{}", where_, rows_[row].line, column.empty() ? "" : ", column ", column);
  }
  /// Empty: an empty field. Error: no finite number. A negative one was written without an apostrophe.
  template <class Number>
  Result<std::optional<Number>> number(std::size_t row, std::string_view column) const {
    const std::string& text = field(row, column);
    if (text.empty()) return std::optional<Number>();
    if (const auto value = parse_number<Number>(text)) return std::optional<Number>(*value);
    return fail(fmt::format("\"{}\" is no {}number", text, std::is_integral_v<Number> ? "whole " : ""),
                place(row, column), "write numbers with a decimal point, and leave a missing value empty");
  }
  /// "1" or "0"; an empty field is 0.
  Result<bool> truth(std::size_t row, std::string_view column) const {
    const std::string& text = field(row, column);
    if (text.empty() || text == "0" || text == "1") return text == "1";
    return fail(fmt::format("\"{}\" is neither 0 nor 1", text), place(row, column), "write 0 or 1");
  }

 private:
  Status read_header() {
    const std::vector<std::string>& names = rows_.front().fields;
    std::set<std::string> metrics;
    for (std::size_t n = 0; n < names.size(); ++n) {
      const std::string name = plain_text(names[n]);
      if (!is_column(name))
        return fail(fmt::format("there is no column \"{}\"", name), place(0, ""), "correct its name, or remove it");
      if (!columns_.emplace(name, n).second)
        return fail(fmt::format("the column \"{}\" occurs twice", name), place(0, ""), "remove one");
      if (!name.starts_with(kMetricColumn)) continue;
      const Measure metric = measure_of(name.substr(kMetricColumn.size()), 0.0);
      if (const std::string fault = fault_of_metric(metric); !fault.empty())
        return fail(fmt::format("the metric \"{}\" is unknown: {}", name.substr(kMetricColumn.size()), fault),
                    place(0, ""), "correct it, or remove the column");
      if (!metrics.insert(metric.name).second)
        return fail(fmt::format("the metric of the column \"{}\" occurs twice", name), place(0, ""),
                    "leave the unit in which it is measured");
    }
    for (const char* column : {"attempt", "person", "group", "task", "started_utc", "state"})
      if (!columns_.contains(column))
        return fail(fmt::format("the column \"{}\" is missing", column), where_, kUseExport);
    for (const auto& [name, place_of_name] : columns_)
      if (name.starts_with(kPartColumn) && !name.ends_with(kOfMost) && !columns_.contains(name + std::string(kOfMost)))
        return fail(fmt::format("the column \"{}{}\" is missing", name, kOfMost), where_, kUseExport);
    return {};
  }
  const std::string& field(std::size_t row, std::string_view column) const {
    static const std::string kMissing;
    const auto found = columns_.find(column);
    return found == columns_.end() ? kMissing : rows_[row].fields[found->second];
  }

  std::string where_;
  std::vector<CsvRow> rows_;
  std::map<std::string, std::size_t, std::less<>> columns_;
};

bool is_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Status read_values(const Table& table, std::size_t row, AttemptRecord& record) {
  for (const auto& [name, place] : table.columns()) {
    if (!name.starts_with(kPartColumn) && !name.starts_with(kMetricColumn)) continue;
    if (name.ends_with(kOfMost)) continue;
    TROCAR_TRY(const auto value, table.number<double>(row, name));
    if (!value) continue;
    if (name.starts_with(kMetricColumn)) {
      record.measures.push_back(measure_of(name.substr(kMetricColumn.size()), *value));
      if (const std::string fault = impossible(record.measures.back().name, *value); !fault.empty())
        return fail(fmt::format("{:g} is {}", *value, fault), table.place(row, name), "correct it, or leave it empty");
    } else {
      const std::string most_name = name + std::string(kOfMost);
      TROCAR_TRY(const auto most, table.number<double>(row, most_name));
      if (!most || !(*most > 0.0) || *value > *most + kRoundOff || *value < 0.0)
        return fail(fmt::format("the points are not of {}", most ? fmt::format("{:g}", *most) : "a number"),
                    table.place(row, name), fmt::format("correct it, or the column \"{}\"", most_name));
      record.parts.push_back({name.substr(kPartColumn.size()), *value, *most});
    }
  }
  return {};
}

/// What has to be within a range or a list.
Status check_row(const Table& table, std::size_t row, const Attempt& attempt) {
  const auto refuse = [&](const char* what, const char* column, const char* advice) {
    return fail(what, table.place(row, column), advice);
  };
  if (!is_id(attempt.id)) return refuse("the attempt has no valid key", "attempt", kUseExport);
  if (attempt.the_case.task.empty()) return refuse("the task is empty", "task", kUseExport);
  if (!attempt.level.empty() && !learning::find_level(attempt.level))
    return refuse("the level is unknown", "level", "use guided, assisted or exam, or leave it empty");
  if (attempt.score && !(*attempt.score >= 0.0 && *attempt.score <= 100.0))
    return refuse("the score is not 0 to 100", "score", "correct it");
  if (attempt.the_case.difficulty && (*attempt.the_case.difficulty < 1 || *attempt.the_case.difficulty > 5))
    return refuse("the difficulty is not 1 to 5", "case", "correct it, or leave it empty");
  if (!(attempt.duration_s >= 0.0 && attempt.duration_s <= kLongest_s))
    return refuse("the duration is not 0 s to a day", "duration_s", "correct it");
  if (attempt.score && attempt.state != State::kFinished)
    return refuse("only a finished attempt has a score", "score", "leave it empty, or correct the state");
  for (const char* column : {"task", "patient", "hash", "level", "operator", "station", "version", "person", "course"})
    if (has_control_characters(table.text(row, column)))
      return refuse("the text has line breaks or other control characters", column, "remove them");
  if (attempt.is_passed && (!attempt.score || attempt.state != State::kFinished))
    return refuse("an attempt without a score has not passed", "passed", "write 0, or its score");
  return {};
}

Result<AttemptRecord> read_row(const Table& table, std::size_t row) {
  AttemptRecord record;
  Attempt& attempt = record.attempt;
  attempt.id = table.text(row, "attempt");
  const auto state = find_state(table.text(row, "state"));
  if (!state)
    return fail("the state is unknown", table.place(row, "state"),
                "use running, finished, interrupted, unscored or never-began");
  const auto started = learning::parse_utc(table.text(row, "started_utc"));
  if (!started) return fail("the time is none", table.place(row, "started_utc"), "write it as 2026-01-02T03:04:05Z");
  TROCAR_TRY(const auto seed, table.number<std::uint64_t>(row, "seed"));
  TROCAR_TRY(const auto difficulty, table.number<int>(row, "case"));
  TROCAR_TRY(attempt.score, table.number<double>(row, "score"));
  TROCAR_TRY(attempt.is_passed, table.truth(row, "passed"));
  TROCAR_TRY(const auto duration_s, table.number<double>(row, "duration_s"));
  attempt.the_case = {table.text(row, "task"), table.text(row, "patient"), seed.value_or(1), table.text(row, "hash"),
                      difficulty};
  attempt.level = table.text(row, "level");
  attempt.operator_name = table.text(row, "operator");
  attempt.station = table.text(row, "station");
  attempt.started = *started;
  attempt.state = *state;
  attempt.duration_s = duration_s.value_or(0.0);
  attempt.program_version = table.text(row, "version");
  TROCAR_TRY_STATUS(check_row(table, row, attempt));
  TROCAR_TRY_STATUS(read_values(table, row, record));
  double sum = 0.0;
  for (const auto& part : record.parts) sum += part.points;
  if (attempt.score && !record.parts.empty() && std::abs(std::min(sum, 100.0) - *attempt.score) > kScoreRoundOff)
    return fail(fmt::format("the score is {:g}, its parts add up to {:g}", *attempt.score, sum),
                table.place(row, "score"), "correct the score, or the points of a part");
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
  const auto group = find_group(table.text(row, "group"));
  if (!group) return fail("the group is unknown", table.place(row, "group"), "use trainee or expert");
  TROCAR_TRY(const bool is_simulated, table.truth(row, "simulated"));
  if (const auto found = find_person_named(session, name_key(*name))) return found->id;
  const auto added = add_person(session, {*name, *group, table.text(row, "course"), is_simulated, {}}, now);
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
    std::map<std::string, std::string> people, groups;
    std::map<std::string, std::size_t> lines;  // rows of the attempts
    for (std::size_t row = 1; row < table.rows(); ++row) {
      TROCAR_TRY(AttemptRecord record, read_row(table, row));
      if (const auto [first, is_new] = lines.emplace(record.attempt.id, row); !is_new)
        return fail("the attempt occurs twice", table.place(row, "attempt"),
                    fmt::format("remove this row, or that of {}", table.place(first->second, "")));
      const std::string who = table.text(row, "group") + table.text(row, "simulated");
      if (const auto [told, is_first] = groups.emplace(table.text(row, "person"), who);
          !is_first && told->second != who)
        return fail("the person has another group in an earlier row", table.place(row, "group"), "correct one of them");
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
