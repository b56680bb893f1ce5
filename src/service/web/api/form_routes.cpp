// Questionnaires: the instructor's forms and their means, and the public page that is answered without a login.
#include <fmt/format.h>

#include "core/log.h"
#include "language/language.h"
#include "results/questionnaires.h"
#include "web/api/route.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

Json item_json(const results::Item& item) {
  return {
      {"id", item.id}, {"kind", results::to_string(item.kind)}, {"text", item.text}, {"is_required", item.is_required}};
}

Json items_json(const std::vector<results::Item>& items) {
  Json list = Json::array();
  for (const results::Item& item : items) list.push_back(item_json(item));
  return list;
}

Json form_json(const results::Form& form) {
  return {{"id", form.id},
          {"token", form.token},
          {"title", form.title},
          {"intro", form.intro},
          {"is_open", form.is_open},
          {"language", nullptr},
          {"responses", form.responses},
          {"changed_s", seconds_of(form.changed)},
          {"items", items_json(form.items)}};
}

Result<results::Item> read_item(const Json& json) {
  results::Item item;
  TROCAR_TRY_STATUS(check_fields(json, std::array<std::string_view, 4>{"id", "kind", "text", "is_required"}));
  TROCAR_TRY(item.id, text_field_or_empty(json, "id"));
  TROCAR_TRY(item.text, text_field(json, "text"));
  TROCAR_TRY(const std::string kind_name, text_field(json, "kind"));
  const auto kind = results::find_item_kind(kind_name);
  if (!kind) return fail_usage("there is no such kind of item", "kind", "choose scale or text");
  item.kind = *kind;
  const auto required = json.find("is_required");
  if (required != json.end() && !required->is_boolean())
    return fail_usage("a field is not true or false", "is_required", "send true or false");
  item.is_required = required != json.end() && required->get<bool>();
  return item;
}

/// The form with the fields that the body has.
Result<results::Form> read_form(const Json& body, results::Form form) {
  if (body.contains("title")) {
    TROCAR_TRY(form.title, text_field(body, "title"));
  }
  if (body.contains("intro")) {
    TROCAR_TRY(form.intro, text_field_or_empty(body, "intro", 4 * results::kMaxIntroCharacters));
  }
  if (const auto open = body.find("is_open"); open != body.end()) {
    if (!open->is_boolean()) return fail_usage("a field is not true or false", "is_open", "send true or false");
    form.is_open = open->get<bool>();
  }
  const auto items = body.find("items");
  if (items == body.end()) return form;
  if (!items->is_array() || items->size() > results::kMaxItems)
    return fail_usage(fmt::format("not a list of at most {} items", results::kMaxItems), "items", "shorten it");
  form.items.clear();
  for (const Json& json : *items) {
    TROCAR_TRY(results::Item item, read_item(json));
    form.items.push_back(std::move(item));
  }
  return form;
}

Result<HttpAnswer> list_forms(Backend& backend, const Call&) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::vector<results::Form> forms, results::list_forms(*repository));
  Json list = Json::array();
  for (const results::Form& form : forms) list.push_back(form_json(form));
  return ok({{"forms", std::move(list)}});
}

/// The standard form, in the language that the body names.
Result<results::Form> standard_form(const Json& body) {
  results::Form form = results::default_form();
  form.is_open = true;
  if (!body.contains("language")) return form;
  TROCAR_TRY(const std::string code, text_field(body, "language"));
  TROCAR_TRY(const language::Language language, language::load_language(code));
  form.title = language.translate(form.title);
  form.intro = language.translate(form.intro);
  for (results::Item& item : form.items) item.text = language.translate(item.text);
  return form;
}

Result<HttpAnswer> add_form(Backend& backend, const Call& call) {
  TROCAR_TRY(results::Form fresh, standard_form(call.body));
  TROCAR_TRY(const results::Form form, read_form(call.body, std::move(fresh)));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const results::Form added, results::add_form(*repository, form, call.now.utc));
  log_info("web: form added by {} from {}", log_text(call.session().account.name), call.request.address);
  return ok(form_json(added), 201);
}

Result<HttpAnswer> change_form(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Form> present, results::find_form(*repository, call.names[0]));
  if (!present) return not_found("form");
  TROCAR_TRY(const results::Form form, read_form(call.body, *present));
  TROCAR_TRY(const results::Form changed, results::change_form(*repository, form, call.now.utc));
  backend.answers.clear();
  return ok(form_json(changed));
}

Result<HttpAnswer> delete_form(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Form> present, results::find_form(*repository, call.names[0]));
  if (!present) return not_found("form");
  TROCAR_TRY_STATUS(results::delete_form(*repository, present->id));
  backend.answers.clear();
  log_warning("web: form deleted with {} responses by {} from {}", present->responses,
              log_text(call.session().account.name), call.request.address);
  return empty_answer(204);
}

