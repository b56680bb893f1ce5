#include "web/service.h"

#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "core/log.h"
#include "core/text.h"
#include "signing/password.h"
#include "signing/token.h"
#include "web/api/route.h"
#include "web/repository_pool.h"
#include "web/security/request_guards.h"
#include "web/static_files.h"
#include "web/transport/http_server.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;

/// Requests of one address to the interface: a room full of browsers behind one address. [assumed]
constexpr BucketRule kRequestRule{600, 100};
/// Filled-in questionnaires of one address: a course that answers at the same time. [assumed]
constexpr BucketRule kPublicRule{60, 0.2};
constexpr CacheRules kStatisticsRules{1min, 10min};
constexpr CacheRules kLoginRules{1s, 1s, false};
constexpr int kReferenceBits = 128;
constexpr std::size_t kReferenceCharacters = 8;

Moment system_now() {
  return {std::chrono::steady_clock::now(), std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now())};
}

std::size_t count_bytes(const std::vector<results::MetricSample>& samples) {
  constexpr std::size_t kTextBytes = 40;  // of an id
  return samples.size() * (sizeof(results::MetricSample) + kTextBytes);
}

bool is_reading(std::string_view method) {
  return method == "GET" || method == "HEAD";
}

bool is_json(const HttpRequest& request) {
  const auto type = request.find_header("content-type");
  if (!type) return false;
  std::string_view media = type->substr(0, type->find(';'));
  while (media.ends_with(' ')) media.remove_suffix(1);
  return is_same_name(media, "application/json");
}

/// `path`: that of the request, decoded; empty: malformed.
bool has_valid_text(const HttpRequest& request, const std::optional<std::string>& path) {
  const auto is_valid = [](std::string_view text) {
    return valid_utf8(text) == text && text.find('\0') == std::string_view::npos;
  };
  if (!path || !path->starts_with('/') || !is_valid(*path)) return false;
  for (const auto& [name, value] : request.query)
    if (!is_valid(name) || !is_valid(value)) return false;
  return true;
}

/// The error of the server in the log, and its number for the user.
HttpAnswer server_error(const HttpRequest& request, const Error& error) {
  const std::string reference = signing::make_token(kReferenceBits).value_or("-").substr(0, kReferenceCharacters);
  log(LogLevel::kError,
      fmt::format("web: error {}: {} {}: {}", reference, request.method, log_text(request.path), error.text()));
  return error_answer(500, "the server failed",
                      fmt::format("try again; the log of trocar serve has the reason under {}", reference));
}

}  // namespace

struct Service::State {
  State(ServiceOptions opened_with, std::unique_ptr<RepositoryPool> opened, Titles loaded, StaticFiles files,
        std::string unknown_hash)
      : options(std::move(opened_with)),
        repositories(std::move(opened)),
        titles(std::move(loaded)),
        page(std::move(files)),
        backend{*repositories,
                answers,
                samples,
                sessions,
                statistics,
                titles,
                logins,
                public_answers,
                passwords,
                exports,
                log_limit,
                options.password_work,
                std::move(unknown_hash),
                options.is_secure} {}

  HttpAnswer answer(HttpRequest request);
  HttpAnswer answer_api(const HttpRequest& request, const Moment& now);
  /// Forgets values that were read before a deletion by another program.
  Status see_deletions(const Moment& now);
  Result<HttpAnswer> answer_route(const Route& route, Call& call);
  Result<LoginCache::Value> load_login(const std::string& digest, const Moment& now);
  Result<std::optional<results::WebSession>> find_login(const HttpRequest& request, const Moment& now);

  ServiceOptions options;
  std::unique_ptr<RepositoryPool> repositories;
  Titles titles;
  StaticFiles page;
  LoginThrottle logins;
  TokenBuckets requests{kRequestRule}, public_answers{kPublicRule};
  PasswordGate passwords;
  std::mutex exports;
  LogLimit log_limit;
  DeletionWatch deletions;
  Backend backend;
  std::vector<Route> routes = all_routes();
  // Their threads use all of the above until they end. An answer may need a statistic, and that samples: they end in
  // the order in which they need each other, the last one first.
  SampleCache samples{count_bytes, kStatisticsRules};
  LoginCache sessions{[](const auto&) { return sizeof(results::WebSession); }, kLoginRules};
  AnswerCache statistics{kStatisticsRules}, answers;
};

Result<Service> Service::open(ServiceOptions options) {
  if (!options.now) options.now = system_now;
  TROCAR_TRY(StaticFiles page, StaticFiles::load(options.page_folder));
  TROCAR_TRY(Titles titles, Titles::load(options.data_folder));
  TROCAR_TRY(auto repositories, RepositoryPool::open(options.database, options.connections));
  TROCAR_TRY(const std::string nobody, signing::make_token(kReferenceBits));
  TROCAR_TRY(std::string unknown_hash, signing::hash_password(nobody, options.password_work));
  return Service(std::make_unique<State>(std::move(options), std::move(repositories), std::move(titles),
                                         std::move(page), std::move(unknown_hash)));
}

Service::Service(std::unique_ptr<State> state) : state_(std::move(state)) {}
Service::Service(Service&&) noexcept = default;
Service& Service::operator=(Service&&) noexcept = default;
Service::~Service() = default;

std::string Service::database_note() {
  const auto repository = state_->repositories->borrow();
  return (*repository).database().note();
}

Result<std::size_t> Service::count_accounts() {
  const auto repository = state_->repositories->borrow();
  TROCAR_TRY(const std::vector<results::Account> accounts, results::list_accounts(*repository));
  return accounts.size();
}

