#include "results/validity.h"

#include <algorithm>
#include <map>
#include <vector>

#include "metrics/metric.h"
#include "results/detail/attempt_query.h"
#include "results/names.h"

namespace trocar::results {
namespace {

/// Mean of one person's values by their name (metric or part).
struct NamedMean {
  std::string person_id, name, unit;
  double mean = 0.0;
};
struct PersonMean {
  std::string person_id;
  bool is_expert = false, is_simulated = false;
  std::optional<double> score;  ///< Empty: no attempt has one.
  double pass_share = 0.0;
  std::size_t attempts = 0, unscored = 0;
};
struct Means {
  std::vector<PersonMean> people;
  std::vector<NamedMean> metrics, parts;
};

/// Reads means over the chosen attempts of each person.
class MeanReader {
 public:
  MeanReader(soci::session& session, const EvidenceFilter& filter)
      : session_(session),
        task_(filter.task),
        course_key_(filter.course.empty() ? std::string() : name_key(filter.course)),
        patient_(filter.patient),
        level_(filter.level),
        first_(bounded(filter.attempts.first)),
        last_(bounded(filter.attempts.last)) {}

  Means read() {
    Means means;
    read_people(means.people);
    // Groups by number, not by name: an order of magnitude fewer comparisons of texts.
    means.metrics = read_named(
        "SELECT g.person_id, m.name, m.unit, g.mean FROM (SELECT c.person_id, v.metric_id, avg(v.value) AS mean FROM"
        " chosen c JOIN attempt_metrics v ON v.sequence = c.sequence GROUP BY c.person_id, v.metric_id) g JOIN metrics"
        " m ON m.id = g.metric_id");
    means.parts = read_named(
        "SELECT c.person_id, v.part, '', avg(v.points) FROM chosen c JOIN attempt_parts v ON v.sequence = c.sequence"
        " GROUP BY c.person_id, v.part");
    return means;
  }

 private:
  static long long bounded(std::size_t number) {
    constexpr std::size_t kMost = 1'000'000'000;
    return static_cast<long long>(std::min(number, kMost));
  }

  /// The chosen attempts as the table `chosen`, and a query on it.
  std::string with_chosen(const std::string& query) const {
    std::string text =
        "WITH chosen AS (SELECT sequence, person_id, is_expert, is_simulated, score, is_passed FROM (SELECT a.sequence,"
        " a.person_id, p.is_expert, p.is_simulated, a.score, a.is_passed, row_number() OVER (PARTITION BY a.person_id"
        " ORDER BY a.sequence) AS number FROM attempts a JOIN people p ON p.id = a.person_id WHERE a.task = :task AND"
        " a.state IN (1, 3)";
    if (!course_key_.empty()) text += " AND p.course_id = (SELECT id FROM courses WHERE name_key = :course)";
    if (!patient_.empty()) text += " AND a.case_id IN (SELECT q.id FROM cases q WHERE q.patient = :patient)";
    if (!level_.empty()) text += " AND a.level = :level";
    return text + ") counted WHERE number >= :first AND number <= :last) " + query;
  }

  void execute(soci::statement& select, const std::string& query) {
    select.exchange(soci::use(task_));
    for (const std::string* text : {&course_key_, &patient_, &level_})
      if (!text->empty()) select.exchange(soci::use(*text));
    select.exchange(soci::use(first_));
    select.exchange(soci::use(last_));
    select.alloc();
    select.prepare(with_chosen(query));
    select.define_and_bind();
    select.execute();
  }

  void read_people(std::vector<PersonMean>& people) {
    PersonMean person;
    detail::Nullable<double> score;
    int is_expert = 0, is_simulated = 0;
    long long attempts = 0, scored = 0, passed = 0;
    soci::statement select(session_);
    select.exchange(soci::into(person.person_id));
    select.exchange(soci::into(is_expert));
    select.exchange(soci::into(is_simulated));
    select.exchange(soci::into(score.value, score.indicator));
    select.exchange(soci::into(attempts));
    select.exchange(soci::into(scored));
    select.exchange(soci::into(passed));
    execute(select,
            "SELECT person_id, is_expert, is_simulated, avg(score), count(*), count(score), sum(is_passed) FROM chosen"
            " GROUP BY person_id, is_expert, is_simulated ORDER BY person_id");
    while (select.fetch()) {
      person.score = score.get();
      person.pass_share = static_cast<double>(passed) / static_cast<double>(attempts);
      person.attempts = static_cast<std::size_t>(attempts);
      person.unscored = static_cast<std::size_t>(attempts - scored);
      person.is_expert = is_expert != 0;
      person.is_simulated = is_simulated != 0;
      people.push_back(person);
    }
  }

