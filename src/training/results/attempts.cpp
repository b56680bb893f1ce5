#include "results/attempts.h"

#include <fmt/format.h>

#include <map>

#include "database/statements.h"
#include "results/detail/attempt_query.h"
#include "results/detail/attempt_writer.h"
#include "results/detail/details_json.h"
#include "results/repository.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotWriteAttempt = "the attempt cannot be written";
std::optional<Attempt> read_attempt(soci::session& session, std::string_view id) {
  std::vector<Attempt> found = read_attempts(session, {" WHERE a.id = :i", {std::string(id)}, {}});
  return found.empty() ? std::nullopt : std::optional(std::move(found.front()));
}

std::vector<Part> read_parts(soci::session& session, long long sequence) {
  std::vector<Part> parts;
  Part part;
  soci::statement select =
      (session.prepare << "SELECT part, points, max_points, value FROM attempt_parts WHERE sequence = :s ORDER BY part",
       soci::use(sequence), soci::into(part.name), soci::into(part.points), soci::into(part.max_points),
       soci::into(part.value));
  select.execute();
  while (select.fetch()) parts.push_back(part);
  return parts;
}

std::vector<Measure> read_measures(soci::session& session, long long sequence) {
  std::vector<Measure> measures;
  Measure measure;
  soci::statement select =
      (session.prepare << "SELECT m.name, m.unit, v.value FROM attempt_metrics v JOIN metrics m ON m.id = v.metric_id"
                          " WHERE v.sequence = :s ORDER BY m.id",
       soci::use(sequence), soci::into(measure.name), soci::into(measure.unit), soci::into(measure.value));
  select.execute();
  while (select.fetch()) measures.push_back(measure);
  return measures;
}

}  // namespace

Status begin_attempt(Repository& repository, const Attempt& attempt) {
  database::Database& database = repository.database();
  return database.transaction(kCannotWriteAttempt,
                              [&](soci::session& session) { return AttemptWriter(session, database).begin(attempt); });
}

Status forget_begun_attempt(Repository& repository, std::string_view id) {
  return repository.database().transaction(kCannotWriteAttempt, [&](soci::session& session) {
    const std::string key(id);
    const int state = static_cast<int>(State::kRunning);
    session << "DELETE FROM attempts WHERE id = :i AND state = :s", soci::use(key), soci::use(state);
  });
}

Result<std::int64_t> record_attempt(Repository& repository, const AttemptRecord& record, std::string_view recording) {
  database::Database& database = repository.database();
  return database.transaction(kCannotWriteAttempt, [&](soci::session& session) -> Result<std::int64_t> {
    TROCAR_TRY(const AttemptWriter::Recorded recorded, AttemptWriter(session, database).record(record, recording));
    return recorded.sequence;
  });
}

Result<bool> record_missing_attempt(Repository& repository, const AttemptRecord& record, std::string_view recording) {
  database::Database& database = repository.database();
  return database.transaction(kCannotWriteAttempt, [&](soci::session& session) -> Result<bool> {
    TROCAR_TRY(const AttemptWriter::Recorded recorded, AttemptWriter(session, database).record(record, recording));
    return recorded.is_written;
  });
}

Status record_attempts(Repository& repository, const std::vector<AttemptRecord>& records) {
  database::Database& database = repository.database();
  return database.transaction("the attempts cannot be written", [&](soci::session& session) -> Status {
    AttemptWriter writer(session, database);
    for (const AttemptRecord& record : records) TROCAR_TRY_STATUS(writer.record(record, {}));
    return {};
  });
}

Result<std::vector<Attempt>> list_attempts(Repository& repository, const AttemptFilter& filter) {
  std::string order = filter.is_newest_first ? " ORDER BY a.sequence DESC" : " ORDER BY a.sequence";
  if (filter.limit > 0) order += fmt::format(" LIMIT {}", filter.limit);
  const AttemptQuery query = make_query(filter);
  return repository.database().run(kCannotReadAttempts,
                                   [&](soci::session& session) { return read_attempts(session, query, order); });
}

