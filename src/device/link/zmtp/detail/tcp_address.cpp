#include "link/zmtp/detail/tcp_address.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "core/text.h"
#include "link/endpoint.h"

namespace trocar::link::detail {
namespace {

template <class Address>
TcpAddress make_address(const Address& address) {
  TcpAddress made;
  std::memcpy(&made.storage, &address, sizeof address);
  made.size = sizeof address;
  return made;
}

sockaddr* as_socket_address(sockaddr_storage& storage) {
  return reinterpret_cast<sockaddr*>(&storage);
}

/// Address of a URL made by parse_endpoint().
std::optional<TcpAddress> parse_url(std::string_view url) {
  if (!url.starts_with(kTcpScheme)) return {};
  const std::string_view address = url.substr(kTcpScheme.size());
  const std::size_t colon = address.rfind(':');
  if (colon == std::string_view::npos) return {};
  const unsigned port = parse_number<unsigned>(address.substr(colon + 1)).value_or(0);
  return parse_tcp_address(address.substr(0, colon), port);
}

}  // namespace

std::string TcpAddress::url() const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (storage.ss_family == AF_INET) {
    sockaddr_in v4{};
    std::memcpy(&v4, &storage, sizeof v4);
    ::inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size());
    return fmt::format("{}{}:{}", kTcpScheme, text.data(), ntohs(v4.sin_port));
  }
  sockaddr_in6 v6{};
  std::memcpy(&v6, &storage, sizeof v6);
  ::inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size());
  return fmt::format("{}[{}]:{}", kTcpScheme, text.data(), ntohs(v6.sin6_port));
}

std::optional<TcpAddress> parse_tcp_address(std::string_view host, unsigned port) {
  const bool is_bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  const std::string text(is_bracketed ? host.substr(1, host.size() - 2) : host);
  if (text.find('\0') != std::string::npos) return {};
  if (is_bracketed) {
    sockaddr_in6 v6{};
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(static_cast<std::uint16_t>(port));
    return ::inet_pton(AF_INET6, text.c_str(), &v6.sin6_addr) == 1 ? std::optional(make_address(v6)) : std::nullopt;
  }
  sockaddr_in v4{};
  v4.sin_family = AF_INET;
  v4.sin_port = htons(static_cast<std::uint16_t>(port));
  return ::inet_pton(AF_INET, text.c_str(), &v4.sin_addr) == 1 ? std::optional(make_address(v4)) : std::nullopt;
}

Result<TcpListener> listen_tcp(const std::string& url) {
  auto address = parse_url(url);
  if (!address) return fail_usage("the address is not a number", url, "write tcp://127.0.0.1:5571 or tcp://[::1]:5571");
  Descriptor socket(::socket(address->storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  constexpr int kOn = 1;
  if (!socket.is_open() || ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &kOn, sizeof kOn) != 0 ||
      ::bind(socket.get(), as_socket_address(address->storage), address->size) != 0 ||
      ::listen(socket.get(), kWaitingConnections) != 0 ||
      ::getsockname(socket.get(), as_socket_address(address->storage), &address->size) != 0) {
    if (errno == EADDRINUSE) {
      return fail("the endpoint is in use by another server", url, "end that one or choose another endpoint");
    }
    return fail("the endpoint cannot be bound", url, std::strerror(errno));
  }
  return TcpListener{std::move(socket), address->url()};
}

}  // namespace trocar::link::detail
