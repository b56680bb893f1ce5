#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "cohort/learning_curve.h"
#include "core/log.h"
#include "results/attempt_json.h"
#include "results/attempts_csv.h"
#include "results/notes.h"
#include "scoring/score.h"
#include "web/api/json_fields.h"
#include "web/api/route.h"
#include "web/security/request_guards.h"

// One attempt: verdict, values beside those of experts, trace, recording; and the export of all.

namespace trocar::web {
namespace {

/// {"path_length": [q1, median, q3]} over the means of the experts at a task without this person: of real ones, of
/// simulated ones if there are no others.
Result<Json> expert_quartiles(results::Repository& repository, const std::string& task, const std::string& without) {
  TROCAR_TRY(const std::vector<results::ExpertMeasures> measures, results::expert_measures(repository, task, without));
  Json json = Json::object();
  for (const results::ExpertMeasures& one : measures)
    if (const auto quartiles = cohort::quartiles_of(one.values))
      json[one.metric] = {quartiles->q1, quartiles->median, quartiles->q3};
  return json;
}

/// `person`: whose attempt is compared with them.
Result<Json> experts_of(Backend& backend, const std::string& task, const results::Person& person, const Moment& now) {
  // Trainees share one answer.
  const std::string without = person.group == results::Group::kExpert ? person.id : std::string();
  TROCAR_TRY(const AnswerCache::Value text,
             backend.statistics.get("experts\n" + task + "\n" + without, now.steady,
                                    [&backend, task, without]() -> Result<AnswerCache::Value> {
                                      const auto repository = backend.repositories.borrow();
                                      TROCAR_TRY(const Json json, expert_quartiles(*repository, task, without));
                                      return std::make_shared<const std::string>(config::json_text(json, -1));
                                    }));
  return config::parse_json(*text, "experts");
}

Json parts_json(const std::vector<results::Part>& parts) {
  Json list = Json::array();
  for (const results::Part& part : parts) {
    const std::string_view title = scoring::part_title(part.name);
    list.push_back({{"name", part.name},
                    {"title", title.empty() ? std::string_view(part.name) : title},
                    {"value_text", part.value.empty() ? Json(nullptr) : Json(part.value)},
                    {"points", rounded(part.points)},
                    {"max_points", rounded(part.max_points)}});
  }
  return list;
}

Json metrics_json(std::vector<results::Measure> measures, const Titles& titles, const Json& experts) {
  std::stable_sort(measures.begin(), measures.end(),
                   [&](const auto& a, const auto& b) { return titles.order_of(a.name) < titles.order_of(b.name); });
  Json list = Json::array();
  for (const results::Measure& measure : measures) {
    const Titles::Metric metric = titles.metric(measure.name, measure.unit);
    const auto expert = experts.find(measure.name);
    const auto quartile = [&](std::size_t n) { return expert == experts.end() ? Json(nullptr) : expert->at(n); };
    list.push_back({{"name", metric.name},
                    {"title", metric.title},
                    {"unit", measure.unit},
                    {"value", measure.value},
                    {"expert_median", quartile(1)},
                    {"expert_q1", quartile(0)},
                    {"expert_q3", quartile(2)},
                    {"better", to_string(metric.better)}});
  }
  return list;
}

struct RecordOfPerson {
  results::AttemptRecord record;
  results::Person person;
  std::vector<results::Note> notes;
};
/// Empty: no such attempt.
Result<std::optional<RecordOfPerson>> load_record(RepositoryPool& repositories, const std::string& id) {
  const auto repository = repositories.borrow();
  TROCAR_TRY(const std::optional<results::AttemptRecord> record, results::load_attempt(*repository, id));
  if (!record) return std::optional<RecordOfPerson>();
  TROCAR_TRY(const auto person, results::find_person(*repository, record->attempt.person_id));
  if (!person) return std::optional<RecordOfPerson>();
  TROCAR_TRY(std::vector<results::Note> notes, results::list_notes(*repository, id));
  return std::optional<RecordOfPerson>({*record, *person, std::move(notes)});
}

Result<std::optional<Json>> load_json_of(Backend& backend, const std::string& id, const Moment& now) {
  TROCAR_TRY(const std::optional<RecordOfPerson> loaded, load_record(backend.repositories, id));
  if (!loaded) return std::optional<Json>();
  const results::AttemptRecord* const record = &loaded->record;
  const results::Person* const person = &loaded->person;
  TROCAR_TRY(const Json experts, experts_of(backend, record->attempt.the_case.task, *person, now));
  Json attempt = results::attempt_json(record->attempt);
  attempt["task_title"] = backend.titles.task_title(record->attempt.the_case.task);
  attempt["person"] = {{"id", person->id}, {"name", person->name}, {"simulated", person->is_simulated}};
  attempt["not_scored"] = or_null(record->not_scored);
  attempt["fails"] = record->fails;
  attempt["hints"] = Json::array();
  for (const results::Hint& hint : record->hints)
    attempt["hints"].push_back({{"text", hint.text}, {"at_s", or_null(hint.at_s)}});
  Json notes = Json::array();
  for (const results::Note& note : loaded->notes) notes.push_back(note_json(note));
  return std::optional<Json>({{"attempt", std::move(attempt)},
                              {"notes", std::move(notes)},
                              {"parts", parts_json(record->parts)},
                              {"metrics", metrics_json(record->measures, backend.titles, experts)}});
}

Result<HttpAnswer> show_attempt(Backend& backend, const Call& call) {
  const std::string id = call.names[0];
  const Moment now = call.now;
  if (!is_id(id)) return not_found("attempt");
  return cached(backend.answers, "attempt\n" + id, now, "attempt",
                [&backend, id, now] { return load_json_of(backend, id, now); });
}

Result<std::optional<Json>> load_trace(results::Repository& repository, const std::string& id) {
  TROCAR_TRY(const std::optional<results::AttemptRecord> record, results::load_attempt(repository, id));
  if (!record) return std::optional<Json>();
  Json json = trace_json(record->trace);
  json["expert"] = nullptr;
  TROCAR_TRY(const std::optional<std::string> expert, results::find_expert_attempt(repository, record->attempt));
  if (expert && *expert != id) {
    TROCAR_TRY(const std::optional<results::AttemptRecord> best, results::load_attempt(repository, *expert));
    if (best && !best->trace.time_s.empty()) json["expert"] = trace_json(best->trace);
  }
  return std::optional<Json>(std::move(json));
}

Result<HttpAnswer> show_trace(Backend& backend, const Call& call) {
  const std::string id = call.names[0];
  if (!is_id(id)) return not_found("attempt");
  return cached(backend.answers, backend.repositories, "trace\n" + id, call.now, "attempt",
                [=, &backend](results::Repository& repository) { return load_trace(repository, id); });
}

HttpAnswer attachment(std::string content_type, std::string bytes, const std::string& file_name) {
  HttpAnswer answer = text_answer(200, std::move(content_type), std::move(bytes));
  answer.headers = {{"Content-Disposition", fmt::format("attachment; filename=\"{}\"", file_name)}};
  return answer;
}

Result<HttpAnswer> send_recording(Backend& backend, const Call& call) {
  const std::string& id = call.names[0];
  if (!is_id(id)) return not_found("attempt");
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(std::optional<std::string> bytes, results::load_recording(*repository, id));
  if (!bytes) return not_found("recording");
  return attachment("application/octet-stream", std::move(*bytes), id + ".session");
}

Result<HttpAnswer> send_csv(Backend& backend, const Call& call) {
  results::AttemptFilter filter;
  TROCAR_TRY(filter.course, query_course(call.request));
  if (call.request.find_query("task").value_or("") != "") {
    TROCAR_TRY(filter.task, query_task(call.request));
  }
  // A client may read slowly: a connection to the database is borrowed for each piece, and not while it is sent.
  std::shared_ptr<results::AttemptsExport> attempts;
  {
    const std::lock_guard turn(backend.exports);
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY(results::AttemptsExport begun, results::AttemptsExport::begin(*repository, filter));
    attempts = std::make_shared<results::AttemptsExport>(std::move(begun));
  }
  log_info("web: attempts exported by {} from {}", log_text(call.session().account.name), call.request.address);
  HttpAnswer answer = attachment("text/csv; charset=utf-8", {}, "attempts.csv");
  answer.body.reset();
  answer.source = [&backend, attempts]() -> Result<std::string> {
    const std::lock_guard turn(backend.exports);
    const auto repository = backend.repositories.borrow();
    return attempts->next(*repository);
  };
  return answer;
}

}  // namespace

std::vector<Route> attempt_routes() {
  return {
      {"GET", "/api/attempts/*", Access::kInstructor, show_attempt},
      {"GET", "/api/attempts/*/trace", Access::kInstructor, show_trace},
      {"GET", "/api/attempts/*/recording", Access::kInstructor, send_recording},
      {"GET", "/api/export/attempts.csv", Access::kInstructor, send_csv},
  };
}

}  // namespace trocar::web

