#include "web/security/session_cookie.h"

#include <fmt/format.h>

namespace trocar::web {
namespace {

constexpr std::size_t kTokenCharacters = 43;  ///< 256 bits, signing/token.h.
constexpr std::string_view kTokenAlphabet = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
/// The clock of a database server or of a second program may be a little ahead.
constexpr std::chrono::seconds kClockDifference{60};

std::string set_cookie(std::string_view value, bool is_secure, std::string_view more) {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}{}", cookie_name(is_secure), value,
                     is_secure ? "; Secure" : "", more);
}

}  // namespace

std::string_view cookie_name(bool is_secure) noexcept {
  return is_secure ? "__Host-trocar_session" : "trocar_session";
}

std::string login_cookie(std::string_view token, bool is_secure) {
  return set_cookie(token, is_secure, "");
}

std::string logout_cookie(bool is_secure) {
  return set_cookie("", is_secure, "; Max-Age=0");
}

std::optional<std::string> find_session_token(const HttpRequest& request, bool is_secure) {
  std::optional<std::string> token;
  for (const auto& [name, value] : request.headers) {
    if (!is_same_name(name, "cookie")) continue;
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::size_t end = rest.find(';');
      std::string_view pair = rest.substr(0, end);
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
      while (pair.starts_with(' ')) pair.remove_prefix(1);
      const std::size_t equals = pair.find('=');
      if (equals == std::string_view::npos || pair.substr(0, equals) != cookie_name(is_secure)) continue;
      if (token) return std::nullopt;
      token = std::string(pair.substr(equals + 1));
    }
  }
  const bool is_ours =
      token && token->size() == kTokenCharacters && token->find_first_not_of(kTokenAlphabet) == std::string::npos;
  return is_ours ? token : std::nullopt;
}

bool is_session_valid(std::chrono::sys_seconds begun, std::chrono::sys_seconds used, std::chrono::sys_seconds now,
                      const SessionRules& rules) noexcept {
  if (begun > now + kClockDifference || used > now + kClockDifference) return false;
  return now - used < rules.idle && now - begun < rules.whole;
}

}  // namespace trocar::web
