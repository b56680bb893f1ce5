#include "results/detail/attempt_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/json.h"
#include "database/bytes.h"
#include "learning/history.h"
#include "results/detail/details_json.h"
#include "results/detail/people_table.h"
#include "results/detail/rows.h"

namespace trocar::results::detail {
namespace {

constexpr int kNoDifficulty = 0;

double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

/// A finished attempt has a score: programs and files that know no other state mean those without, too.
State settled_state(const AttemptRecord& record) {
  const Attempt& attempt = record.attempt;
  if (attempt.state != State::kFinished || (attempt.score && std::isfinite(*attempt.score))) return attempt.state;
  const bool was_outside = std::ranges::any_of(record.measures, [](const Measure& measure) {
    return measure.name == learning::kInBodyMetric && measure.value <= 0.0;
  });
  return was_outside ? State::kNeverBegan : State::kUnscored;
}

/// How much is known of an attempt.
int knowledge_of(State state) {
  return state == State::kRunning ? 0 : state == State::kInterrupted ? 1 : 2;
}

}  // namespace

long long AttemptWriter::case_key(const Case& the_case) {
  const std::string seed = std::to_string(the_case.seed);
  const std::string name = fmt::format("{}\n{}\n{}\n{}", the_case.task, the_case.patient, seed, the_case.patient_hash);
  if (const auto found = case_keys_.find(name); found != case_keys_.end()) return found->second;
  const int difficulty = the_case.difficulty.value_or(kNoDifficulty);
  session_ << "INSERT INTO cases (task, patient, seed, patient_hash, difficulty) VALUES (:t, :p, :s, :h, :d)"
              " ON CONFLICT (task, patient, seed, patient_hash) DO NOTHING",
      soci::use(the_case.task), soci::use(the_case.patient), soci::use(seed), soci::use(the_case.patient_hash),
      soci::use(difficulty);
  long long key = 0;
  session_ << "SELECT id FROM cases WHERE task = :t AND patient = :p AND seed = :s AND patient_hash = :h",
      soci::use(the_case.task), soci::use(the_case.patient), soci::use(seed), soci::use(the_case.patient_hash),
      soci::into(key);
  return case_keys_[name] = key;
}

long long AttemptWriter::metric_key(const Measure& measure) {
  if (const auto found = metric_keys_.find(measure.name); found != metric_keys_.end()) return found->second;
  session_ << "INSERT INTO metrics (name, unit) VALUES (:n, :u) ON CONFLICT (name) DO NOTHING", soci::use(measure.name),
      soci::use(measure.unit);
  long long key = 0;
  session_ << "SELECT id FROM metrics WHERE name = :n", soci::use(measure.name), soci::into(key);
  return metric_keys_[measure.name] = key;
}

AttemptWriter::Found AttemptWriter::find_for_update(const std::string& id) {
  Found found;
  int state = 0;
  // SQLite has one writer at a time anyway.
  session_ << fmt::format("SELECT sequence, state FROM attempts WHERE id = :i{}",
                          database_.is_sqlite() ? "" : " FOR UPDATE"),
      soci::use(id), soci::into(found.sequence), soci::into(state);
  found.state = static_cast<State>(state);
  return found;
}

Status AttemptWriter::begin(const Attempt& attempt) {
  if (!find_person(session_, attempt.person_id)) return no_such_person(attempt.person_id);
  const long long key = case_key(attempt.the_case), started_s = attempt.started.time_since_epoch().count();
  const int state = static_cast<int>(State::kRunning);
  session_ << "INSERT INTO attempts (id, person_id, case_id, task, level, operator, station, started_s, state,"
              " is_passed, duration_s, program_version) VALUES (:id, :person, :case, :task, :level, :operator,"
              " :station, :started, :state, 0, 0, :version) ON CONFLICT (id) DO NOTHING",
      soci::use(attempt.id), soci::use(attempt.person_id), soci::use(key), soci::use(attempt.the_case.task),
      soci::use(attempt.level), soci::use(attempt.operator_name), soci::use(attempt.station), soci::use(started_s),
      soci::use(state), soci::use(attempt.program_version);
  return {};
}

void AttemptWriter::update_row(long long sequence, const AttemptRecord& record) {
  const Attempt& attempt = record.attempt;
  const State settled = settled_state(record);
  const bool is_scored = settled == State::kFinished;
  Bound<double> score(is_scored ? attempt.score : std::nullopt);
  const int state = static_cast<int>(settled), is_passed = is_scored && attempt.is_passed ? 1 : 0;
  const double duration_s = finite_or_zero(attempt.duration_s);
  session_ << "UPDATE attempts SET state = :state, score = :score, is_passed = :passed, duration_s = :duration"
              " WHERE sequence = :sequence",
      soci::use(state), soci::use(score.value, score.indicator), soci::use(is_passed), soci::use(duration_s),
      soci::use(sequence);
}

void AttemptWriter::replace_texts(long long sequence, const AttemptRecord& record) {
  session_ << "DELETE FROM attempt_details WHERE sequence = :s", soci::use(sequence);
  const std::string verdict = verdict_json(record), trace = trace_json(record.trace);
  session_ << "INSERT INTO attempt_details (sequence, verdict, trace) VALUES (:s, :v, :t)", soci::use(sequence),
      soci::use(verdict), soci::use(trace);
}

void AttemptWriter::replace_values(long long sequence, const AttemptRecord& record) {
  for (const char* table : {"attempt_parts", "attempt_metrics"})
    session_ << fmt::format("DELETE FROM {} WHERE sequence = :s", table), soci::use(sequence);
  std::vector<long long> keys, sequences;
  std::vector<std::string> names, texts;
  std::vector<double> values, limits;
  for (const Part& part : record.parts) {
    names.push_back(part.name);
    values.push_back(finite_or_zero(part.points));
    limits.push_back(finite_or_zero(part.max_points));
    texts.push_back(part.value);
  }
  sequences.assign(names.size(), sequence);
  if (!names.empty())
    session_ << "INSERT INTO attempt_parts (sequence, part, points, max_points, value) VALUES (:s, :n, :p, :m, :v)",
        soci::use(sequences), soci::use(names), soci::use(values), soci::use(limits), soci::use(texts);

  values.clear();
  for (const Measure& measure : record.measures) {
    if (!std::isfinite(measure.value)) continue;
    keys.push_back(metric_key(measure));
    values.push_back(measure.value);
  }
  sequences.assign(keys.size(), sequence);
  if (!keys.empty())
    session_ << "INSERT INTO attempt_metrics (metric_id, sequence, value) VALUES (:m, :s, :v)", soci::use(keys),
        soci::use(sequences), soci::use(values);
}

void AttemptWriter::replace_recording(long long sequence, std::string_view recording) {
  session_ << "DELETE FROM recordings WHERE sequence = :s", soci::use(sequence);
  if (recording.empty()) return;
  const std::string bound = database::bind_bytes(database_, recording);
  session_ << "INSERT INTO recordings (sequence, bytes) VALUES (:s, " + database::bytes_in(database_, ":b") + ")",
      soci::use(sequence), soci::use(bound);
}

Result<std::int64_t> AttemptWriter::record(const AttemptRecord& record, std::string_view recording) {
  TROCAR_TRY_STATUS(begin(record.attempt));
  const Found found = find_for_update(record.attempt.id);
  if (has_ended(found.state)) return found.sequence;
  update_row(found.sequence, record);
  replace_texts(found.sequence, record);
  replace_values(found.sequence, record);
  replace_recording(found.sequence, recording);
  return found.sequence;
}

Result<std::optional<State>> AttemptWriter::merge(const AttemptRecord& record) {
  const bool is_new = find_for_update(record.attempt.id).sequence == 0;
  TROCAR_TRY_STATUS(begin(record.attempt));
  const Found found = find_for_update(record.attempt.id);
  if (!is_new && knowledge_of(record.attempt.state) <= knowledge_of(found.state)) return std::optional<State>();
  if (record.attempt.state == State::kRunning) return std::optional(State::kRunning);
  update_row(found.sequence, record);
  replace_values(found.sequence, record);
  int details = 0;
  session_ << "SELECT count(*) FROM attempt_details WHERE sequence = :s", soci::use(found.sequence),
      soci::into(details);
  if (details == 0) replace_texts(found.sequence, record);
  return std::optional(settled_state(record));
}

}  // namespace trocar::results::detail
