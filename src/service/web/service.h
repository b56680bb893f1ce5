#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "database/database_url.h"
#include "signing/password.h"
#include "web/message.h"
#include "web/security/rate_limits.h"

namespace trocar::web {

struct ServiceOptions {
  database::DatabaseUrl database;
  std::filesystem::path data_folder;  ///< Of the shipped tables.
  std::filesystem::path page_folder;  ///< Of the page: data/web.
  bool is_secure = false;             ///< The browser uses TLS: our own, or that of a proxy in front.
  bool is_behind_proxy = false;       ///< The client's address is the last one of X-Forwarded-For.
  bool is_loopback = true;            ///< Also listens on loopback: "localhost" is served.
  std::function<bool(const std::string& host)> is_served;  ///< Other names of this server.
  std::function<Moment()> now;                             ///< Empty: the clocks of the system.
  signing::PasswordWork password_work;                     ///< Passwords with other work are hashed again at a login.
  std::size_t connections = 4;                             ///< To the database.
};

/// Everything of `trocar serve` but the sockets: guards, sessions, the interface under /api/ and the page. One answer
/// for one request, from any thread.
class Service {
 public:
  /// Errors: those of Repository::open, StaticFiles::load and Titles::load.
  static Result<Service> open(ServiceOptions options);
  Service(Service&&) noexcept;
  Service& operator=(Service&&) noexcept;
  ~Service();

  HttpAnswer answer(const HttpRequest& request);
  /// Number of accounts: without any nobody can log in.
  Result<std::size_t> count_accounts();
  /// See Database::note.
  std::string database_note();

 private:
  struct State;
  explicit Service(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace trocar::web
