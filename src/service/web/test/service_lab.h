#pragma once

#include <optional>
#include <string>

#include "core/files/folders.h"
#include "results/people.h"
#include "web/api/json_fields.h"
#include "web/service.h"

namespace trocar::web::testing {

inline constexpr const char* kAdmin = "Dr. Weber";
inline constexpr const char* kInstructor = "huber";
inline constexpr const char* kPassword = "grinding copper lids";
/// Of a service under test: the default work takes 50 ms.
inline constexpr signing::PasswordWork kQuickWork{1, std::size_t{64} << 10};

/// A service with a database of its own, an admin and an instructor, and a clock that the test sets. Requests come from
/// `address` and, after log_in, with cookie and CSRF token, as from the page.
class ServiceLab {
 public:
  explicit ServiceLab(bool is_secure = false, bool is_behind_proxy = false);

  HttpRequest request(const std::string& method, const std::string& target, const Json& body = {}) const;
  HttpAnswer send(const HttpRequest& request) { return service_->answer(request); }
  HttpAnswer get(const std::string& target) { return send(request("GET", target)); }
  HttpAnswer post(const std::string& target, const Json& body) { return send(request("POST", target, body)); }
  HttpAnswer log_in(const std::string& name = kAdmin, const std::string& password = kPassword);

  /// A second connection to the same database, as of a station.
  results::Repository& repository() { return *repository_; }
  results::Person add_person(const std::string& name, results::Group group = results::Group::kTrainee);
  /// A finished attempt at "liver-biopsy" with this score; a path length of 200 − score mm; a trace of three samples.
  std::string add_attempt(const results::Person& person, std::optional<double> score);

  void pass(std::chrono::seconds time);  ///< Of both clocks.
  void restart();                        ///< Of the service, with the same database.

  Moment now;
  std::string address = "127.0.0.1", cookie, csrf;

 private:
  void open_service();

  bool is_secure_, is_behind_proxy_;
  TemporaryFolder folder_;
  std::optional<results::Repository> repository_;
  std::optional<Service> service_;
};

Json json_of(const HttpAnswer& answer);
std::string header_of(const HttpAnswer& answer, const std::string& name);
/// The text of an answer; that of a source can be read once.
std::string body_of(const HttpAnswer& answer);

}  // namespace trocar::web::testing