Result<learning::AttemptCounts> count_attempts(Repository& repository, const AttemptFilter& given) {
  AttemptFilter filter = given;
  filter.before.reset();
  const AttemptQuery query = make_query(filter);
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    learning::AttemptCounts counts;
    int state = 0, is_passed = 0;
    long long count = 0;
    soci::statement select(session);
    select.exchange(soci::into(state));
    select.exchange(soci::into(is_passed));
    select.exchange(soci::into(count));
    query.bind(select);
    select.alloc();
    select.prepare("SELECT a.state, a.is_passed, count(*) FROM attempts a" + query.condition +
                   " GROUP BY a.state, a.is_passed");
    select.define_and_bind();
    select.execute();
    while (select.fetch()) counts.add(ending_of(static_cast<State>(state)), is_passed != 0, count);
    return counts;
  });
}

Result<std::optional<Attempt>> find_attempt(Repository& repository, std::string_view id) {
  return repository.database().run(kCannotReadAttempts,
                                   [&](soci::session& session) { return read_attempt(session, id); });
}

Result<std::optional<AttemptRecord>> load_attempt(Repository& repository, std::string_view id) {
  using Loaded = std::optional<AttemptRecord>;
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) -> Result<Loaded> {
    const std::optional<Attempt> attempt = read_attempt(session, id);
    if (!attempt) return Loaded();
    AttemptRecord record;
    record.attempt = *attempt;
    const long long sequence = attempt->sequence;
    record.parts = read_parts(session, sequence);
    record.measures = read_measures(session, sequence);
    std::string verdict, trace;
    session << "SELECT verdict, trace FROM attempt_details WHERE sequence = :s", soci::use(sequence),
        soci::into(verdict), soci::into(trace);
    if (!session.got_data()) return Loaded(std::move(record));  // it is running
    TROCAR_TRY_STATUS(read_verdict(verdict, record));
    TROCAR_TRY(record.trace, read_trace(trace));
    return Loaded(std::move(record));
  });
}

Result<std::optional<std::string>> load_recording(Repository& repository, std::string_view id) {
  database::Database& database = repository.database();
  return database.run("the recording cannot be read", [&](soci::session& session) -> std::optional<std::string> {
    const std::string key(id);
    std::string text;
    session << "SELECT " + database::bytes_out(database, "r.bytes") +
                   " FROM recordings r JOIN attempts a ON a.sequence = r.sequence WHERE a.id = :i",
        soci::use(key), soci::into(text);
    if (!session.got_data()) return std::nullopt;
    return database::from_bytes(database, std::move(text));
  });
}

Result<std::optional<std::string>> find_expert_attempt(Repository& repository, const Attempt& attempt) {
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) -> std::optional<std::string> {
    const std::string seed = std::to_string(attempt.the_case.seed);
    std::string id;
    session << "SELECT a.id FROM attempts a JOIN people p ON p.id = a.person_id JOIN cases c ON c.id = a.case_id"
               " WHERE c.task = :t AND c.patient = :n AND c.seed = :s AND c.patient_hash = :h AND p.is_expert = 1"
               " AND a.score IS NOT NULL ORDER BY p.is_simulated, a.score DESC, a.sequence LIMIT 1",
        soci::use(attempt.the_case.task), soci::use(attempt.the_case.patient), soci::use(seed),
        soci::use(attempt.the_case.patient_hash), soci::into(id);
    return session.got_data() ? std::optional(id) : std::nullopt;
  });
}

Result<bool> delete_attempt(Repository& repository, std::string_view id) {
  const auto deleted =
      repository.database().transaction("the attempt cannot be deleted", [&](soci::session& session) -> Status {
        const std::string key(id);
        soci::statement remove = (session.prepare << "DELETE FROM attempts WHERE id = :i", soci::use(key));
        remove.execute(true);
        if (remove.get_affected_rows() != 1) return fail_usage("no such attempt", key, "see trocar results list");
        note_deletion(session);
        return {};
      });
  TROCAR_TRY_STATUS(deleted);
  return erase_deleted(repository).value_or(false);
}