// Notes of instructors to attempts, one by one and as a file.

namespace trocar::web {
namespace {

Result<HttpAnswer> add_attempt_note(Backend& backend, const Call& call) {
  const std::string& attempt = call.names[0];
  if (!is_id(attempt)) return not_found("attempt");
  TROCAR_TRY(const std::string text, text_field(call.body, "text", 4 * results::kMaxNoteCharacters));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const auto found, results::find_attempt(*repository, attempt));
  if (!found) return not_found("attempt");
  TROCAR_TRY(const results::Note note,
             results::add_note(*repository, attempt, call.session().account.name, text, call.now.utc));
  backend.answers.clear();
  return ok(note_json(note), 201);
}

/// Of its author, and of admins.
Result<HttpAnswer> delete_attempt_note(Backend& backend, const Call& call) {
  if (!is_id(call.names[0])) return not_found("note");
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Note> note, results::find_note(*repository, call.names[0]));
  if (!note) return not_found("note");
  const results::Account& account = call.session().account;
  if (account.role != results::Role::kAdmin && note->author != account.name)
    return error_answer(403, "the note is of another account", "ask its author or an admin");
  TROCAR_TRY_STATUS(results::delete_note(*repository, note->id));
  backend.answers.clear();
  log_warning("web: note deleted by {} from {}", log_text(account.name), call.request.address);
  return empty_answer(204);
}

Result<HttpAnswer> send_notes_csv(Backend& backend, const Call& call) {
  results::AttemptFilter filter;
  TROCAR_TRY(filter.course, query_course(call.request));
  if (call.request.find_query("task").value_or("") != "") {
    TROCAR_TRY(filter.task, query_task(call.request));
  }
  std::string csv;
  {
    const std::lock_guard turn(backend.exports);
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY(csv, results::notes_csv(*repository, filter));
  }
  log_info("web: notes exported by {} from {}", log_text(call.session().account.name), call.request.address);
  HttpAnswer answer = text_answer(200, "text/csv; charset=utf-8", std::move(csv));
  answer.headers = {{"Content-Disposition", "attachment; filename=\"notes.csv\""}};
  return answer;
}

}  // namespace

std::vector<Route> note_routes() {
  return {
      {"POST", "/api/attempts/*/notes", Access::kInstructor, add_attempt_note, true, {"text"}},
      {"DELETE", "/api/notes/*", Access::kInstructor, delete_attempt_note},
      {"GET", "/api/export/notes.csv", Access::kInstructor, send_notes_csv},
  };
}

}  // namespace trocar::web
