#include "results/attempts_csv.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/files/atomic_file.h"
#include "core/parse_number.h"
#include "results/csv_text.h"
#include "results/detail/attempt_query.h"
#include "results/detail/attempt_writer.h"
#include "results/detail/people_table.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr double kPerSecond = 1e6;  ///< Durations are written in whole microseconds.

std::string utc_text(Seconds time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

/// Values of the columns behind the fixed ones, of one attempt after the other.
class ValueReader {
 public:
  /// `select` yields sequence, name and value, ordered by sequence.
  ValueReader(soci::session& session, const AttemptQuery& query, const std::string& select) : statement_(session) {
    statement_.exchange(soci::into(sequence_));
    statement_.exchange(soci::into(name_));
    statement_.exchange(soci::into(value_));
    query.bind(statement_);
    statement_.alloc();
    statement_.prepare(select);
    statement_.define_and_bind();
    statement_.execute();
    has_row_ = statement_.fetch();
  }

  template <class Visitor>
  void visit(std::int64_t sequence, const Visitor& take) {
    for (; has_row_ && sequence_ <= sequence; has_row_ = statement_.fetch())
      if (sequence_ == sequence) take(name_, value_);
  }

 private:
  soci::statement statement_;
  long long sequence_ = 0;
  std::string name_;
  double value_ = 0.0;
  bool has_row_ = false;
};

std::vector<std::string> fixed_fields(const Attempt& a, const Person& person) {
  return {a.id,
          csv_text(person.name),
          to_string(person.group),
          person.is_simulated ? "1" : "0",
          csv_text(person.course),
          csv_text(a.the_case.task),
          csv_text(a.the_case.patient),
          std::to_string(a.the_case.seed),
          a.the_case.patient_hash,
          a.the_case.difficulty ? std::to_string(*a.the_case.difficulty) : "",
          a.level,
          csv_text(a.operator_name),
          csv_text(a.station),
          utc_text(a.started),
          to_string(a.state),
          a.score ? fmt::format("{}", *a.score) : "",
          a.is_passed ? "1" : "0",
          fmt::format("{}", std::round(a.duration_s * kPerSecond) / kPerSecond),
          csv_text(a.program_version)};
}

std::vector<std::string> names_of(soci::session& session, const std::string& query) {
  std::vector<std::string> names;
  std::string name;
  soci::statement select = (session.prepare << query, soci::into(name));
  select.execute();
  while (select.fetch()) names.push_back(name);
  return names;
}

std::string write_csv(soci::session& session, const AttemptFilter& filter,
                      const std::map<std::string, Person>& people) {
  std::vector<std::string> row(kAttemptColumns.begin(), kAttemptColumns.end());
  std::map<std::string, std::size_t, std::less<>> columns;
  const auto add_column = [&](const std::string& name) {
    columns[name] = row.size();
    row.push_back(csv_text(name));
  };
  for (const std::string& part : names_of(session, "SELECT DISTINCT part FROM attempt_parts ORDER BY part")) {
    add_column(fmt::format("{}{}", kPartColumn, part));
    add_column(fmt::format("{}{}{}", kPartColumn, part, kOfMost));
  }
  for (const std::string& metric : names_of(session, "SELECT name || ' (' || unit || ')' FROM metrics ORDER BY name"))
    add_column(fmt::format("{}{}", kMetricColumn, metric));
  std::string text = csv_row(row);

  const AttemptQuery query = make_query(filter);
  const auto values_of = [&](const char* column, const char* table, const char* join) {
    return fmt::format(
        "SELECT v.sequence, {} FROM {} v JOIN attempts a ON a.sequence = v.sequence{}{} ORDER BY v.sequence", column,
        table, join, query.condition);
  };
  ValueReader points(session, query, values_of("v.part, v.points", "attempt_parts", ""));
  ValueReader limits(session, query, values_of("v.part, v.max_points", "attempt_parts", ""));
  ValueReader measures(session, query,
                       values_of("m.name || ' (' || m.unit || ')', v.value", "attempt_metrics",
                                 " JOIN metrics m ON m.id = v.metric_id"));
  for (const Attempt& attempt : read_attempts(session, query, " ORDER BY a.sequence")) {
    const auto person = people.find(attempt.person_id);
    if (person == people.end()) continue;  // added since the people were read
    row.resize(kAttemptColumns.size() + columns.size());
    std::ranges::fill(row, "");
    std::ranges::copy(fixed_fields(attempt, person->second), row.begin());
    const auto put = [&](const std::string& name, double value) {
      if (const auto column = columns.find(name); column != columns.end())
        row[column->second] = fmt::format("{}", value);
    };
    points.visit(attempt.sequence,
                 [&](const std::string& name, double value) { put(fmt::format("{}{}", kPartColumn, name), value); });
    limits.visit(attempt.sequence, [&](const std::string& name, double value) {
      put(fmt::format("{}{}{}", kPartColumn, name, kOfMost), value);
    });
    measures.visit(attempt.sequence, [&](const std::string& name, double value) {
      put(fmt::format("{}{}", kMetricColumn, name), value);
    });
    text += csv_row(row);
  }
  return text;
}

}  // namespace

Result<std::string> attempts_csv(Repository& repository, const AttemptFilter& filter) {
  TROCAR_TRY(std::vector<Person> all, list_people(repository));
  std::map<std::string, Person> people;
  for (Person& person : all) people[person.id] = std::move(person);
  return repository.database().run("the attempts cannot be read",
                                   [&](soci::session& session) { return write_csv(session, filter, people); });
}

Status export_attempts(Repository& repository, const AttemptFilter& filter, const std::filesystem::path& file) {
  TROCAR_TRY(const std::string text, attempts_csv(repository, filter));
  return write_file_atomically(file, text);
}

}  // namespace trocar::results
