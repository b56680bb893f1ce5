#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <type_traits>
#include <unordered_map>

#include "config/csv.h"
#include "core/files/input_file.h"
#include "core/text.h"
#include "database/sqlite_cache.h"
#include "learning/history.h"
#include "metrics/metric.h"
#include "results/attempts_csv.h"
#include "results/detail/attempt_query.h"
#include "results/detail/attempt_writer.h"
#include "results/detail/csv_columns.h"
#include "results/names.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr FileLimit kCsvFile{FileKind::kOther, "CSV file", std::uint64_t{1} << 40};
constexpr std::size_t kPieceBytes = std::size_t{64} << 10;
/// Of SQLite's pages: the indexes of 100,000 attempts, so that the work does not grow faster than the file.
constexpr std::size_t kCacheBytes = std::size_t{48} << 20;
/// Any number that no other lock of the database has: imports that wait for each other's people would stop each other.
constexpr long long kImportLock = 0x74726369;
constexpr const char* kUseExport = "use a file of trocar results export";
constexpr double kRoundOff = 1e-6;       ///< Of points.
constexpr double kScoreRoundOff = 0.01;  ///< Of a sum of points.
constexpr double kLongest_s = 86'400.0;  ///< Of an attempt: a day.

/// What a metric of the catalogue cannot be; empty: it can. Others are not known here.
std::string impossible(const std::optional<metrics::MetricDescription>& known, double value) {
  if (!known) return {};
  const std::string_view metric = known->name;
  const bool may_be_negative = metric == "spectral_arc_length" || metric == "log_dimensionless_jerk";
  if (value < 0.0 && !may_be_negative) return "negative";
  const bool is_yes_or_no = metric == "first_pass_success" || metric == "end_in_target";
  if (is_yes_or_no && value != 0.0 && value != 1.0) return "neither 0 nor 1";
  if (std::string_view(known->unit) == "%" && value > 100.0) return "above 100 %";
  return {};
}

/// The rows of a file, read one after the other.
class AttemptRows {
 public:
  static Result<AttemptRows> open(const std::filesystem::path& file) {
    TROCAR_TRY(const InputFile input, InputFile::open(file, kCsvFile));
    const auto stream = std::make_shared<std::ifstream>(input.pinned_path(), std::ios::binary);
    const auto read = [stream, name = file.string()]() -> Result<std::string> {
      std::string piece(kPieceBytes, '\0');
      stream->read(piece.data(), static_cast<std::streamsize>(piece.size()));
      if (stream->bad()) return fail("cannot be read", name, "check the file");
      piece.resize(static_cast<std::size_t>(stream->gcount()));
      return piece;
    };
    config::CsvReader reader(read, file.string());
    config::CsvRow header;
    TROCAR_TRY(const bool has_header, reader.next(header));
    if (!has_header) return fail("the file is empty", file.string(), kUseExport);
    TROCAR_TRY(CsvColumns columns, CsvColumns::read(header, file.string()));
    return AttemptRows(std::move(reader), std::move(columns), file.string());
  }

  /// Reads the next row; false: there is none. Error: another number of fields than in the header.
  Result<bool> next() {
    TROCAR_TRY(const bool has_row, reader_.next(row_));
    if (!has_row || row_.fields.size() == columns_.size()) return has_row;
    return fail(fmt::format("the row has {} fields, the header {}", row_.fields.size(), columns_.size()), place(),
                "put commas between the fields of a row, and decimal points into numbers");
  }

  std::size_t line() const { return row_.line; }
  const CsvColumns& columns() const { return columns_; }
  std::string text(Column column) const { return config::plain_text(field(column)); }
  std::string place() const { return place_of_line(row_.line); }
  std::string place(std::string_view column) const { return fmt::format("{}, column {}", place(), column); }
  std::string place(Column column) const { return place(kAttemptColumns[static_cast<std::size_t>(column)]); }
  std::string place_of_line(std::size_t line) const { return fmt::format("{}, line {}", where_, line); }

  /// Empty: an empty field. Error: no finite number. A negative one was written without an apostrophe.
  template <class Number>
  Result<std::optional<Number>> number(std::size_t place_of_column) const {
    const std::string& text = row_.fields[place_of_column];
    if (text.empty()) return std::optional<Number>();
    if (const auto value = parse_number<Number>(text)) return std::optional<Number>(*value);
    return fail(fmt::format("\"{}\" is no {}number", text, std::is_integral_v<Number> ? "whole " : ""),
                place(columns_.name(place_of_column)),
                "write numbers with a decimal point, and leave a missing value empty");
  }
  template <class Number>
  Result<std::optional<Number>> number(Column column) const {
    const auto place_of_column = columns_.find(column);
    return place_of_column ? number<Number>(*place_of_column) : Result<std::optional<Number>>();
  }
  /// "1" or "0"; an empty field is 0.
  Result<bool> truth(Column column) const {
    const std::string& text = field(column);
    if (text.empty() || text == "0" || text == "1") return text == "1";
    return fail(fmt::format("\"{}\" is neither 0 nor 1", text), place(column), "write 0 or 1");
  }

