#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "web/message.h"
#include "web/security/rate_limits.h"

namespace trocar::web {

/// The host of a Host header without its port and brackets, lower case: "localhost", "::1". Empty: malformed.
std::optional<std::string> host_of(std::string_view header);

/// Whether the Host header names this server, which a page that rebinds its own name to this address cannot do (DNS
/// rebinding). Always: "localhost" and loopback numbers if `is_loopback`; else those that `is_served` accepts.
bool is_for_this_host(const HttpRequest& request, bool is_loopback,
                      const std::function<bool(const std::string&)>& is_served);

/// Whether a browser says that another site caused the request. A program that is no browser says nothing: false.
bool is_from_another_site(const HttpRequest& request, std::string_view scheme);

/// Whom a limit of a rate is for: an address of IPv4 ("192.0.2.1", also where it is written as one of IPv6), or the
/// first 64 bits of one of IPv6 ("2001:db8:0:7::/64"), because one machine has all addresses of such a network. Another
/// text is returned as it is.
std::string client_of(std::string_view address);

/// The network of which one party may own all clients: 24 bits of IPv4, 48 bits of IPv6.
std::string network_of(std::string_view client);

/// The last address of all X-Forwarded-For headers, as the proxy in front has appended it, without port and brackets.
/// Empty: there is none, or it is no address.
std::optional<std::string> forwarded_address(const HttpRequest& request);

/// A client's text for a line of the log: in quotation marks, control characters, quotation marks and malformed UTF-8
/// replaced by '?', at most 60 bytes. It can neither begin a line nor look like another field.
std::string log_text(std::string_view text);

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

/// Headers of every answer: what a browser may load for the page (scripts, styles, images and data of this server
/// alone; no frame around it), types are not guessed, no address leaks in a Referer, nothing is stored. `is_secure`:
/// the browser uses TLS, and has to for the next year.
TextPairs security_headers(bool is_secure);

}  // namespace trocar::web
