// The cohort table, and one person: results, attempts, learning curve, deletion.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/log.h"
#include "core/text.h"
#include "results/attempt.h"
#include "results/attempt_json.h"
#include "results/notes.h"
#include "results/proficiency.h"
#include "web/api/json_fields.h"
#include "web/api/route.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

using Summaries = std::map<std::string, std::vector<results::TaskSummary>>;  ///< By person.

Json summary_json(const results::TaskSummary& summary) {
  return {{"attempts", summary.counts.counted()},
          {"scored", summary.counts.scored},
          {"passed", summary.counts.passed},
          {"unscored", summary.counts.unscored},
          {"never_began", summary.counts.never_began},
          {"lost", summary.counts.lost},
          {"running", summary.counts.running},
          {"counts_text", learning::counts_text(summary.counts)},
          {"last_score", or_null(summary.last_score)},
          {"best_score", or_null(summary.best_score)},
          {"recent_mean", or_null(summary.recent_mean)},
          {"last_s", seconds_of(summary.last)}};
}

Json person_json(const results::Person& person, const std::vector<results::TaskSummary>& summaries) {
  Json tasks = Json::object();
  for (const results::TaskSummary& summary : summaries) tasks[summary.task] = summary_json(summary);
  return {{"id", person.id},
          {"name", person.name},
          {"group", results::to_string(person.group)},
          {"course", or_null(person.course)},
          {"simulated", person.is_simulated},
          {"has_pin", person.has_pin},
          {"tasks", std::move(tasks)}};
}

/// Known tasks with attempts, in the order of the data folder; then those of others.
Json tasks_json(const Titles& titles, std::set<std::string> practised) {
  Json tasks = Json::array();
  for (const Titles::Task& task : titles.tasks())
    if (practised.erase(task.id) > 0) tasks.push_back({{"id", task.id}, {"title", task.title}});
  for (const std::string& task : practised) tasks.push_back({{"id", task}, {"title", task}});
  return tasks;
}

Json courses_json(const std::vector<results::Course>& courses) {
  Json list = Json::array();
  for (const results::Course& one : courses) list.push_back({{"id", one.name}, {"name", one.name}});
  return list;
}

Result<Json> overview_json(results::Repository& repository, const Titles& titles, const std::string& course) {
  TROCAR_TRY(const std::vector<results::Person> people, results::list_people(repository));
  TROCAR_TRY(const std::vector<results::Course> courses, results::list_courses(repository));
  TROCAR_TRY(const std::vector<results::TaskSummary> summaries, results::summarise_tasks(repository));
  Summaries by_person;
  std::set<std::string> practised;
  for (const results::TaskSummary& summary : summaries) {
    by_person[summary.person_id].push_back(summary);
    practised.insert(summary.task);
  }
  Json json = {{"tasks", tasks_json(titles, practised)}, {"courses", courses_json(courses)}, {"people", Json::array()}};
  for (const results::Person& person : people)
    if (course.empty() || results::name_key(person.course) == results::name_key(course))
      json["people"].push_back(person_json(person, by_person[person.id]));
  return json;
}

Result<HttpAnswer> show_overview(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string course, query_course(call.request));
  return cached(backend.answers, backend.repositories, "overview\n" + course, call.now, "course",
                [=, &backend](results::Repository& repository) -> Result<std::optional<Json>> {
                  return overview_json(repository, backend.titles, course);
                });
}

/// The answer of `make(repository, person)` for the person of the path.
template <class Make>
Result<HttpAnswer> cached_of_person(Backend& backend, const Call& call, const std::string& key, const Make& make) {
  const std::string id = call.names[0];
  if (!is_id(id)) return not_found("person");
  return cached(backend.answers, backend.repositories, "person\n" + id + "\n" + key, call.now, "person",
                [=, &backend](results::Repository& repository) -> Result<std::optional<Json>> {
                  TROCAR_TRY(const std::optional<results::Person> person, results::find_person(repository, id));
                  if (!person) return std::optional<Json>();
                  TROCAR_TRY(Json json, make(repository, *person));
                  return std::optional<Json>(std::move(json));
                });
}

Result<HttpAnswer> show_person(Backend& backend, const Call& call) {
  return cached_of_person(
      backend, call, "", [=, &backend](results::Repository& repository, const results::Person& person) -> Result<Json> {
        TROCAR_TRY(const std::vector<results::TaskSummary> summaries, results::summarise_tasks(repository, person.id));
        TROCAR_TRY(const std::vector<results::Course> courses, results::list_courses(repository));
        std::set<std::string> practised;
        for (const results::TaskSummary& summary : summaries) practised.insert(summary.task);
        return Json{{"person", person_json(person, summaries)},
                    {"tasks", tasks_json(backend.titles, practised)},
                    {"courses", courses_json(courses)}};
      });
}

constexpr std::int64_t kUsualPage = 50, kLargestPage = 500;

/// A whole number of the query from 1. Error (exit status 2): something else.
Result<std::int64_t> query_number(const HttpRequest& request, const char* name, std::int64_t fallback) {
  const auto text = request.find_query(name);
  if (!text || text->empty()) return fallback;
  const auto number = parse_number<std::int64_t>(*text);
  if (!number || *number < 1) return fail_usage("not a whole number from 1 on", name, "leave it out");
  return *number;
}