 private:
  AttemptRows(config::CsvReader reader, CsvColumns columns, std::string where)
      : reader_(std::move(reader)), columns_(std::move(columns)), where_(std::move(where)) {}
  const std::string& field(Column column) const {
    static const std::string kMissing;
    const auto found = columns_.find(column);
    return found ? row_.fields[*found] : kMissing;
  }

  config::CsvReader reader_;
  CsvColumns columns_;
  std::string where_;
  config::CsvRow row_;
};

Status read_values(const AttemptRows& row, AttemptRecord& record) {
  for (const CsvColumns::Part& part : row.columns().parts()) {
    TROCAR_TRY(const auto points, row.number<double>(part.points));
    if (!points) continue;
    TROCAR_TRY(const auto most, row.number<double>(part.of_most));
    if (!most || !(*most > 0.0) || *points > *most + kRoundOff || *points < 0.0)
      return fail(fmt::format("the points are not of {}", most ? fmt::format("{:g}", *most) : "a number"),
                  row.place(row.columns().name(part.points)),
                  fmt::format("correct it, or the column \"{}\"", row.columns().name(part.of_most)));
    record.parts.push_back({part.name, *points, *most});
  }
  for (const CsvColumns::Metric& metric : row.columns().metrics()) {
    TROCAR_TRY(const auto value, row.number<double>(metric.place));
    if (!value) continue;
    if (const std::string fault = impossible(metric.known, *value); !fault.empty())
      return fail(fmt::format("{:g} is {}", *value, fault), row.place(row.columns().name(metric.place)),
                  "correct it, or leave it empty");
    record.measures.push_back({metric.measure.name, metric.measure.unit, *value});
  }
  return {};
}

/// What has to be within a range or a list.
Status check_row(const AttemptRows& row, const Attempt& attempt) {
  if (Status can = check_storable(attempt); !can) {
    can.error().where = row.place(can.error().where);
    return can;
  }
  const auto refuse = [&](const char* what, Column column, const char* advice) {
    return fail(what, row.place(column), advice);
  };
  if (attempt.score && !(*attempt.score >= 0.0 && *attempt.score <= 100.0))
    return refuse("the score is not 0 to 100", Column::kScore, "correct it");
  if (attempt.the_case.difficulty && (*attempt.the_case.difficulty < 1 || *attempt.the_case.difficulty > 5))
    return refuse("the difficulty is not 1 to 5", Column::kCase, "correct it, or leave it empty");
  if (!(attempt.duration_s >= 0.0 && attempt.duration_s <= kLongest_s))
    return refuse("the duration is not 0 s to a day", Column::kDuration, "correct it");
  if (attempt.score && attempt.state != State::kFinished)
    return refuse("only a finished attempt has a score", Column::kScore, "leave it empty, or correct the state");
  if (attempt.is_passed && (!attempt.score || attempt.state != State::kFinished))
    return refuse("an attempt without a score has not passed", Column::kPassed, "write 0, or its score");
  return {};
}

Result<AttemptRecord> read_record(const AttemptRows& row) {
  AttemptRecord record;
  Attempt& attempt = record.attempt;
  attempt.id = row.text(Column::kAttempt);
  const auto state = find_state(row.text(Column::kState));
  if (!state)
    return fail("the state is unknown", row.place(Column::kState),
                "use running, finished, interrupted, unscored or never-began");
  const auto started = learning::parse_utc(row.text(Column::kStarted));
  if (!started) return fail("the time is none", row.place(Column::kStarted), "write it as 2026-01-02T03:04:05Z");
  TROCAR_TRY(const auto seed, row.number<std::uint64_t>(Column::kSeed));
  TROCAR_TRY(const auto difficulty, row.number<int>(Column::kCase));
  TROCAR_TRY(attempt.score, row.number<double>(Column::kScore));
  TROCAR_TRY(attempt.is_passed, row.truth(Column::kPassed));
  TROCAR_TRY(const auto duration_s, row.number<double>(Column::kDuration));
  attempt.the_case = {row.text(Column::kTask), row.text(Column::kPatient), seed.value_or(1), row.text(Column::kHash),
                      difficulty};
  attempt.level = row.text(Column::kLevel);
  attempt.operator_name = row.text(Column::kOperator);
  attempt.station = row.text(Column::kStation);
  attempt.started = *started;
  attempt.state = *state;
  attempt.duration_s = duration_s.value_or(0.0);
  attempt.program_version = row.text(Column::kVersion);
  TROCAR_TRY_STATUS(check_row(row, attempt));
  TROCAR_TRY_STATUS(read_values(row, record));
  double sum = 0.0;
  for (const auto& part : record.parts) sum += part.points;
  if (attempt.score && !record.parts.empty() && std::abs(std::min(sum, 100.0) - *attempt.score) > kScoreRoundOff)
    return fail(fmt::format("the score is {:g}, its parts add up to {:g}", *attempt.score, sum),
                row.place(Column::kScore), "correct the score, or the points of a part");
  return record;
}