HttpAnswer Service::answer(const HttpRequest& request) {
  return state_->answer(request);
}

HttpAnswer Service::State::answer(HttpRequest request) {
  if (options.is_behind_proxy) request.address = forwarded_address(request).value_or(request.address);
  request.client = client_of(request.address);
  const std::optional<std::string> path = percent_decoded(request.path);
  if (!is_for_this_host(request, options.is_loopback, options.is_served))
    return error_answer(421, "this server has another name",
                        "use the address that trocar serve printed, or start it with --name");
  if (!has_valid_text(request, path)) return error_answer(400, "not an address of this server", "check the address");
  if (*path == "/api" || path->starts_with("/api/")) return answer_api(request, options.now());
  if (!is_reading(request.method)) {
    HttpAnswer refused = error_answer(405, "pages can only be read", "send GET");
    refused.headers = {{"Allow", "GET, HEAD"}};
    return refused;
  }
  request.path = *path;
  return page.answer(request);
}

HttpAnswer Service::State::answer_api(const HttpRequest& request, const Moment& now) {
  const ListenAddress client{request.address, 0};
  if (!client.is_loopback() || options.is_behind_proxy)
    if (const auto wait = requests.try_take(request.client, now.steady)) {
      HttpAnswer slow = error_answer(429, "too many requests came from this address", "wait a little, then try again");
      slow.headers = {{"Retry-After", std::to_string(wait->count())}};
      return slow;
    }
  if (is_from_another_site(request, options.is_secure ? "https" : "http"))
    return error_answer(403, "the request came from another site", "use the page of this server");
  FoundRoute found = find_route(routes, request.method, request.path);
  if (!found.route) {
    if (found.allowed.empty()) return error_answer(404, "there is no such address", "check the address");
    HttpAnswer refused = error_answer(405, "this address has no such method", "send " + found.allowed);
    refused.headers = {{"Allow", found.allowed}};
    return refused;
  }
  Call call{request, std::move(found.names), Json::object(), std::nullopt, now};
  Result<HttpAnswer> answered = answer_route(*found.route, call);
  if (answered) return *std::move(answered);
  if (answered.error().exit_status == 2) return error_answer(400, answered.error());
  return server_error(request, answered.error());
}

Result<HttpAnswer> Service::State::answer_route(const Route& route, Call& call) {
  const HttpRequest& request = call.request;
  if (route.access != Access::kPublic) {
    TROCAR_TRY(call.login, find_login(request, call.now));
    if (!call.login) return error_answer(401, "you are not logged in", "log in");
    TROCAR_TRY_STATUS(see_deletions(call.now));
    if (route.access == Access::kAdmin && call.session().account.role != results::Role::kAdmin) {
      const LimitedLog limited(backend.log_limit);
      log_warning("web: access refused: {} {} by {} from {}", request.method, log_text(request.path),
                  log_text(call.session().account.name), request.address);
      return error_answer(403, "only an admin may do this", "ask an admin");
    }
  }
  if (is_reading(request.method)) return route.handle(backend, call);
  if (!is_json(request)) return error_answer(415, "the body is not JSON", "send Content-Type: application/json");
  if (route.needs_csrf) {
    const auto token = request.find_header("x-csrf-token");
    if (!token || !signing::is_same_secret(*token, call.session().csrf_token))
      return error_answer(403, "the token of the page is missing or wrong", "reload the page and try again");
  }
  if (!request.body.empty()) {
    const auto body = config::parse_json(request.body, "body");
    if (!body)
      return error_answer(400, fmt::format("{} ({})", body.error().what, body.error().where), "send an object of JSON");
    if (!body->is_object()) return error_answer(400, "the body is not an object", "send an object of JSON");
    if (const Status known = check_fields(*body, route.fields); !known) return error_answer(400, known.error());
    call.body = *body;
  }
  return route.handle(backend, call);
}

Status Service::State::see_deletions(const Moment& now) {
  if (!deletions.is_due(now.steady)) return {};
  const auto repository = repositories->borrow();
  TROCAR_TRY(const bool has_deleted, deletions.look(*repository));
  if (has_deleted) forget_values(backend);
  return {};
}

Result<std::optional<results::WebSession>> Service::State::find_login(const HttpRequest& request, const Moment& now) {
  const auto token = find_session_token(request, options.is_secure);
  if (!token) return std::optional<results::WebSession>();
  const std::string digest = signing::token_digest(*token);
  TROCAR_TRY(const LoginCache::Value stored,
             sessions.get(digest, now.steady, [this, digest, now] { return load_login(digest, now); }));
  if (!*stored || is_session_valid((*stored)->begun, (*stored)->used, now.utc)) return *stored;
  const auto repository = repositories->borrow();
  TROCAR_TRY_STATUS(results::end_web_session(*repository, digest));
  sessions.clear();
  return std::optional<results::WebSession>();
}

/// The stored login, with this request as its last use.
Result<LoginCache::Value> Service::State::load_login(const std::string& digest, const Moment& now) {
  const auto repository = repositories->borrow();
  TROCAR_TRY(auto login, results::find_web_session(*repository, digest));
  const SessionRules rules;
  const bool is_used = login && is_session_valid(login->begun, login->used, now.utc, rules);
  if (is_used && now.utc - login->used >= rules.touch) {
    TROCAR_TRY_STATUS(results::touch_web_session(*repository, digest, now.utc));
    login->used = now.utc;
  }
  return std::make_shared<const std::optional<results::WebSession>>(std::move(login));
}

}  // namespace trocar::web