Result<std::vector<learning::PastAttempt>> past_attempts(Repository& repository, std::string_view person_id) {
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    const std::string person(person_id);
    std::map<long long, std::vector<Part>> parts;
    long long sequence = 0;
    Part part;
    soci::statement select =
        (session.prepare << "SELECT q.sequence, q.part, q.points, q.max_points FROM attempt_parts q"
                            " JOIN attempts a ON a.sequence = q.sequence WHERE a.person_id = :p",
         soci::use(person), soci::into(sequence), soci::into(part.name), soci::into(part.points),
         soci::into(part.max_points));
    select.execute();
    while (select.fetch()) parts[sequence].push_back(part);
    std::vector<learning::PastAttempt> past;
    for (const Attempt& attempt :
         read_attempts(session, {" WHERE a.person_id = :p", {person}, {}}, " ORDER BY a.sequence"))
      past.push_back(past_attempt_of(attempt, parts[attempt.sequence]));
    return past;
  });
}

using namespace detail;
Result<std::vector<TaskSummary>> summarise_tasks(Repository& repository, std::string_view person_id) {
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    const std::string person(person_id);
    std::vector<TaskSummary> summaries;
    TaskSummary one;
    long long attempts = 0, scored = 0, passed = 0, unscored = 0, never_began = 0, lost = 0, last_s = 0;
    Nullable<double> last, best, recent;
    // All from the index attempts_of_person: one pass for the sums, and the newest scores of each person at each task.
    const std::string newest = fmt::format(
        "(SELECT x.score FROM attempts x WHERE x.person_id = a.person_id AND x.task = a.task AND x.score IS NOT NULL"
        " ORDER BY x.sequence DESC LIMIT {})",
        kRecentAttempts);
    const std::string query = fmt::format(
        "SELECT a.person_id, a.task, count(*), count(a.score), sum(a.is_passed), sum(CASE WHEN a.state = 3 THEN 1 ELSE"
        " 0 END), sum(CASE WHEN a.state = 4 THEN 1 ELSE 0 END), sum(CASE WHEN a.state = 2 THEN 1 ELSE 0 END), (SELECT "
        "x.score FROM attempts x WHERE"
        " x.person_id = a.person_id AND x.task = a.task AND x.score IS NOT NULL ORDER BY x.sequence DESC LIMIT 1),"
        " max(a.score), (SELECT avg(score) FROM {} newest), max(a.started_s) FROM attempts a{}"
        " GROUP BY a.person_id, a.task ORDER BY a.person_id, a.task",
        newest, person.empty() ? "" : " WHERE a.person_id = :p");
    soci::statement select(session);
    select.exchange(soci::into(one.person_id));
    select.exchange(soci::into(one.task));
    select.exchange(soci::into(attempts));
    select.exchange(soci::into(scored));
    select.exchange(soci::into(passed));
    select.exchange(soci::into(unscored));
    select.exchange(soci::into(never_began));
    select.exchange(soci::into(lost));
    select.exchange(soci::into(last.value, last.indicator));
    select.exchange(soci::into(best.value, best.indicator));
    select.exchange(soci::into(recent.value, recent.indicator));
    select.exchange(soci::into(last_s));
    if (!person.empty()) select.exchange(soci::use(person));
    select.alloc();
    select.prepare(query);
    select.define_and_bind();
    select.execute();
    while (select.fetch()) {
      one.counts = {scored, passed, unscored, never_began, lost, attempts - scored - unscored - never_began - lost, 0};
      one.last_score = last.get();
      one.best_score = best.get();
      one.recent_mean = recent.get();
      one.last = Seconds(std::chrono::seconds(last_s));
      summaries.push_back(one);
    }
    return summaries;
  });
}

