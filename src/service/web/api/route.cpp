#include "web/api/route.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "results/names.h"

namespace trocar::web {
namespace {

std::vector<std::string_view> parts_of(std::string_view path) {
  std::vector<std::string_view> parts;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    parts.push_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return parts;
}

/// The decoded parts of `path` at the places of '*': an encoded slash is part of a name. Empty: the path has another
/// pattern.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view path) {
  const auto wanted = parts_of(pattern), given = parts_of(path);
  if (wanted.size() != given.size()) return std::nullopt;
  std::vector<std::string> names;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    std::optional<std::string> part = percent_decoded(given[n]);
    if (!part) return std::nullopt;
    if (wanted[n] == "*" && !part->empty()) {
      names.push_back(*std::move(part));
    } else if (wanted[n] != *part) {
      return std::nullopt;
    }
  }
  return names;
}

}  // namespace

std::vector<Route> all_routes() {
  std::vector<Route> routes = {
      {"GET", "/api/health", Access::kPublic, [](Backend&, const Call&) { return empty_answer(204); }}};
  for (auto group :
       {account_routes, people_routes, people_change_routes, metric_routes, attempt_routes, note_routes, form_routes})
    for (Route& route : group()) routes.push_back(std::move(route));
  return routes;
}

FoundRoute find_route(const std::vector<Route>& routes, std::string_view method, std::string_view path) {
  FoundRoute found;
  for (const Route& route : routes) {
    auto names = match(route.pattern, path);
    if (!names) continue;
    const bool is_meant = route.method == method || (route.method == "GET" && method == "HEAD");
    if (is_meant && !found.route) {
      found.route = &route;
      found.names = std::move(*names);
    }
    if (!found.allowed.empty()) found.allowed += ", ";
    found.allowed += route.method;
  }
  return found;
}

void forget_values(Backend& backend) {
  backend.samples.clear();
  backend.statistics.clear();
  backend.answers.clear();
}

HttpAnswer not_found(std::string_view what) {
  return error_answer(404, "there is no such " + std::string(what), "it may have been deleted: go back to the list");
}

HttpAnswer wait_answer(std::chrono::seconds wait, std::string_view error) {
  HttpAnswer answer = error_answer(429, error, fmt::format("wait {} s, then try again", wait.count()));
  answer.headers = {{"Retry-After", std::to_string(wait.count())}};
  return answer;
}

HttpAnswer busy_answer() {
  return wait_answer(std::chrono::seconds(1), "too many passwords are being checked at the moment");
}

HttpAnswer ok(const Json& json, int status) {
  return json_answer(status, config::json_text(json, -1));
}

Result<std::string> query_task(const HttpRequest& request) {
  constexpr std::size_t kMost = 100;
  const auto task = request.find_query("task");
  if (!task || task->empty()) return fail_usage("the task is missing", "task", "choose a task");
  const bool is_name = task->size() <= kMost && std::all_of(task->begin(), task->end(), [](char c) {
                         return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                                c == '-' || c == '_' || c == '.';
                       });
  if (!is_name) return fail_usage("not a name of a task", "task", "choose a task of the list");
  return std::string(*task);
}

Result<std::string> query_course(const HttpRequest& request) {
  const auto course = request.find_query("course");
  if (!course || course->empty()) return std::string();
  return results::clean_name(*course, "the name of a course");
}

Result<std::string> query_patient(const HttpRequest& request) {
  const auto patient = request.find_query("patient");
  if (!patient || patient->empty()) return std::string();
  return results::clean_name(*patient, "the name of a case");
}

Result<std::string> query_level(const HttpRequest& request) {
  const auto level = request.find_query("level");
  if (!level || level->empty()) return std::string();
  if (!learning::find_training_mode(*level))
    return fail_usage("not a level of help", "level", "choose guided, assisted or exam");
  return std::string(*level);
}

bool is_id(std::string_view text) noexcept {
  constexpr std::size_t kDigits = 32;
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<SampleCache::Value> samples_of(Backend& backend, const std::string& task, const std::string& metric,
                                      const std::string& course, const Moment& now) {
  return backend.samples.get(task + "\n" + metric + "\n" + course, now.steady,
                             [&backend, task, metric, course]() -> Result<SampleCache::Value> {
                               const auto repository = backend.repositories.borrow();
                               TROCAR_TRY(auto samples, results::metric_samples(*repository, task, metric, course));
                               return std::make_shared<const std::vector<results::MetricSample>>(std::move(samples));
                             });
}

Result<HttpAnswer> cached(AnswerCache& cache, const std::string& key, const Moment& now, std::string_view what,
                          const MakeJsonAlone& make) {
  TROCAR_TRY(const AnswerCache::Value value, cache.get(key, now.steady, [make]() -> Result<AnswerCache::Value> {
    TROCAR_TRY(const std::optional<Json> json, make());
    return std::make_shared<const std::string>(json ? config::json_text(*json, -1) : std::string());
  }));
  if (value->empty()) return not_found(what);
  HttpAnswer answer;
  answer.content_type = "application/json; charset=utf-8";
  answer.body = value;
  return answer;
}

Result<HttpAnswer> cached(AnswerCache& cache, RepositoryPool& repositories, const std::string& key, const Moment& now,
                          std::string_view what, const MakeJson& make) {
  return cached(cache, key, now, what, [&repositories, make]() -> Result<std::optional<Json>> {
    const RepositoryPool::Loan repository = repositories.borrow();
    return make(*repository);
  });
}

bool PasswordGate::enter() {
  std::unique_lock lock(mutex_);
  if (waiting_ >= kMostWaiting) return false;
  ++waiting_;
  has_left_.wait(lock, [this] { return inside_ < kMostInside; });
  --waiting_;
  ++inside_;
  return true;
}

void PasswordGate::leave() {
  {
    const std::lock_guard lock(mutex_);
    --inside_;
  }
  has_left_.notify_one();
}

}  // namespace trocar::web
