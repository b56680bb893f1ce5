#include "web/security/request_guards.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text.h"
#include "web/transport/http_server.h"

namespace trocar::web {

std::optional<std::string> host_of(std::string_view header) {
  std::string_view host = header, port;
  if (header.starts_with('[')) {
    const std::size_t end = header.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    host = header.substr(1, end - 1);
    port = header.substr(end + 1);
  } else if (const std::size_t colon = header.find(':'); colon != std::string_view::npos) {
    host = header.substr(0, colon);
    port = header.substr(colon);
  }
  const bool is_port = port.empty() || (port.size() > 1 && port.front() == ':' &&
                                        port.find_first_not_of("0123456789", 1) == std::string_view::npos);
  if (host.empty() || !is_port) return std::nullopt;
  const auto is_of_name = [](char c) {
    return ascii::is_letter_or_digit(c) || c == '-' || c == '.' || c == ':' || c == '_';
  };
  if (!std::all_of(host.begin(), host.end(), is_of_name)) return std::nullopt;
  return ascii::lower_case(host);
}

bool is_for_this_host(const HttpRequest& request, bool is_loopback,
                      const std::function<bool(const std::string&)>& is_served) {
  const auto header = request.find_header("host");
  const auto host = header ? host_of(*header) : std::nullopt;
  if (!host) return false;
  if (is_loopback && ListenAddress{*host, 0}.is_loopback()) return true;
  return is_served && is_served(*host);
}

bool is_from_another_site(const HttpRequest& request, std::string_view scheme) {
  if (request.has_header("sec-fetch-site")) {
    const auto site = request.find_header("sec-fetch-site");
    if (!site || (*site != "same-origin" && *site != "none")) return true;
  }
  if (!request.has_header("origin")) return false;
  const auto origin = request.find_header("origin");
  const auto host = request.find_header("host");
  return !origin || !host || !is_same_name(*origin, std::string(scheme) + "://" + std::string(*host));
}

namespace {

constexpr std::size_t kV4Bytes = 4, kV6Bytes = 16, kMappedBytes = kV6Bytes - kV4Bytes;

struct Address {
  std::array<unsigned char, kV6Bytes> bytes{};  ///< Of IPv4: the first four.
  bool is_v6 = false;
};

std::optional<Address> parse_address(std::string_view text) {
  const std::string host(text);
  Address address;
  if (::inet_pton(AF_INET, host.c_str(), address.bytes.data()) == 1) return address;
  if (::inet_pton(AF_INET6, host.c_str(), address.bytes.data()) != 1) return std::nullopt;
  constexpr std::array<unsigned char, kMappedBytes> kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
  address.is_v6 = !std::equal(kMapped.begin(), kMapped.end(), address.bytes.begin());
  if (!address.is_v6) std::copy(address.bytes.begin() + kMappedBytes, address.bytes.end(), address.bytes.begin());
  return address;
}

std::string text_of(const Address& address) {
  char text[INET6_ADDRSTRLEN] = "";
  ::inet_ntop(address.is_v6 ? AF_INET6 : AF_INET, address.bytes.data(), text, sizeof(text));
  return text;
}

/// The network of an address: its first bits, and their number unless it is the whole address of IPv4.
std::string network_text(Address address, std::size_t v4_bytes, std::size_t v6_bytes) {
  const std::size_t kept = address.is_v6 ? v6_bytes : v4_bytes;
  std::fill(address.bytes.begin() + static_cast<std::ptrdiff_t>(kept), address.bytes.end(),
            static_cast<unsigned char>(0));
  constexpr std::size_t kBits = 8;
  return kept == kV4Bytes ? text_of(address) : fmt::format("{}/{}", text_of(address), kBits * kept);
}

}  // namespace

std::string client_of(std::string_view address) {
  const auto parsed = parse_address(address);
  return parsed ? network_text(*parsed, kV4Bytes, 8) : std::string(address);
}

std::string network_of(std::string_view client) {
  const auto parsed = parse_address(client.substr(0, client.find('/')));
  return parsed ? network_text(*parsed, 3, 6) : std::string(client);
}

std::optional<std::string> forwarded_address(const HttpRequest& request) {
  std::optional<std::string_view> last;
  for (const auto& [name, value] : request.headers)
    if (is_same_name(name, "x-forwarded-for")) last = std::string_view(value).substr(value.rfind(',') + 1);
  if (!last) return std::nullopt;
  constexpr std::string_view kAround = " \t\"";
  const std::size_t begin = std::min(last->find_first_not_of(kAround), last->size());
  std::string_view host = last->substr(begin, last->find_last_not_of(kAround) + 1 - begin);
  if (host.starts_with('[')) {
    host = host.substr(1, std::min(host.find(']'), host.size()) - 1);
  } else if (std::ranges::count(host, ':') == 1) {
    host = host.substr(0, host.find(':'));
  }
  const auto address = parse_address(host);
  return address ? std::optional(text_of(*address)) : std::nullopt;
}

std::string log_text(std::string_view text) {
  constexpr std::size_t kMostBytes = 60;
  std::string safe = "\"";
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (safe.size() + bytes > kMostBytes) return safe + "…\"";
    const bool is_plain = character && is_printable(character->code_point) && character->code_point != '"' &&
                          character->code_point != '\\';
    safe += is_plain ? text.substr(0, bytes) : "?";
    text.remove_prefix(bytes);
  }
  return safe + "\"";
}

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

TextPairs security_headers(bool is_secure) {
  TextPairs headers = {
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
       "font-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"X-Frame-Options", "DENY"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Permissions-Policy", "camera=(), geolocation=(), microphone=(), payment=(), usb=()"},
      {"Cache-Control", "no-store"},
  };
  if (is_secure) headers.emplace_back("Strict-Transport-Security", "max-age=31536000");
  return headers;
}

}  // namespace trocar::web
