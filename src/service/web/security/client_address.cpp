#include "web/security/client_address.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace trocar::web {
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

}  // namespace trocar::web