Result<std::vector<MetricSample>> metric_samples(Repository& repository, std::string_view task, std::string_view metric,
                                                 std::string_view course) {
  const bool is_score = metric == "score";
  std::string query = "SELECT a.person_id, p.is_expert, p.is_simulated, a.sequence, ";
  query += is_score ? "a.score FROM attempts a JOIN people p ON p.id = a.person_id WHERE a.state IN (1, 3)"
                    : "v.value FROM attempt_metrics v JOIN attempts a ON a.sequence = v.sequence JOIN people p ON"
                      " p.id = a.person_id WHERE v.metric_id = (SELECT id FROM metrics WHERE name = :m)"
                      " AND a.state IN (1, 3)";
  query += " AND a.task = :t";
  if (!course.empty()) query += " AND p.course_id = (SELECT id FROM courses WHERE name_key = :c)";
  query += " ORDER BY a.sequence";
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    const std::string task_name(task), metric_name(metric), course_key = name_key(course);
    std::vector<MetricSample> samples;
    MetricSample sample;
    Nullable<double> value;
    int is_expert = 0, is_simulated = 0;
    long long sequence = 0;
    soci::statement select(session);
    select.exchange(soci::into(sample.person_id));
    select.exchange(soci::into(is_expert));
    select.exchange(soci::into(is_simulated));
    select.exchange(soci::into(sequence));
    select.exchange(soci::into(value.value, value.indicator));
    if (!is_score) select.exchange(soci::use(metric_name));
    select.exchange(soci::use(task_name));
    if (!course.empty()) select.exchange(soci::use(course_key));
    select.alloc();
    select.prepare(query);
    select.define_and_bind();
    select.execute();
    while (select.fetch()) {
      sample.group = is_expert != 0 ? Group::kExpert : Group::kTrainee;
      sample.is_simulated = is_simulated != 0;
      sample.sequence = sequence;
      sample.value = value.get();
      samples.push_back(sample);
    }
    return samples;
  });
}

Result<std::vector<StoredMetric>> list_metrics(Repository& repository, std::string_view task) {
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    const std::string name(task);
    std::vector<StoredMetric> metrics;
    StoredMetric metric;
    // EXISTS stops at the first attempt of the task.
    soci::statement select =
        (session.prepare << "SELECT m.name, m.unit FROM metrics m WHERE EXISTS (SELECT 1 FROM attempt_metrics v JOIN"
                            " attempts a ON a.sequence = v.sequence WHERE v.metric_id = m.id AND a.task = :t)"
                            " ORDER BY m.name",
         soci::use(name), soci::into(metric.name), soci::into(metric.unit));
    select.execute();
    while (select.fetch()) metrics.push_back(metric);
    return metrics;
  });
}

Result<std::vector<ExpertMeasures>> expert_measures(Repository& repository, std::string_view task,
                                                    std::string_view without) {
  return repository.database().run(kCannotReadAttempts, [&](soci::session& session) {
    const std::string name(task), left_out(without);
    std::vector<ExpertMeasures> measures;
    std::string metric, person;
    double mean = 0.0;
    // Experts are few: their attempts are found first, then the values of these.
    soci::statement select =
        (session.prepare
             << "WITH experts AS (SELECT a.sequence, a.person_id, p.is_simulated FROM people p JOIN attempts"
                " a ON a.person_id = p.id WHERE p.is_expert = 1 AND a.task = :t AND a.state IN (1, 3) AND"
                " p.id <> :w) SELECT m.name, e.person_id, avg(v.value) FROM experts e JOIN attempt_metrics v"
                " ON v.sequence = e.sequence JOIN metrics m ON m.id = v.metric_id"
                " WHERE e.is_simulated = (SELECT min(is_simulated) FROM experts)"
                " GROUP BY m.name, e.person_id ORDER BY m.name, e.person_id",
         soci::use(name), soci::use(left_out), soci::into(metric), soci::into(person), soci::into(mean));
    select.execute();
    while (select.fetch()) {
      if (measures.empty() || measures.back().metric != metric) measures.push_back({metric, {}});
      measures.back().values.push_back(mean);
    }
    return measures;
  });
}

}  // namespace trocar::results
