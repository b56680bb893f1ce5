#include <fmt/format.h>

#include <map>

#include "results/attempts.h"
#include "results/detail/attempt_query.h"
#include "results/detail/rows.h"

namespace trocar::results {
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
