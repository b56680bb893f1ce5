// People, courses and PINs: added, renamed, moved. Names of people never reach the log.
#include "core/log.h"
#include "results/notes.h"
#include "web/api/route.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

constexpr std::size_t kMostMoved = 500;

void log_change(const Call& call, std::string_view what) {
  log_info("web: {} by {} from {}", what, log_text(call.session().account.name), call.request.address);
}

Result<results::Group> group_field(const Json& body) {
  TROCAR_TRY(const std::string name, text_field(body, "group"));
  const auto group = results::find_group(name);
  if (!group) return fail_usage("there is no such group", "group", "choose trainee or expert");
  return *group;
}

Json short_person_json(const results::Person& person) {
  return {{"id", person.id}, {"name", person.name}};
}

HttpAnswer name_taken() {
  return error_answer(409, "another person has this name", "choose another name");
}

/// Whether another person than `id` has the name.
Result<bool> has_other_person(results::Repository& repository, const std::string& name, std::string_view id) {
  TROCAR_TRY(const auto other, results::find_person_named(repository, name));
  return other && other->id != id;
}

Result<HttpAnswer> add_person(Backend& backend, const Call& call) {
  results::NewPerson person;
  TROCAR_TRY(person.name, text_field(call.body, "name"));
  TROCAR_TRY(person.group, group_field(call.body));
  TROCAR_TRY(person.course, text_field_or_empty(call.body, "course"));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const bool is_taken, has_other_person(*repository, person.name, {}));
  if (is_taken) return name_taken();
  TROCAR_TRY(const results::Person added, results::add_person(*repository, person, call.now.utc));
  forget_values(backend);
  log_change(call, "person " + added.id + " added");
  return ok(short_person_json(added), 201);
}

Result<HttpAnswer> change_person(Backend& backend, const Call& call) {
  const std::string& id = call.names[0];
  if (!is_id(id)) return not_found("person");
  results::PersonChange change;
  if (call.body.contains("name")) {
    TROCAR_TRY(change.name, text_field(call.body, "name"));
  }
  if (call.body.contains("group")) {
    TROCAR_TRY(change.group, group_field(call.body));
  }
  if (call.body.contains("course")) {
    TROCAR_TRY(change.course, text_field_or_empty(call.body, "course"));
  }
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Person> present, results::find_person(*repository, id));
  if (!present) return not_found("person");
  if (change.name) {
    TROCAR_TRY(const bool is_taken, has_other_person(*repository, *change.name, id));
    if (is_taken) return name_taken();
  }
  TROCAR_TRY_STATUS(results::change_person(*repository, id, change));
  forget_values(backend);
  log_change(call, "person " + id + " changed");
  TROCAR_TRY(const std::optional<results::Person> changed, results::find_person(*repository, id));
  return changed ? ok(short_person_json(*changed)) : not_found("person");
}

Result<HttpAnswer> move_people(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string course, text_field_or_empty(call.body, "course"));
  const auto given = call.body.find("people");
  if (given == call.body.end() || !given->is_array() || given->empty() || given->size() > kMostMoved)
    return fail_usage("not a list of 1 to 500 people", "people", "choose the people to move");
  std::vector<std::string> ids;
  for (const Json& id : *given) {
    if (!id.is_string() || !is_id(id.get_ref<const std::string&>()))
      return fail_usage("not the id of a person", "people", "reload the page");
    ids.push_back(id.get<std::string>());
  }
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::move_people(*repository, ids, course));
  forget_values(backend);
  log_change(call, std::to_string(ids.size()) + " people moved to another course");
  return empty_answer(204);
}

Result<HttpAnswer> set_pin(Backend& backend, const Call& call) {
  const std::string& id = call.names[0];
  if (!is_id(id)) return not_found("person");
  TROCAR_TRY(const std::string pin, text_field(call.body, "pin"));
  const PasswordGate::Pass pass(backend.passwords);
  if (!pass) return busy_answer();
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Person> person, results::find_person(*repository, id));
  if (!person) return not_found("person");
  TROCAR_TRY_STATUS(results::set_pin(*repository, id, pin));
  forget_values(backend);
  log_warning("web: PIN of person {} {} by {} from {}", id, pin.empty() ? "removed" : "set",
              log_text(call.session().account.name), call.request.address);
  return empty_answer(204);
}

Result<HttpAnswer> show_pin_rule(Backend& backend, const Call&) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const bool are_required, results::are_pins_required(*repository));
  return ok({{"required", are_required}});
}

Result<HttpAnswer> change_pin_rule(Backend& backend, const Call& call) {
  const auto required = call.body.find("required");
  if (required == call.body.end() || !required->is_boolean())
    return fail_usage("a field is not true or false", "required", "send true or false");
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::require_pins(*repository, required->get<bool>()));
  log_warning("web: PINs made {} by {} from {}", required->get<bool>() ? "required" : "optional",
              log_text(call.session().account.name), call.request.address);
  return ok({{"required", required->get<bool>()}});
}

Result<HttpAnswer> rename_course(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string name, text_field(call.body, "name"));
  TROCAR_TRY(const std::string new_name, text_field(call.body, "new_name"));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::rename_course(*repository, name, new_name));
  forget_values(backend);
  log_change(call, "course renamed");
  return empty_answer(204);
}

Result<HttpAnswer> remove_course(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string name, text_field(call.body, "name"));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::remove_empty_course(*repository, name));
  forget_values(backend);
  log_change(call, "empty course removed");
  return empty_answer(204);
}

}  // namespace

std::vector<Route> people_change_routes() {
  return {
      {"POST", "/api/people", Access::kInstructor, add_person, true, {"name", "group", "course"}},
      {"PUT", "/api/people/*", Access::kInstructor, change_person, true, {"name", "group", "course"}},
      {"PUT", "/api/people/*/pin", Access::kInstructor, set_pin, true, {"pin"}},
      {"POST", "/api/people/move", Access::kInstructor, move_people, true, {"people", "course"}},
      {"PUT", "/api/courses", Access::kInstructor, rename_course, true, {"name", "new_name"}},
      {"DELETE", "/api/courses", Access::kInstructor, remove_course, true, {"name"}},
      {"GET", "/api/pins", Access::kInstructor, show_pin_rule},
      {"PUT", "/api/pins", Access::kAdmin, change_pin_rule, true, {"required"}},
  };
}

}  // namespace trocar::web
