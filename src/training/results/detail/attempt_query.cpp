#include "results/detail/attempt_query.h"

#include <cstdlib>

namespace trocar::results::detail {
namespace {

constexpr const char* kSelectAttempts =
    "SELECT a.sequence, a.id, a.person_id, c.task, c.patient, c.seed, c.patient_hash, c.difficulty, a.level, "
    "a.operator,"
    " a.station, a.started_s, a.state, a.score, a.is_passed, a.duration_s, a.program_version"
    " FROM attempts a JOIN cases c ON c.id = a.case_id";

}  // namespace

void AttemptQuery::bind(soci::statement& statement) const {
  for (const std::string& text : texts) statement.exchange(soci::use(text));
  for (const long long& number : numbers) statement.exchange(soci::use(number));
}

AttemptQuery make_query(const AttemptFilter& filter) {
  AttemptQuery query{" WHERE 1 = 1", {}, {}};
  if (!filter.person_id.empty()) {
    query.condition += " AND a.person_id = :person";
    query.texts.push_back(filter.person_id);
  }
  if (!filter.task.empty()) {
    query.condition += " AND a.task = :task";
    query.texts.push_back(filter.task);
  }
  if (!filter.level.empty()) {
    query.condition += " AND a.level = :level";
    query.texts.push_back(filter.level);
  }
  if (!filter.patient.empty()) {
    query.condition += " AND a.case_id IN (SELECT q.id FROM cases q WHERE q.patient = :patient)";
    query.texts.push_back(filter.patient);
  }
  if (!filter.course.empty()) {
    query.condition +=
        " AND a.person_id IN (SELECT p.id FROM people p JOIN courses k ON k.id = p.course_id"
        " WHERE k.name_key = :course)";
    query.texts.push_back(name_key(filter.course));
  }
  if (filter.state) {
    query.condition += " AND a.state = :state";
    query.numbers.push_back(static_cast<long long>(*filter.state));
  }
  if (filter.before) {
    query.condition += " AND a.sequence < :before";
    query.numbers.push_back(*filter.before);
  }
  return query;
}

std::vector<Attempt> read_attempts(soci::session& session, const AttemptQuery& query, const std::string& order) {
  std::vector<Attempt> attempts;
  Attempt a;
  long long sequence = 0, started_s = 0;
  int difficulty = 0, state = 0, is_passed = 0;
  std::string seed;
  Nullable<double> score;
  soci::statement select(session);
  select.exchange(soci::into(sequence));
  select.exchange(soci::into(a.id));
  select.exchange(soci::into(a.person_id));
  select.exchange(soci::into(a.the_case.task));
  select.exchange(soci::into(a.the_case.patient));
  select.exchange(soci::into(seed));
  select.exchange(soci::into(a.the_case.patient_hash));
  select.exchange(soci::into(difficulty));
  select.exchange(soci::into(a.level));
  select.exchange(soci::into(a.operator_name));
  select.exchange(soci::into(a.station));
  select.exchange(soci::into(started_s));
  select.exchange(soci::into(state));
  select.exchange(soci::into(score.value, score.indicator));
  select.exchange(soci::into(is_passed));
  select.exchange(soci::into(a.duration_s));
  select.exchange(soci::into(a.program_version));
  query.bind(select);
  select.alloc();
  select.prepare(kSelectAttempts + query.condition + order);
  select.define_and_bind();
  select.execute();
  while (select.fetch()) {
    a.sequence = sequence;
    a.the_case.seed = std::strtoull(seed.c_str(), nullptr, 10);
    a.the_case.difficulty = difficulty > 0 ? std::optional(difficulty) : std::nullopt;
    a.started = Seconds(std::chrono::seconds(started_s));
    a.state = static_cast<State>(state);
    a.score = score.get();
    a.is_passed = is_passed != 0;
    attempts.push_back(a);
  }
  return attempts;
}

}  // namespace trocar::results::detail
