#include "web/transport/listen_address.h"

#include <arpa/inet.h>

#include "core/parse_number.h"

namespace trocar::web {
namespace {

constexpr int kMostPort = 65535;
constexpr const char* kAdvice = "write HOST:PORT, such as 127.0.0.1:8080 or [::1]:8080";

bool is_ipv4(const std::string& host) {
  in_addr address{};
  return ::inet_pton(AF_INET, host.c_str(), &address) == 1;
}

bool is_ipv6(const std::string& host) {
  in6_addr address{};
  return ::inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

}  // namespace

bool ListenAddress::is_loopback() const noexcept {
  in_addr v4{};
  if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6);
  return host == "localhost";
}

bool ListenAddress::is_any() const noexcept {
  in6_addr v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_UNSPECIFIED(&v6);
  return host == "0.0.0.0";
}

Result<ListenAddress> parse_listen_address(std::string_view text) {
  ListenAddress address;
  const std::size_t colon = text.rfind(':');
  std::string_view port = text;
  if (colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    port = text.substr(colon + 1);
    const bool has_brackets = host.starts_with('[') && host.ends_with(']');
    if (has_brackets) host = host.substr(1, host.size() - 2);
    address.host = std::string(host);
    const bool is_host = has_brackets ? is_ipv6(address.host) : is_ipv4(address.host) || host == "localhost";
    if (!is_host) return fail_usage("not an address to listen on", std::string(text), kAdvice);
  }
  const auto number = parse_number<int>(port);
  if (!number || *number < 0 || *number > kMostPort)
    return fail_usage("not a port from 0 to 65535", std::string(text), kAdvice);
  address.port = *number;
  return address;
}

std::string url_host(const std::string& host) {
  return is_ipv6(host) ? "[" + host + "]" : host;
}

}  // namespace trocar::web