/// Attempts of a person, newest first, with the reasons of those that did not pass and the number of notes.
Result<Json> attempt_list_json(results::Repository& repository, const std::string& person,
                               const std::vector<results::Attempt>& attempts) {
  Json list = Json::array();
  if (attempts.empty()) return list;
  TROCAR_TRY(const auto reasons,
             results::list_reasons(repository, person, attempts.back().sequence, attempts.front().sequence));
  TROCAR_TRY(const auto notes, results::count_notes(repository, person));
  for (const results::Attempt& attempt : attempts) {
    Json json = results::attempt_json(attempt);
    const auto reason = reasons.find(attempt.sequence);
    json["fails"] = reason == reasons.end() ? Json::array() : Json(reason->second.fails);
    json["not_scored"] = reason == reasons.end() ? Json(nullptr) : or_null(reason->second.not_scored);
    const auto noted = notes.find(attempt.sequence);
    json["notes"] = noted == notes.end() ? 0 : noted->second;
    list.push_back(std::move(json));
  }
  return list;
}

Result<HttpAnswer> list_attempts(Backend& backend, const Call& call) {
  results::AttemptFilter filter;
  filter.person_id = call.names[0];
  filter.is_newest_first = true;
  if (call.request.find_query("task").value_or("") != "") {
    TROCAR_TRY(filter.task, query_task(call.request));
  }
  TROCAR_TRY(const std::int64_t before, query_number(call.request, "before", 0));
  TROCAR_TRY(const std::int64_t limit, query_number(call.request, "limit", kUsualPage));
  if (before > 0) filter.before = before;
  const auto page = static_cast<std::size_t>(std::min(limit, kLargestPage));
  filter.limit = page + 1;  // one more tells if there is a next page
  return cached_of_person(
      backend, call, fmt::format("attempts\n{}\n{}\n{}", filter.task, before, page),
      [=, &backend](results::Repository& repository, const results::Person&) -> Result<Json> {
        TROCAR_TRY(std::vector<results::Attempt> attempts, results::list_attempts(repository, filter));
        const bool has_more = attempts.size() > page;
        if (has_more) attempts.pop_back();
        TROCAR_TRY(Json list, attempt_list_json(repository, filter.person_id, attempts));
        return Json{{"attempts", std::move(list)}, {"next", has_more ? Json(attempts.back().sequence) : Json(nullptr)}};
      });
}

Json curve_json(const results::LearningCurve& curve) {
  Json cusum = Json::array(), peers = Json::array();
  for (const results::CurveAttempt& point : curve.attempts) cusum.push_back(point.cusum);
  for (const auto& point : curve.peer_curve) peers.push_back(point ? Json(rounded(point->mean)) : Json(nullptr));
  const cohort::CusumRates rates = results::CurveRules().cusum;
  Json json = {{"points", results::curve_points_json(curve)},
               {"counts_text", learning::counts_text(curve.counts)},
               {"cusum",
                {{"values", std::move(cusum)},
                 {"upper", curve.cusum.upper},
                 {"lower", curve.cusum.lower},
                 {"acceptable", rates.acceptable},
                 {"unacceptable", rates.unacceptable}}},
               {"trend", or_null(curve.trend)},
               {"experts", nullptr},
               {"peers", {{"n", curve.peers}, {"mean_by_attempt", std::move(peers)}}}};
  if (curve.experts)
    json["experts"] = {{"n", curve.experts->people},
                       {"simulated", curve.experts->is_simulated},
                       {"mean", curve.experts->mean},
                       {"low", curve.experts->low},
                       {"high", curve.experts->high}};
  return json;
}

/// Empty: no such person.
Result<std::optional<Json>> load_curve(Backend& backend, const std::string& id, const std::string& task,
                                       const Moment& now) {
  TROCAR_TRY(const SampleCache::Value scores, samples_of(backend, task, "score", {}, now));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Person> person, results::find_person(*repository, id));
  if (!person) return std::optional<Json>();
  TROCAR_TRY(const results::LearningCurve curve, results::learning_curve_of(*repository, *person, task, *scores));
  return std::optional<Json>(curve_json(curve));
}

Result<HttpAnswer> show_curve(Backend& backend, const Call& call) {
  const std::string id = call.names[0];
  if (!is_id(id)) return not_found("person");
  TROCAR_TRY(const std::string task, query_task(call.request));
  return cached(backend.answers, "curve\n" + id + "\n" + task, call.now, "person",
                [&backend, id, task, now = call.now] { return load_curve(backend, id, task, now); });
}

Result<HttpAnswer> delete_person(Backend& backend, const Call& call) {
  const std::string& id = call.names[0];
  if (!is_id(id)) return not_found("person");
  TROCAR_TRY(const std::string confirmed, text_field(call.body, "confirm"));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Person> person, results::find_person(*repository, id));
  if (!person) return not_found("person");
  if (confirmed != person->name)
    return fail_usage("the name is not that of the person", "confirm", "type the name as it is shown");
  TROCAR_TRY(const results::PersonalData deleted, results::delete_person(*repository, id));
  forget_values(backend);
  log_warning("web: person deleted: {} with {} attempts by {} from {}", id, deleted.attempts,
              log_text(call.session().account.name), call.request.address);
  return empty_answer(204);
}

}  // namespace

std::vector<Route> people_routes() {
  return {
      {"GET", "/api/overview", Access::kInstructor, show_overview},
      {"GET", "/api/people/*", Access::kInstructor, show_person},
      {"DELETE", "/api/people/*", Access::kAdmin, delete_person, true, {"confirm"}},
      {"GET", "/api/people/*/attempts", Access::kInstructor, list_attempts},
      {"GET", "/api/people/*/curve", Access::kInstructor, show_curve},
  };
}

}  // namespace trocar::web