std::string group_words(Group group, bool is_simulated) {
  return fmt::format("{}{}", is_simulated ? "a simulated " : group == Group::kExpert ? "an " : "a ", to_string(group));
}

/// The people that the rows name.
class PeopleOfRows {
 public:
  PeopleOfRows(soci::session& session, Seconds now) : session_(session), now_(now) {}

  std::int64_t added() const { return added_; }
  /// The id of the person of a row, added if there is none of this name.
  Result<std::string> person_of(const AttemptRows& row) {
    const std::string name = row.text(Column::kPerson), group = row.text(Column::kGroup) + row.text(Column::kSimulated);
    if (const auto known = known_.find(name); known != known_.end()) {
      if (known->second.group == group) return known->second.id;
      return fail("the person has another group in an earlier row", row.place(Column::kGroup), "correct one of them");
    }
    TROCAR_TRY(const std::string id, find_or_add(row, name));
    known_[name] = {id, group};
    return id;
  }

 private:
  Result<std::string> find_or_add(const AttemptRows& row, const std::string& name) {
    const auto group = find_group(row.text(Column::kGroup));
    if (!group) return fail("the group is unknown", row.place(Column::kGroup), "use trainee or expert");
    TROCAR_TRY(const bool is_simulated, row.truth(Column::kSimulated));
    const std::string course = row.text(Column::kCourse);
    const auto at = [&](Column column, Error error) {
      error.where = row.place(column);
      return tl::unexpected(std::move(error));
    };
    if (!course.empty())
      if (const auto clean = clean_name(course, "the name of a course"); !clean)
        return at(Column::kCourse, clean.error());
    const auto found = find_or_add_person(session_, {name, *group, course, is_simulated, {}}, now_);
    if (!found) return at(Column::kPerson, found.error());
    if (const Person& person = found->person; person.group != *group || person.is_simulated != is_simulated)
      return fail(fmt::format("\"{}\" is {} in the database, {} in this row", person.name,
                              group_words(person.group, person.is_simulated), group_words(*group, is_simulated)),
                  row.place(Column::kGroup), "correct the row, or change the person (trocar results change)");
    added_ += found->is_added ? 1 : 0;
    return found->person.id;
  }

  struct Known {
    std::string id, group;
  };
  soci::session& session_;
  Seconds now_;
  std::map<std::string, Known> known_;
  std::int64_t added_ = 0;
};

Result<ImportedRows> write_rows(soci::session& session, const database::Database& database,
                                const std::filesystem::path& file, Seconds now) {
  TROCAR_TRY(AttemptRows rows, AttemptRows::open(file));
  if (!database.is_sqlite()) session << fmt::format("SELECT pg_advisory_xact_lock({})", kImportLock);
  ImportedRows imported;
  AttemptWriter writer(session, database);
  PeopleOfRows people(session, now);
  std::unordered_map<std::string, std::size_t> lines;  // of the attempts
  while (true) {
    TROCAR_TRY(const bool has_row, rows.next());
    if (!has_row) break;
    TROCAR_TRY(AttemptRecord record, read_record(rows));
    if (const auto [first, is_new] = lines.emplace(record.attempt.id, rows.line()); !is_new)
      return fail("the attempt occurs twice", rows.place(Column::kAttempt),
                  fmt::format("remove this row, or that of {}", rows.place_of_line(first->second)));
    TROCAR_TRY(record.attempt.person_id, people.person_of(rows));
    TROCAR_TRY(const std::optional<State> written, writer.merge(record));
    ++(written ? imported.added : imported.present);
    if (written) imported.counts.add(ending_of(*written), record.attempt.is_passed);
  }
  imported.people = people.added();
  return imported;
}

}  // namespace

Result<ImportedRows> import_attempts(Repository& repository, const std::filesystem::path& file, Seconds now) {
  TROCAR_TRY_STATUS(AttemptRows::open(file));  // a wrong file stops no other writer
  database::Database& database = repository.database();
  const database::SqliteCache cache(database, kCacheBytes);
  return database.transaction("the attempts cannot be written",
                              [&](soci::session& session) { return write_rows(session, database, file, now); });
}

}  // namespace trocar::results
