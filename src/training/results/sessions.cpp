#include "results/sessions.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/text.h"
#include "learning/history.h"
#include "results/attempt.h"
#include "results/detail/attempt_writer.h"
#include "signing/token.h"
#include "storage/session_file.h"

namespace trocar::results::detail {

/// A session at kTraceRate_hz: place and depth at the end of each interval, and the force of the interval that is
/// farthest from zero, so that the peak of a puncture stays visible.
inline constexpr double kTraceRate_hz = 25.0;
Trace trace_of(const storage::Session& session);

}  // namespace trocar::results::detail

namespace trocar::results {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kIdDigits = 32;
/// A longer session file is recorded without its bytes.
constexpr std::uintmax_t kMostRecordingBytes = std::uintmax_t{256} << 20;

/// A session of an older program has no id: the same file has always the same one.
std::string id_of(const storage::SessionInfo& info, const std::string& ticks_hash) {
  if (!info.attempt_id.empty()) return info.attempt_id;
  return signing::sha256(fmt::format("{}\n{}\n{}\n{}\n{}\n{}", info.started_utc, info.task, info.patient_hash,
                                     info.operator_name, info.seed, ticks_hash))
      .substr(0, kIdDigits);
}

Case case_of(const storage::SessionInfo& info, const learning::Curriculum& curriculum) {
  Case the_case{info.task, info.patient_source, info.patient_seed, info.patient_hash, {}};
  // The path of a patient's folder says more than a database has to know.
  if (the_case.patient.find('/') != std::string::npos)
    the_case.patient = fs::path(the_case.patient).filename().string();
  if (the_case.patient.empty()) the_case.patient = info.patient_name;
  if (const learning::Course* course = curriculum.find(info.task))
    for (const learning::CourseCase& one : course->cases)
      if (one.patient == the_case.patient) the_case.difficulty = one.difficulty;
  return the_case;
}

/// A text of a file or of the system as every database can keep it.
std::string storable(std::string_view text) {
  std::string clean = valid_utf8(text);
  std::erase(clean, '\0');
  return clean;
}

void add_outcome(const scoring::Outcome& outcome, AttemptRecord& record) {
  record.not_scored = outcome.not_scored;
  record.fails = outcome.fails;
  if (record.attempt.state == State::kFinished) {
    record.attempt.score = outcome.score;
    record.attempt.is_passed = outcome.is_passed;
  }
  for (const scoring::Hint& hint : outcome.hints) record.hints.push_back({hint.text, hint.at_s});
  for (const scoring::ScorePart& part : outcome.parts)
    if (!scoring::is_deduction(part))
      record.parts.push_back({part.name, part.points, part.max_points, scoring::part_value_text(part)});
  for (const metrics::MetricValue& measure : outcome.measures)
    if (measure.value && std::isfinite(*measure.value))
      record.measures.push_back({measure.name, measure.unit, *measure.value});
}

Result<std::string> read_recording(const fs::path& file) {
  std::error_code error;
  if (fs::file_size(file, error) > kMostRecordingBytes) return std::string();
  const std::vector<fs::path> files = storage::session_files(file);
  const bool is_single =
      std::none_of(files.begin() + 1, files.end(), [&](const fs::path& beside) { return fs::exists(beside, error); });
  if (is_single) return read_file(file);
  // The newest ticks of a killed session are beside it, or what its last commit has to be undone with.
  const TemporaryFolder folder;
  const fs::path copy = folder / "copy.session";
  TROCAR_TRY_STATUS(storage::copy_session(file, copy));
  return read_file(copy);
}

Result<std::optional<State>> known_state(Repository& repository, const std::string& id) {
  TROCAR_TRY(const std::optional<Attempt> attempt, find_attempt(repository, id));
  return attempt ? std::optional(attempt->state) : std::nullopt;
}

/// Whether a session is still to be recorded: it names a person of this database and is not there as it is.
Result<bool> is_left(Repository& repository, const storage::SessionSummary& session) {
  const storage::SessionInfo& info = session.info;
  if (info.person_id.empty() || info.attempt_id.empty()) return false;
  TROCAR_TRY(const auto person, find_person(repository, info.person_id));
  if (!person) return false;
  TROCAR_TRY(const auto state, known_state(repository, info.attempt_id));
  return !state || *state == State::kRunning || (*state == State::kInterrupted && session.outcome.has_value());
}

}  // namespace

std::string station_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? storable(name.data()) : std::string();
}

Attempt begun_attempt(const storage::SessionInfo& info, const learning::Curriculum& curriculum) {
  Attempt attempt;
  attempt.id = info.attempt_id;
  attempt.person_id = info.person_id;
  attempt.the_case = case_of(info, curriculum);
  for (std::string* text : {&attempt.the_case.task, &attempt.the_case.patient, &attempt.the_case.patient_hash})
    *text = storable(*text);
  attempt.level = info.level;
  attempt.operator_name = storable(info.operator_name);
  attempt.station = station_name();
  attempt.program_version = storable(info.program_version);
  return attempt;
}

