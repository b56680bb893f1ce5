// Notes of instructors to attempts, one by one and as a file.
#include "core/log.h"
#include "results/notes.h"
#include "web/api/attempt_json.h"
#include "web/api/route.h"
#include "web/security/log_text.h"

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
