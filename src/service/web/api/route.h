#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/log.h"
#include "results/accounts.h"
#include "results/attempts.h"
#include "signing/password.h"
#include "web/api/json_fields.h"
#include "web/message.h"
#include "web/repository_pool.h"
#include "web/security/rate_limits.h"
#include "web/timed_cache.h"

namespace trocar::web {

/// Lets two threads hash passwords at a time, 64 MiB each, and a bounded number wait. Thread-safe.
class PasswordGate {
 public:
  /// Room to hash one password; the destructor gives it back. False: too many wait.
  class Pass {
   public:
    explicit Pass(PasswordGate& gate) : gate_(gate), is_inside_(gate.enter()) {}
    ~Pass() {
      if (is_inside_) gate_.leave();
    }
    Pass(const Pass&) = delete;
    Pass& operator=(const Pass&) = delete;
    explicit operator bool() const noexcept { return is_inside_; }

   private:
    PasswordGate& gate_;
    const bool is_inside_;
  };

 private:
  bool enter();
  void leave();

  static constexpr int kMostInside = 2;
  static constexpr int kMostWaiting = 40;  ///< The last one waits about a second.
  std::mutex mutex_;
  std::condition_variable has_left_;
  int inside_ = 0, waiting_ = 0;
};

/// Values of a metric at a task, shared by the pages that need all of them.
using SampleCache = TimedCache<std::vector<results::MetricSample>>;

/// Logins by the digest of their token; empty: there is none. Another program's changes are seen within a second.
using LoginCache = TimedCache<std::optional<results::WebSession>>;

/// Parts of the server that routes use; all of them thread-safe.
struct Backend {
  RepositoryPool& repositories;
  AnswerCache& answers;  ///< Of a second.
  SampleCache& samples;
  LoginCache& sessions;     ///< To be cleared when a login begins or ends.
  AnswerCache& statistics;  ///< Of a minute: values over all attempts.
  const Titles& titles;
  LoginThrottle& logins;
  TokenBuckets& public_answers;  ///< Of questionnaires, by address.
  PasswordGate& passwords;
  std::mutex& exports;  ///< One export reads at a time: it takes a processor, which pages would wait for.
  LogLimit& log_limit;  ///< Of lines that a client can cause again and again by what is refused.
  signing::PasswordWork password_work;
  std::string unknown_hash;  ///< Of no password: it takes as long to check as that of an account.
  bool is_secure = false;    ///< The browser uses TLS.
};

/// A request that has passed the guards.
struct Call {
  const HttpRequest& request;
  std::vector<std::string> names;  ///< Parts of the path at the places of '*'.
  Json body;                       ///< An object; empty where the request has no body.
  std::optional<results::WebSession> login;
  Moment now;

  const results::WebSession& session() const { return *login; }  ///< Precondition: the route needs a login.
};

enum class Access { kPublic, kInstructor, kAdmin };

/// Errors of exit status 2 are the client's (400), others the server's (500, with a number that is also in the log).
using RouteHandler = std::function<Result<HttpAnswer>(Backend&, const Call&)>;

struct Route {
  std::string_view method, pattern;  ///< "GET", "/api/people/*/curve".
  Access access;
  RouteHandler handle;
  bool needs_csrf = true;                     ///< Not before a login. Never for GET.
  std::vector<std::string_view> fields = {};  ///< That the body may have: a misspelt one is refused.
};

// Groups of routes.
std::vector<Route> account_routes();
std::vector<Route> people_routes();
std::vector<Route> people_change_routes();
std::vector<Route> metric_routes();
std::vector<Route> attempt_routes();
std::vector<Route> note_routes();
std::vector<Route> form_routes();
std::vector<Route> all_routes();

/// The route of a request with this path, still percent-encoded; `names` is filled. Null with the methods that the path
/// has, if another method is meant.
struct FoundRoute {
  const Route* route = nullptr;
  std::vector<std::string> names;
  std::string allowed;  ///< "GET, POST"; empty: no such path.
};
FoundRoute find_route(const std::vector<Route>& routes, std::string_view method, std::string_view path);

/// Forgets all values that were read before a change of people or attempts. Those that others are made of come first:
/// otherwise a request in between would make an answer of an old value.
void forget_values(Backend& backend);

HttpAnswer not_found(std::string_view what);
/// 429 with the time to wait.
HttpAnswer wait_answer(std::chrono::seconds wait, std::string_view error);
HttpAnswer busy_answer();  ///< Too many passwords and PINs wait to be hashed.
HttpAnswer ok(const Json& json, int status = 200);
/// A task of the query. Error (exit status 2): missing, or characters that no task has.
Result<std::string> query_task(const HttpRequest& request);
/// A course of the query; empty: all. Error (exit status 2): no name of a course.
Result<std::string> query_course(const HttpRequest& request);
/// A case of the query ("biopsy-2"); empty: all. Error (exit status 2): no name of a case.
Result<std::string> query_patient(const HttpRequest& request);
/// A level of help of the query; empty: all. Error (exit status 2): no level.
Result<std::string> query_level(const HttpRequest& request);
/// Whether a text is a key of a row: 32 hexadecimal digits.
bool is_id(std::string_view text) noexcept;

/// Values of a metric at a task, at most ten minutes old. `course` empty: all.
Result<SampleCache::Value> samples_of(Backend& backend, const std::string& task, const std::string& metric,
                                      const std::string& course, const Moment& now);

/// The answer of the cache by its key, or the JSON of `make(Repository&)`, which returns Result<std::optional<Json>>;
/// empty: 404 for `what`. It owns
/// what it uses, beside the backend: the cache may call it again after the request has ended.
using MakeJson = std::function<Result<std::optional<Json>>(results::Repository&)>;
Result<HttpAnswer> cached(AnswerCache& cache, RepositoryPool& repositories, const std::string& key, const Moment& now,
                          std::string_view what, const MakeJson& make);

/// The same for work that borrows connections itself, one at a time: a thread that holds one must not wait for another.
using MakeJsonAlone = std::function<Result<std::optional<Json>>()>;
Result<HttpAnswer> cached(AnswerCache& cache, const std::string& key, const Moment& now, std::string_view what,
                          const MakeJsonAlone& make);

}  // namespace trocar::web