Result<AttemptRecord> attempt_of_session(const fs::path& file, const std::string& person_id,
                                         const learning::Curriculum& curriculum) {
  TROCAR_TRY(const storage::Session session, storage::load_session(file));
  AttemptRecord record;
  record.attempt = begun_attempt(session.info, curriculum);
  record.attempt.id = id_of(session.info, session.ticks_hash);
  if (!person_id.empty()) record.attempt.person_id = person_id;
  if (record.attempt.person_id.empty())
    return fail_usage("the session names no person", file.string(), "name one with --person");
  TROCAR_TRY(const learning::PastAttempt past, learning::attempt_of({session.info, session.outcome}));
  record.attempt.started = past.when;
  record.attempt.state = state_of(past.ending);
  if (!session.samples.empty())
    record.attempt.duration_s = session.samples.back().time_s - session.samples.front().time_s;
  if (session.outcome) add_outcome(*session.outcome, record);
  if (Status can = detail::check_storable(record); !can) {
    can.error().where = fmt::format("{}, {}", file.string(), can.error().where);
    return tl::unexpected(std::move(can).error());
  }
  record.trace = detail::trace_of(session);
  return record;
}

Result<std::optional<Attempt>> import_session(Repository& repository, const fs::path& file,
                                              const std::string& person_id, const learning::Curriculum& curriculum) {
  TROCAR_TRY(const AttemptRecord record, attempt_of_session(file, person_id, curriculum));
  TROCAR_TRY(const auto state, known_state(repository, record.attempt.id));
  if (state && has_ended(*state)) return std::optional<Attempt>();
  TROCAR_TRY(const std::string bytes, read_recording(file));
  TROCAR_TRY(const bool is_written, record_missing_attempt(repository, record, bytes));
  return is_written ? std::optional(record.attempt) : std::nullopt;
}

Result<Imported> import_left_sessions(Repository& repository, const fs::path& folder,
                                      const learning::Curriculum& curriculum) {
  TROCAR_TRY(const std::vector<fs::path> files, learning::find_sessions(folder));
  Imported imported;
  for (const fs::path& file : files) {
    const auto summary = storage::load_summary(file);
    if (!summary) {
      imported.damaged.push_back(summary.error().text());
      continue;
    }
    TROCAR_TRY(const bool is_missing, is_left(repository, *summary));
    if (!is_missing) {
      ++imported.present;
      continue;
    }
    const auto record = attempt_of_session(file, {}, curriculum);
    if (!record) {
      imported.damaged.push_back(record.error().text());
      continue;
    }
    TROCAR_TRY(const std::string bytes, read_recording(file));
    TROCAR_TRY(const bool is_written, record_missing_attempt(repository, *record, bytes));
    ++(is_written ? imported.added : imported.present);
  }
  return imported;
}

Status export_session(Repository& repository, std::string_view attempt_id, const fs::path& file) {
  TROCAR_TRY(const std::optional<Attempt> attempt, find_attempt(repository, attempt_id));
  if (!attempt) return fail_usage("no such attempt", std::string(attempt_id), "see trocar results list");
  TROCAR_TRY(const std::optional<std::string> bytes, load_recording(repository, attempt_id));
  if (!bytes) return fail("the recording of the attempt is not kept", std::string(attempt_id), "look on its station");
  std::error_code error;
  if (fs::exists(file, error)) return fail_usage("the file exists", file.string(), "name another file");
  return write_file_atomically(file, *bytes);
}

}  // namespace trocar::results

namespace trocar::results::detail {
namespace {

/// No attempt is that long; a damaged time must not fill the memory.
constexpr std::size_t kMostSamples = 200'000;

/// The force of the needle on the hand along its axis; negative pushes it out.
double force_n(const telemetry::TickSample& sample) {
  return -telemetry::axial_resistance_n(sample);
}

void append(Trace& trace, const telemetry::TickSample& sample, double extreme_n) {
  trace.time_s.push_back(sample.time_s);
  for (int axis = 0; axis < 3; ++axis) trace.tip_mm[static_cast<std::size_t>(axis)].push_back(sample.rest_tip_mm[axis]);
  trace.depth_mm.push_back(sample.depth_mm);
  trace.force_n.push_back(extreme_n);
  trace.tissue.push_back(sample.tissue);
}

void add_plan(const Segment& plan_P, Trace& trace) {
  for (int axis = 0; axis < 3; ++axis) {
    trace.plan_entry_mm[static_cast<std::size_t>(axis)] = plan_P.a[axis];
    trace.plan_target_mm[static_cast<std::size_t>(axis)] = plan_P.b[axis];
  }
}

}  // namespace

Trace trace_of(const storage::Session& session) {
  Trace trace;
  trace.rate_hz = kTraceRate_hz;
  trace.tissues = session.info.tissue_names;
  add_plan(session.info.plan_P.line_P, trace);
  double next_s = session.samples.empty() ? 0.0 : session.samples.front().time_s;
  double extreme_n = 0.0;
  for (const telemetry::TickSample& sample : session.samples) {
    if (trace.tissues.size() <= sample.tissue) trace.tissues.resize(sample.tissue + std::size_t{1});
    for (const telemetry::TickEvent& event : sample.events)  // limits of the device tell an instructor nothing
      if (event.kind == telemetry::EventKind::kPuncture || event.kind == telemetry::EventKind::kEnter)
        trace.events.push_back({sample.time_s, storage::event_text(session.info, event)});
    const double now_n = force_n(sample);
    if (std::abs(now_n) > std::abs(extreme_n)) extreme_n = now_n;
    if (!(sample.time_s >= next_s) || trace.time_s.size() >= kMostSamples) continue;
    append(trace, sample, extreme_n);
    extreme_n = 0.0;
    next_s += std::max(1.0, std::floor((sample.time_s - next_s) * kTraceRate_hz) + 1.0) / kTraceRate_hz;
  }
  return trace;
}

}  // namespace trocar::results::detail
