#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "web/message.h"
#include "web/security/moment.h"

namespace trocar::web {

/// "__Host-trocar_session" over TLS, where a browser takes it from this very host alone; "trocar_session" otherwise.
std::string_view cookie_name(bool is_secure) noexcept;
/// Value of a Set-Cookie header. The cookie ends with the browser's session, and the server's limits hold before.
std::string login_cookie(std::string_view token, bool is_secure);
/// The same that removes it.
std::string logout_cookie(bool is_secure);
/// The token of a request. Empty: there is none, two cookies have its name, or it cannot be one of ours.
std::optional<std::string> find_session_token(const HttpRequest& request, bool is_secure);

/// How long a login lasts.
struct SessionRules {
  std::chrono::seconds idle{std::chrono::minutes(30)};  ///< Without a request.
  std::chrono::seconds whole{std::chrono::hours(12)};
  std::chrono::seconds touch{std::chrono::minutes(1)};  ///< Its last use is written so often.
};
/// False also for a login that begins or was used after `now`: the clock was set back, and its age is not known.
bool is_session_valid(std::chrono::sys_seconds begun, std::chrono::sys_seconds used, std::chrono::sys_seconds now,
                      const SessionRules& rules = {}) noexcept;

}  // namespace trocar::web
