#include "web/security/request_origin.h"

#include <algorithm>

#include "core/ascii.h"
#include "web/transport/listen_address.h"

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

}  // namespace trocar::web
