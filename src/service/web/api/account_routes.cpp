// Login, the own account, and the accounts of others.
#include <fmt/format.h>

#include "core/log.h"
#include "core/version.h"
#include "results/accounts.h"
#include "results/names.h"
#include "signing/password.h"
#include "signing/token.h"
#include "web/api/route.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

constexpr int kTokenBits = 256;

Json account_json(const results::Account& account) {
  return {{"name", account.name}, {"role", results::to_string(account.role)}};
}

/// A new token of a session, which takes the place of the request's own one.
struct NewSession {
  results::WebSession stored;
  std::string token;
};
Result<NewSession> make_session(const results::Account& account, const Moment& now) {
  NewSession session;
  TROCAR_TRY(session.token, signing::make_token(kTokenBits));
  TROCAR_TRY(session.stored.csrf_token, signing::make_token(kTokenBits));
  session.stored.token_hash = signing::token_digest(session.token);
  session.stored.begun = now.utc;
  session.stored.used = now.utc;
  session.stored.account = account;
  return session;
}

Status store_session(results::Repository& repository, const NewSession& session, const Moment& now) {
  const SessionRules rules;
  TROCAR_TRY_STATUS(results::remove_old_web_sessions(repository, now.utc - rules.idle, now.utc - rules.whole, now.utc));
  return results::add_web_session(repository, session.stored);
}

/// The account, if name and password belong together. An unknown name takes as long as a wrong password.
Result<std::optional<results::Account>> check_login(Backend& backend, const std::string& name,
                                                    const std::string& password) {
  std::optional<results::Account> account;
  {
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY(account, results::find_account(*repository, name));
  }
  const std::string hash = account ? account->password_hash : backend.unknown_hash;
  if (!signing::is_password(hash, password) || !account) return std::optional<results::Account>();
  if (signing::needs_rehash(hash, backend.password_work)) {
    TROCAR_TRY(account->password_hash, signing::hash_password(password, backend.password_work));
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY_STATUS(results::change_password(*repository, account->id, account->password_hash));
  }
  return account;
}

Result<HttpAnswer> log_in(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string name, text_field(call.body, "name"));
  TROCAR_TRY(const std::string password, text_field(call.body, "password"));
  const std::string& address = call.request.address;
  LoginTry login{results::name_key(name), call.request.client};
  {
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY(login.is_known, results::is_login_client(*repository, name, login.client, call.now.utc));
  }
  if (const auto wait = backend.logins.try_begin(login, call.now.steady)) {
    const LimitedLog limited(backend.log_limit);
    log_warning("web: login refused for {} s: account {} from {}", wait->count(), log_text(name), address);
    return wait_answer(*wait, "there were too many failed logins");
  }
  const PasswordGate::Pass pass(backend.passwords);
  if (!pass) return busy_answer();
  TROCAR_TRY(const std::optional<results::Account> account, check_login(backend, name, password));
  if (!account) {
    log_warning("web: login failed: account {} from {}", log_text(name), address);
    return error_answer(401, "name or password is wrong", "check both; upper and lower case matter in a password");
  }
  backend.logins.succeeded(login);
  TROCAR_TRY(const NewSession session, make_session(*account, call.now));
  const auto repository = backend.repositories.borrow();
  if (const auto old = find_session_token(call.request, backend.is_secure))
    TROCAR_TRY_STATUS(results::end_web_session(*repository, signing::token_digest(*old)));
  TROCAR_TRY_STATUS(store_session(*repository, session, call.now));
  TROCAR_TRY_STATUS(results::note_login_client(*repository, account->id, login.client, call.now.utc));
  backend.sessions.clear();
  log_info("web: login succeeded: account {} from {}", log_text(account->name), address);
  HttpAnswer answer = ok({{"account", account_json(*account)}, {"csrf", session.stored.csrf_token}});
  answer.headers = {{"Set-Cookie", login_cookie(session.token, backend.is_secure)}};
  return answer;
}

Result<HttpAnswer> log_out(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::end_web_session(*repository, call.session().token_hash));
  backend.sessions.clear();
  log_info("web: logout: account {} from {}", log_text(call.session().account.name), call.request.address);
  HttpAnswer answer = empty_answer(204);
  answer.headers = {{"Set-Cookie", logout_cookie(backend.is_secure)}, {"Clear-Site-Data", "\"cache\", \"storage\""}};
  return answer;
}

Result<HttpAnswer> show_me(Backend&, const Call& call) {
  return ok({{"account", account_json(call.session().account)},
             {"csrf", call.session().csrf_token},
             {"program_version", kVersion}});
}

