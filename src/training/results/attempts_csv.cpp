#include "results/attempts_csv.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>

#include "config/csv.h"
#include "core/files/output_file.h"
#include "results/detail/attempt_query.h"
#include "results/detail/csv_columns.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr double kPerSecond = 1e6;             ///< Durations are written in whole microseconds.
constexpr std::size_t kAttemptsOfPiece = 500;  ///< About half a megabyte.

std::string utc_text(Seconds time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

void append_number(std::string& text, double value) {
  fmt::format_to(std::back_inserter(text), "{}", value);
}

/// The fixed fields of a row, without the comma behind them.
void append_fixed(std::string& text, const Attempt& a, const Person& person) {
  const auto add = [&](std::string_view field) {
    text += field;
    text += ',';
  };
  add(config::csv_text(a.id));
  add(config::csv_text(person.name));
  add(to_string(person.group));
  add(person.is_simulated ? "1" : "0");
  add(config::csv_text(person.course));
  add(config::csv_text(a.the_case.task));
  add(config::csv_text(a.the_case.patient));
  add(std::to_string(a.the_case.seed));
  add(config::csv_text(a.the_case.patient_hash));
  add(a.the_case.difficulty ? std::to_string(*a.the_case.difficulty) : "");
  add(config::csv_text(a.level));
  add(config::csv_text(a.operator_name));
  add(config::csv_text(a.station));
  add(utc_text(a.started));
  add(to_string(a.state));
  if (a.score) append_number(text, *a.score);
  add("");
  add(a.is_passed ? "1" : "0");
  append_number(text, std::round(a.duration_s * kPerSecond) / kPerSecond);
  add("");
  text += config::csv_text(a.program_version);
}

template <class Visit>
void visit_rows(soci::statement& select, const Visit& visit) {
  select.execute();
  while (select.fetch()) visit();
}

/// "1,5,7": the sequences of attempts.
std::string list_of(const std::vector<Attempt>& attempts) {
  std::string list;
  for (const Attempt& attempt : attempts)
    fmt::format_to(std::back_inserter(list), "{}{}", list.empty() ? "" : ",", attempt.sequence);
  return list;
}

std::size_t row_of(const std::vector<Attempt>& attempts, long long sequence) {
  const auto found = std::ranges::lower_bound(attempts, sequence, {}, &Attempt::sequence);
  return static_cast<std::size_t>(found - attempts.begin());
}

/// Values of attempts, one row after the other; NaN: none.
class ValueTable {
 public:
  ValueTable(std::size_t rows, std::size_t columns) : columns_(columns), values_(rows * columns, std::nan("")) {}

  void put(std::size_t row, std::size_t column, double value) { values_[row * columns_ + column] = value; }
  std::span<const double> row(std::size_t n) const { return std::span(values_).subspan(n * columns_, columns_); }

 private:
  std::size_t columns_;
  std::vector<double> values_;
};

/// False: a value has no column.
bool read_parts(soci::session& session, const std::vector<Attempt>& attempts,
                const std::map<std::string, std::size_t, std::less<>>& columns, ValueTable& values) {
  bool is_whole = true;
  long long sequence = 0;
  std::string part;
  double points = 0.0, of_most = 0.0;
  soci::statement select =
      (session.prepare << "SELECT sequence, part, points, max_points FROM attempt_parts WHERE sequence IN (" +
                              list_of(attempts) + ")",
       soci::into(sequence), soci::into(part), soci::into(points), soci::into(of_most));
  visit_rows(select, [&] {
    const auto column = columns.find(part);
    if (column == columns.end()) return void(is_whole = false);
    const std::size_t row = row_of(attempts, sequence);
    values.put(row, column->second, points);
    values.put(row, column->second + 1, of_most);
  });
  return is_whole;
}

bool read_metrics(soci::session& session, const std::vector<Attempt>& attempts,
                  const std::map<long long, std::size_t>& columns, ValueTable& values) {
  bool is_whole = true;
  long long sequence = 0, metric = 0;
  double value = 0.0;
  soci::statement select =
      (session.prepare << "SELECT sequence, metric_id, value FROM attempt_metrics WHERE sequence IN (" +
                              list_of(attempts) + ")",
       soci::into(sequence), soci::into(metric), soci::into(value));
  visit_rows(select, [&] {
    const auto column = columns.find(metric);
    if (column == columns.end()) return void(is_whole = false);
    values.put(row_of(attempts, sequence), column->second, value);
  });
  return is_whole;
}

AttemptQuery piece_query(const AttemptFilter& filter, std::int64_t after, std::int64_t last) {
  AttemptQuery query = make_query(filter);
  query.condition += " AND a.sequence > :after AND a.sequence <= :last";
  query.numbers.push_back(after);
  query.numbers.push_back(last);
  return query;
}

}  // namespace

