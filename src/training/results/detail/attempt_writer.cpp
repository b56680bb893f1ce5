#include "results/detail/attempt_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "database/statements.h"
#include "learning/history.h"
#include "results/detail/attempt_query.h"
#include "results/detail/csv_columns.h"
#include "results/detail/details_json.h"

namespace trocar::results::detail {
namespace {

constexpr int kNoDifficulty = 0;
constexpr std::size_t kMostIdDigits = 64;

double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

/// The attempt as it is stored. A finished attempt has a score: programs and files that know no other state mean those
/// without, too.
Attempt settled(const AttemptRecord& record) {
  Attempt attempt = record.attempt;
  attempt.duration_s = finite_or_zero(attempt.duration_s);
  if (attempt.state == State::kFinished && attempt.score && std::isfinite(*attempt.score)) return attempt;
  const bool was_outside = std::ranges::any_of(record.measures, [](const Measure& measure) {
    return measure.name == learning::kInBodyMetric && measure.value <= 0.0;
  });
  if (attempt.state == State::kFinished) attempt.state = was_outside ? State::kNeverBegan : State::kUnscored;
  attempt.score.reset();
  attempt.is_passed = false;
  return attempt;
}

Status check_text(std::string_view text, const char* column) {
  if (text.find('\0') != std::string_view::npos) return fail("the text has a NUL byte", column, "remove it");
  if (valid_utf8(text) != text) return fail("the text is not UTF-8", column, "write it as UTF-8");
  return {};
}

/// How much is known of an attempt.
int knowledge_of(State state) {
  return state == State::kRunning ? 0 : state == State::kInterrupted ? 1 : 2;
}

}  // namespace

Status check_storable(const Attempt& attempt) {
  const bool is_id = !attempt.id.empty() && attempt.id.size() <= kMostIdDigits &&
                     attempt.id.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (!is_id) return fail("the attempt has no valid key", "attempt", "record it again");
  if (attempt.the_case.task.empty()) return fail("the task is empty", "task", "name the task");
  if (!attempt.level.empty() && !learning::find_training_mode(attempt.level))
    return fail("the level is unknown", "level", "use guided, assisted or exam, or leave it empty");
  const std::pair<const char*, const std::string&> texts[]{{"task", attempt.the_case.task},
                                                           {"patient", attempt.the_case.patient},
                                                           {"hash", attempt.the_case.patient_hash},
                                                           {"operator", attempt.operator_name},
                                                           {"station", attempt.station},
                                                           {"version", attempt.program_version}};
  for (const auto& [column, text] : texts) TROCAR_TRY_STATUS(check_text(text, column));
  return {};
}

Status check_storable(const AttemptRecord& record) {
  TROCAR_TRY_STATUS(check_storable(record.attempt));
  for (const Part& part : record.parts) {
    TROCAR_TRY_STATUS(check_text(part.name, "part"));
    TROCAR_TRY_STATUS(check_text(part.value, "part"));
    if (!is_column_of(kPartColumn, part.name) || part.name.ends_with(kOfMost))
      return fail("a part of the score has no usable name", part.name, "record the attempt again");
  }
  for (const Measure& measure : record.measures) {
    TROCAR_TRY_STATUS(check_text(measure.name, "metric"));
    TROCAR_TRY_STATUS(check_text(measure.unit, "metric"));
    if (!is_column_of(kMetricColumn, measure.name) || measure.unit.find(kBeforeUnit) != std::string::npos)
      return fail("a metric has no usable name or unit", measure.name, "record the attempt again");
  }
  return {};
}

AttemptWriter::AttemptWriter(soci::session& session, const database::Database& database)
    : session_(session),
      database_(database),
      add_(session,
           "INSERT INTO attempts (id, person_id, case_id, task, level, operator, station, started_s, state, score,"
           " is_passed, duration_s, program_version) VALUES (:id, :person, :case, :task, :level, :operator, :station,"
           " :started, :state, :score, :passed, :duration, :version) ON CONFLICT (id) DO NOTHING"),
      add_details_(session, "INSERT INTO attempt_details (sequence, verdict, trace) VALUES (:s, :v, :t)"),
      add_part_(session,
                "INSERT INTO attempt_parts (sequence, part, points, max_points, value)"
                " VALUES (:s, :n, :p, :m, :v)"),
      add_metric_(session, "INSERT INTO attempt_metrics (metric_id, sequence, value) VALUES (:m, :s, :v)") {}

long long AttemptWriter::case_key(const Case& the_case) {
  const std::string seed = std::to_string(the_case.seed);
  std::string name;  // lengths keep texts with line breaks apart
  for (const std::string& part : {the_case.task, the_case.patient, seed, the_case.patient_hash})
    name += fmt::format("{}:{}", part.size(), part);
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

bool AttemptWriter::is_person(const std::string& id) {
  if (people_.contains(id)) return true;
  if (!find_person(session_, id)) return false;
  people_.insert(id);
  return true;
}

Result<AttemptWriter::Row> AttemptWriter::add_or_lock(const Attempt& attempt) {
  if (!is_person(attempt.person_id)) return tl::unexpected(no_such_person(attempt.person_id).error());
  Row row;
  row.is_new =
      add_.execute(attempt.id, attempt.person_id, case_key(attempt.the_case), attempt.the_case.task, attempt.level,
                   attempt.operator_name, attempt.station, attempt.started.time_since_epoch().count(),
                   static_cast<int>(attempt.state), Bound<double>(attempt.score), attempt.is_passed ? 1 : 0,
                   attempt.duration_s, attempt.program_version) == 1;
  if (!find_.statement) {
    // SQLite has one writer at a time anyway.
    const char* const lock = database_.is_sqlite() ? "" : " FOR UPDATE";
    find_.statement.emplace(
        (session_.prepare << fmt::format("SELECT sequence, state FROM attempts WHERE id = :i{}", lock),
         soci::use(find_.id), soci::into(find_.sequence), soci::into(find_.state)));
  }
  find_.id = attempt.id;
  find_.statement->execute(true);
  row.sequence = find_.sequence;
  row.state = static_cast<State>(find_.state);
  return row;
}

Status AttemptWriter::begin(const Attempt& attempt) {
  TROCAR_TRY_STATUS(check_storable(attempt));
  Attempt running = attempt;
  running.state = State::kRunning;
  running.score.reset();
  running.is_passed = false;
  running.duration_s = 0.0;
  TROCAR_TRY_STATUS(add_or_lock(running));
  return {};
}

void AttemptWriter::update_row(long long sequence, const Attempt& settled) {
  Bound<double> score(settled.score);
  const int state = static_cast<int>(settled.state), is_passed = settled.is_passed ? 1 : 0;
  session_ << "UPDATE attempts SET state = :state, score = :score, is_passed = :passed, duration_s = :duration"
              " WHERE sequence = :sequence",
      soci::use(state), soci::use(score.value, score.indicator), soci::use(is_passed), soci::use(settled.duration_s),
      soci::use(sequence);
}

void AttemptWriter::replace_texts(const Row& row, const AttemptRecord& record) {
  if (!row.is_new) session_ << "DELETE FROM attempt_details WHERE sequence = :s", soci::use(row.sequence);
  add_details_.execute(row.sequence, verdict_json(record), trace_json(record.trace));
}

void AttemptWriter::replace_values(const Row& row, const AttemptRecord& record) {
  for (const char* table : {"attempt_parts", "attempt_metrics"})
    if (!row.is_new) session_ << fmt::format("DELETE FROM {} WHERE sequence = :s", table), soci::use(row.sequence);
  for (const Part& part : record.parts)
    add_part_.execute(row.sequence, part.name, finite_or_zero(part.points), finite_or_zero(part.max_points),
                      part.value);
  for (const Measure& measure : record.measures)
    if (std::isfinite(measure.value)) add_metric_.execute(metric_key(measure), row.sequence, measure.value);
}

void AttemptWriter::replace_recording(const Row& row, std::string_view recording) {
  if (!row.is_new) session_ << "DELETE FROM recordings WHERE sequence = :s", soci::use(row.sequence);
  if (recording.empty()) return;
  const std::string bound = database::bind_bytes(database_, recording);
  session_ << "INSERT INTO recordings (sequence, bytes) VALUES (:s, " + database::bytes_in(database_, ":b") + ")",
      soci::use(row.sequence), soci::use(bound);
}

Result<AttemptWriter::Recorded> AttemptWriter::record(const AttemptRecord& record, std::string_view recording) {
  TROCAR_TRY_STATUS(check_storable(record));
  const Attempt attempt = settled(record);
  TROCAR_TRY(const Row row, add_or_lock(attempt));
  if (!row.is_new && has_ended(row.state)) return Recorded{row.sequence, false};
  if (!row.is_new) update_row(row.sequence, attempt);
  replace_texts(row, record);
  replace_values(row, record);
  replace_recording(row, recording);
  return Recorded{row.sequence, true};
}

Result<std::optional<State>> AttemptWriter::merge(const AttemptRecord& record) {
  TROCAR_TRY_STATUS(check_storable(record));
  const Attempt attempt = settled(record);
  TROCAR_TRY(const Row row, add_or_lock(attempt));
  if (!row.is_new && knowledge_of(attempt.state) <= knowledge_of(row.state)) return std::optional<State>();
  if (attempt.state == State::kRunning) return std::optional(State::kRunning);
  if (!row.is_new) update_row(row.sequence, attempt);
  replace_values(row, record);
  int details = 0;
  if (!row.is_new)
    session_ << "SELECT count(*) FROM attempt_details WHERE sequence = :s", soci::use(row.sequence),
        soci::into(details);
  if (details == 0) replace_texts(row, record);
  return std::optional(attempt.state);
}

}  // namespace trocar::results::detail