Json summary_json(const results::ItemSummary& summary) {
  Json json = item_json(summary.item);
  json["is_retired"] = summary.is_retired;
  json["n"] = summary.n;
  if (summary.item.kind == results::ItemKind::kScale) {
    json["mean"] = or_null(summary.mean);
    json["sd"] = or_null(summary.sd);
    json["counts"] = summary.counts;
    return json;
  }
  json["comments"] = Json::array();
  for (const results::Comment& comment : summary.comments)
    json["comments"].push_back({{"text", comment.text}, {"submitted_s", seconds_of(comment.submitted)}});
  return json;
}

Result<HttpAnswer> show_summary(Backend& backend, const Call& call) {
  const std::string id = call.names[0];
  return cached(
      backend.answers, backend.repositories, "form\n" + id, call.now, "form",
      [=, &backend](results::Repository& repository) -> Result<std::optional<Json>> {
        TROCAR_TRY(const std::optional<results::FormSummary> summary, results::summarise_form(repository, id));
        if (!summary) return std::optional<Json>();
        Json items = Json::array();
        for (const results::ItemSummary& item : summary->items) items.push_back(summary_json(item));
        return std::optional<Json>(
            {{"form", form_json(summary->form)}, {"responses", summary->form.responses}, {"items", std::move(items)}});
      });
}

Result<HttpAnswer> send_answers_csv(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Form> form, results::find_form(*repository, call.names[0]));
  if (!form) return not_found("form");
  TROCAR_TRY(std::string csv, results::answers_csv(*repository, form->id));
  HttpAnswer answer = text_answer(200, "text/csv; charset=utf-8", std::move(csv));
  answer.headers = {{"Content-Disposition", "attachment; filename=\"answers.csv\""}};
  return answer;
}

Result<HttpAnswer> show_public_form(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Form> form, results::find_open_form(*repository, call.names[0]));
  if (!form) return not_found("questionnaire");
  return ok(
      {{"title", form->title}, {"intro", form->intro}, {"language", nullptr}, {"items", items_json(form->items)}});
}

using Answers = std::map<std::string, results::Answer, std::less<>>;

Result<Answers> read_answers(const Json& body) {
  const auto given = body.find("answers");
  if (given == body.end() || !given->is_object()) return fail_usage("the answers are missing", "answers", "send them");
  if (given->size() > results::kMaxItems)
    return fail_usage("there are more answers than items", "answers", "reload the page");
  Answers answers;
  for (const auto& [item, value] : given->items()) {
    if (value.is_null()) continue;
    if (value.is_number_integer()) {
      const auto points = value.get<std::int64_t>();
      const bool is_point = points >= 1 && points <= results::kScalePoints;
      if (!is_point) return fail_usage("an answer is not a point of the scale", item, "choose 1 to 6");
      answers[item].points = static_cast<int>(points);
    } else {
      constexpr std::size_t kMostBytes = 4 * results::kMaxAnswerCharacters;
      if (!value.is_string() || value.get_ref<const std::string&>().size() > kMostBytes)
        return fail_usage("an answer is neither a point of the scale nor a text of allowed length", item, "shorten it");
      const auto& text = value.get_ref<const std::string&>();
      if (!text.empty()) answers[item].text = text;
    }
  }
  return answers;
}

Result<HttpAnswer> add_answers(Backend& backend, const Call& call) {
  if (const auto wait = backend.public_answers.try_take(call.request.client, call.now.steady)) {
    HttpAnswer answer = error_answer(429, "too many answers came from this address",
                                     fmt::format("wait {} s, then send it again", wait->count()));
    answer.headers = {{"Retry-After", std::to_string(wait->count())}};
    return answer;
  }
  const std::string& token = call.names[0];
  TROCAR_TRY(const Answers answers, read_answers(call.body));
  TROCAR_TRY(std::string response, text_field_or_empty(call.body, "response_id"));
  if (!response.empty() && !is_id(response))
    return fail_usage("not the id of a response", "response_id", "leave it out");
  if (response.empty()) response = results::make_id();
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Form> form, results::find_open_form(*repository, token));
  if (!form) return not_found("questionnaire");
  TROCAR_TRY_STATUS(results::add_response(*repository, token, response, answers, {}, call.now.utc));
  return ok(Json::object(), 201);
}

}  // namespace

std::vector<Route> form_routes() {
  const std::vector<std::string_view> of_form{"title", "intro", "is_open", "items"};
  const std::vector<std::string_view> of_new_form{"title", "intro", "is_open", "items", "language"};
  return {
      {"GET", "/api/forms", Access::kInstructor, list_forms},
      {"POST", "/api/forms", Access::kInstructor, add_form, true, of_new_form},
      {"PUT", "/api/forms/*", Access::kInstructor, change_form, true, of_form},
      {"DELETE", "/api/forms/*", Access::kInstructor, delete_form},
      {"GET", "/api/forms/*/summary", Access::kInstructor, show_summary},
      {"GET", "/api/forms/*/answers.csv", Access::kInstructor, send_answers_csv},
      {"GET", "/api/public/forms/*", Access::kPublic, show_public_form},
      {"POST", "/api/public/forms/*/answers", Access::kPublic, add_answers, false, {"answers", "response_id"}},
  };
}

}  // namespace trocar::web