Result<AttemptsExport> AttemptsExport::begin(Repository& repository, const AttemptFilter& filter) {
  TROCAR_TRY(std::vector<Person> people, list_people(repository));
  AttemptsExport begun;
  begun.filter_ = filter;
  for (Person& person : people) begun.people_[person.id] = std::move(person);
  TROCAR_TRY_STATUS(repository.database().snapshot(kCannotReadAttempts, [&](soci::session& session) {
    std::vector<std::string> names(kAttemptColumns.begin(), kAttemptColumns.end());
    begun.parts_.clear();
    begun.metrics_.clear();
    std::string name, unit;
    long long metric = 0, last = 0;
    soci::statement parts =
        (session.prepare << "SELECT DISTINCT part FROM attempt_parts ORDER BY part", soci::into(name));
    visit_rows(parts, [&] {
      begun.parts_[name] = names.size() - kAttemptColumns.size();
      names.push_back(config::csv_text(fmt::format("{}{}", kPartColumn, name)));
      names.push_back(config::csv_text(fmt::format("{}{}{}", kPartColumn, name, kOfMost)));
    });
    soci::statement metrics = (session.prepare << "SELECT id, name, unit FROM metrics ORDER BY name",
                               soci::into(metric), soci::into(name), soci::into(unit));
    visit_rows(metrics, [&] {
      begun.metrics_[metric] = names.size() - kAttemptColumns.size();
      names.push_back(config::csv_text(metric_column(name, unit)));
    });
    session << "SELECT coalesce(max(sequence), 0) FROM attempts", soci::into(last);
    begun.values_ = names.size() - kAttemptColumns.size();
    begun.last_ = last;
    begun.header_ = config::csv_row(names);
  }));
  return begun;
}

Result<std::string> AttemptsExport::next(Repository& repository) {
  if (!header_.empty()) return std::exchange(header_, {});
  std::string text;
  // A piece without rows would be the end: all of its people may have been added since.
  while (text.empty() && after_ < last_) {
    TROCAR_TRY_STATUS(repository.database().snapshot(kCannotReadAttempts, [&](soci::session& session) -> Status {
      text.clear();
      const std::vector<Attempt> attempts = read_attempts(
          session, piece_query(filter_, after_, last_), fmt::format(" ORDER BY a.sequence LIMIT {}", kAttemptsOfPiece));
      if (attempts.empty()) {
        after_ = last_;
        return {};
      }
      ValueTable values(attempts.size(), values_);
      const bool has_parts = read_parts(session, attempts, parts_, values);
      if (!read_metrics(session, attempts, metrics_, values) || !has_parts)
        return fail("the attempts have got new parts or metrics while they were exported", {}, "export them again");
      for (std::size_t n = 0; n < attempts.size(); ++n) {
        const auto person = people_.find(attempts[n].person_id);
        if (person == people_.end()) continue;  // added since the people were read
        append_fixed(text, attempts[n], person->second);
        for (const double value : values.row(n)) {
          text += ',';
          if (!std::isnan(value)) append_number(text, value);
        }
        text += "\r\n";
      }
      after_ = attempts.back().sequence;
      return {};
    }));
  }
  return text;
}

Result<std::string> attempts_csv(Repository& repository, const AttemptFilter& filter) {
  TROCAR_TRY(AttemptsExport attempts, AttemptsExport::begin(repository, filter));
  std::string text;
  while (true) {
    TROCAR_TRY(const std::string piece, attempts.next(repository));
    if (piece.empty()) return text;
    text += piece;
  }
}

Status export_attempts(Repository& repository, const AttemptFilter& filter, const std::filesystem::path& file) {
  TROCAR_TRY(AttemptsExport attempts, AttemptsExport::begin(repository, filter));
  return write_atomically(file, [&](const std::filesystem::path& temporary) -> Status {
    std::ofstream out(temporary, std::ios::binary);
    while (out) {
      TROCAR_TRY(const std::string piece, attempts.next(repository));
      if (piece.empty()) break;
      out.write(piece.data(), static_cast<std::streamsize>(piece.size()));
    }
    out.close();
    if (out) return {};
    return fail(fmt::format("cannot be written: {}", std::strerror(errno)), file.string(),
                "check the disk space and the permissions");
  });
}

}  // namespace trocar::results