  std::vector<NamedMean> read_named(const std::string& query) {
    std::vector<NamedMean> means;
    NamedMean one;
    soci::statement select(session_);
    select.exchange(soci::into(one.person_id));
    select.exchange(soci::into(one.name));
    select.exchange(soci::into(one.unit));
    select.exchange(soci::into(one.mean));
    execute(select, query);
    while (select.fetch()) means.push_back(one);
    return means;
  }

  soci::session& session_;
  std::string task_, course_key_, patient_, level_;
  long long first_, last_;
};

void leave_out_simulated(std::vector<PersonMean>& people) {
  const auto has_real = [&](bool is_expert) {
    return std::any_of(people.begin(), people.end(),
                       [&](const PersonMean& person) { return person.is_expert == is_expert && !person.is_simulated; });
  };
  if (has_real(true) && has_real(false))
    std::erase_if(people, [](const PersonMean& person) { return person.is_simulated; });
}

cohort::Better better_of(metrics::Better better) {
  switch (better) {
    case metrics::Better::kLower:
      return cohort::Better::kLower;
    case metrics::Better::kHigher:
      return cohort::Better::kHigher;
    case metrics::Better::kNeither:
      break;
  }
  return cohort::Better::kNeither;
}

using Columns = std::map<std::string, std::vector<std::optional<double>>>;

/// One column a name, one row a person.
Columns columns_of(const std::vector<NamedMean>& means, const std::map<std::string, std::size_t>& rows) {
  Columns columns;
  for (const NamedMean& mean : means) {
    const auto row = rows.find(mean.person_id);
    if (row == rows.end()) continue;  // simulated, or scored by another station since
    std::vector<std::optional<double>>& column = columns[mean.name];
    column.resize(rows.size());
    column[row->second] = mean.mean;
  }
  return columns;
}

/// In the order of the catalogue; metrics of another program follow.
std::vector<cohort::MetricOfPeople> metrics_of(const std::vector<NamedMean>& means, Columns columns) {
  std::vector<cohort::MetricOfPeople> metrics;
  for (const metrics::MetricDescription& known : metrics::metric_catalogue()) {
    const auto column = columns.find(known.name);
    if (column == columns.end()) continue;
    metrics.push_back({known.name, known.title, known.unit, better_of(known.better), std::move(column->second)});
    columns.erase(column);
  }
  std::map<std::string, std::string> units;
  for (const NamedMean& mean : means) units[mean.name] = mean.unit;
  for (auto& [name, column] : columns)
    metrics.push_back({name, name, units[name], cohort::Better::kNeither, std::move(column)});
  return metrics;
}

}  // namespace

Result<cohort::CohortData> cohort_data(Repository& repository, const EvidenceFilter& filter) {
  TROCAR_TRY(Means means, repository.database().run(detail::kCannotReadAttempts, [&](soci::session& session) {
    return MeanReader(session, filter).read();
  }));
  leave_out_simulated(means.people);
  cohort::CohortData data;
  std::map<std::string, std::size_t> rows;
  for (const PersonMean& person : means.people) {
    rows.emplace(person.person_id, rows.size());
    data.people.push_back({person.is_expert, person.is_simulated, person.attempts, person.unscored});
    data.scores.push_back(person.score);
    data.pass_shares.emplace_back(person.pass_share);
  }
  data.metrics = metrics_of(means.metrics, columns_of(means.metrics, rows));
  data.items.resize(rows.size());
  for (const auto& [name, column] : columns_of(means.parts, rows))
    for (std::size_t row = 0; row < rows.size(); ++row) data.items[row].push_back(column[row]);
  return data;
}

Result<EvidenceChoices> evidence_choices(Repository& repository, std::string_view task) {
  return repository.database().run(detail::kCannotReadAttempts, [&](soci::session& session) {
    const std::string name(task);
    const auto names = [&](const std::string& query) {
      std::vector<std::string> found;
      std::string one;
      soci::statement select = (session.prepare << query, soci::use(name), soci::into(one));
      select.execute();
      while (select.fetch()) found.push_back(one);
      return found;
    };
    return EvidenceChoices{
        names(
            "SELECT DISTINCT c.patient FROM attempts a JOIN cases c ON c.id = a.case_id WHERE a.task = :t ORDER BY 1"),
        names("SELECT DISTINCT level FROM attempts WHERE task = :t AND level <> '' ORDER BY 1")};
  });
}

Result<cohort::Validity> validity_of(Repository& repository, const EvidenceFilter& filter,
                                     const cohort::ValidityRules& rules) {
  TROCAR_TRY(const cohort::CohortData data, cohort_data(repository, filter));
  return cohort::validity_of(data, rules);
}

}  // namespace trocar::results
