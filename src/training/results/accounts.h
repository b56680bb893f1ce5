#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/repository.h"

namespace trocar::results {

/// Who may use the instructor's page.
enum class Role : std::uint8_t { kInstructor, kAdmin };
const char* to_string(Role role) noexcept;  ///< "instructor", "admin".
std::optional<Role> find_role(std::string_view name) noexcept;

struct Account {
  std::string id, name;
  Role role = Role::kInstructor;
  std::string password_hash;  ///< Encoded, from signing/password.h: this module only stores it.
  Seconds added{};
};
/// The name of a new account as clean_name gives it. Error (exit status 2): also a name that no address of the page can
/// contain: "..", or one with a slash.
Result<std::string> clean_account_name(std::string_view name);
/// Error (exit status 2): a name that cannot be used, or exists.
Result<Account> add_account(Repository& repository, std::string_view name, Role role, std::string_view password_hash,
                            Seconds now);
Result<std::vector<Account>> list_accounts(Repository& repository);
Result<std::optional<Account>> find_account(Repository& repository, std::string_view name);
/// Ends all sessions of the account but `kept_token_hash`.
Status change_password(Repository& repository, std::string_view account_id, std::string_view password_hash,
                       std::string_view kept_token_hash = {});
/// Error (exit status 2): it is the last admin, or there is no such account.
Status remove_account(Repository& repository, std::string_view name);

/// A login of a browser. The token itself is never stored.
struct WebSession {
  std::string token_hash;
  std::string csrf_token;
  Seconds begun{}, used{};
  Account account;
};
Status add_web_session(Repository& repository, const WebSession& session);
Result<std::optional<WebSession>> find_web_session(Repository& repository, std::string_view token_hash);
Status touch_web_session(Repository& repository, std::string_view token_hash, Seconds now);
Status end_web_session(Repository& repository, std::string_view token_hash);
/// Removes sessions that are over: used before `idle_since`, begun before `begun_since`, or begun after `now`.
Status remove_old_web_sessions(Repository& repository, Seconds idle_since, Seconds begun_since, Seconds now);

/// A client is forgotten so long after the last login from it, and beyond so many newer ones of an account.
inline constexpr std::chrono::days kLoginClientKept{90};
inline constexpr int kMostLoginClients = 50;

/// Notes that somebody has logged in to an account from a client: its address, or its network.
Status note_login_client(Repository& repository, std::string_view account_id, std::string_view client, Seconds now);
/// Whether it was noted for the account of this name.
Result<bool> is_login_client(Repository& repository, std::string_view account_name, std::string_view client,
                             Seconds now);

}  // namespace trocar::results