Result<HttpAnswer> change_own_password(Backend& backend, const Call& call) {
  const results::Account& account = call.session().account;
  TROCAR_TRY(const std::string old_password, text_field(call.body, "old"));
  TROCAR_TRY(const std::string new_password, text_field(call.body, "new"));
  TROCAR_TRY_STATUS(signing::check_new_password(new_password, account.name));
  const LoginTry login{results::name_key(account.name), call.request.client, true};
  if (const auto wait = backend.logins.try_begin(login, call.now.steady))
    return wait_answer(*wait, "there were too many wrong passwords");
  const PasswordGate::Pass pass(backend.passwords);
  if (!pass) return busy_answer();
  if (!signing::is_password(account.password_hash, old_password)) {
    log_warning("web: wrong password at its change: account {} from {}", log_text(account.name), call.request.address);
    return error_answer(403, "the current password is wrong", "type it again");
  }
  backend.logins.succeeded(login);
  TROCAR_TRY(const std::string hash, signing::hash_password(new_password, backend.password_work));
  // A new token, with the CSRF token that the page has.
  TROCAR_TRY(NewSession session, make_session(account, call.now));
  session.stored.csrf_token = call.session().csrf_token;
  session.stored.begun = call.session().begun;
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(store_session(*repository, session, call.now));
  TROCAR_TRY_STATUS(results::change_password(*repository, account.id, hash, session.stored.token_hash));
  backend.sessions.clear();
  log_info("web: password changed: account {} from {}", log_text(account.name), call.request.address);
  HttpAnswer answer = empty_answer(204);
  answer.headers = {{"Set-Cookie", login_cookie(session.token, backend.is_secure)}};
  return answer;
}

Result<HttpAnswer> list_all(Backend& backend, const Call&) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::vector<results::Account> accounts, results::list_accounts(*repository));
  Json list = Json::array();
  for (const results::Account& account : accounts) {
    Json entry = account_json(account);
    entry["added_s"] = seconds_of(account.added);
    list.push_back(std::move(entry));
  }
  return ok({{"accounts", std::move(list)}});
}

Result<HttpAnswer> add(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string given, text_field(call.body, "name"));
  TROCAR_TRY(const std::string name, results::clean_account_name(given));
  TROCAR_TRY(const std::string password, text_field(call.body, "password"));
  TROCAR_TRY(const std::string role_name, text_field(call.body, "role"));
  const auto role = results::find_role(role_name);
  if (!role) return fail_usage("there is no such role", "role", "choose admin or instructor");
  TROCAR_TRY_STATUS(signing::check_new_password(password, name));
  const PasswordGate::Pass pass(backend.passwords);
  if (!pass) return busy_answer();
  TROCAR_TRY(const std::string hash, signing::hash_password(password, backend.password_work));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Account> other, results::find_account(*repository, name));
  if (other) return error_answer(409, "the name is taken", "choose another name");
  TROCAR_TRY(const results::Account added, results::add_account(*repository, name, *role, hash, call.now.utc));
  log_warning("web: account added: {} with the role {} by {} from {}", log_text(added.name), role_name,
              log_text(call.session().account.name), call.request.address);
  return ok(account_json(added), 201);
}

Result<HttpAnswer> remove(Backend& backend, const Call& call) {
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY(const std::optional<results::Account> account, results::find_account(*repository, call.names[0]));
  if (!account) return not_found("account");
  if (const Status removed = results::remove_account(*repository, account->name); !removed) {
    if (removed.error().exit_status != 2) return tl::unexpected(removed.error());
    return error_answer(409, removed.error());
  }
  backend.sessions.clear();
  log_warning("web: account removed: {} by {} from {}", log_text(account->name), log_text(call.session().account.name),
              call.request.address);
  return empty_answer(204);
}

/// Of another account: the own one needs its current password.
Result<HttpAnswer> reset_password(Backend& backend, const Call& call) {
  TROCAR_TRY(const std::string password, text_field(call.body, "password"));
  std::optional<results::Account> account;
  {
    const auto repository = backend.repositories.borrow();
    TROCAR_TRY(account, results::find_account(*repository, call.names[0]));
  }
  if (!account) return not_found("account");
  if (account->id == call.session().account.id)
    return fail_usage("it is your own account", "password", "change it under Password, with the current one");
  TROCAR_TRY_STATUS(signing::check_new_password(password, account->name));
  const PasswordGate::Pass pass(backend.passwords);
  if (!pass) return busy_answer();
  TROCAR_TRY(const std::string hash, signing::hash_password(password, backend.password_work));
  const auto repository = backend.repositories.borrow();
  TROCAR_TRY_STATUS(results::change_password(*repository, account->id, hash));
  backend.sessions.clear();
  log_warning("web: password of account {} reset by {} from {}", log_text(account->name),
              log_text(call.session().account.name), call.request.address);
  return empty_answer(204);
}

}  // namespace

std::vector<Route> account_routes() {
  return {
      {"POST", "/api/login", Access::kPublic, log_in, false, {"name", "password"}},
      {"POST", "/api/logout", Access::kInstructor, log_out},
      {"GET", "/api/me", Access::kInstructor, show_me},
      {"POST", "/api/password", Access::kInstructor, change_own_password, true, {"old", "new"}},
      {"GET", "/api/accounts", Access::kAdmin, list_all},
      {"POST", "/api/accounts", Access::kAdmin, add, true, {"name", "password", "role"}},
      {"DELETE", "/api/accounts/*", Access::kAdmin, remove},
      {"PUT", "/api/accounts/*/password", Access::kAdmin, reset_password, true, {"password"}},
  };
}

}  // namespace trocar::web
