#pragma once

#include <sys/socket.h>

#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "link/detail/ipc_file.h"

namespace trocar::link::detail {

/// A numeric IP address and a port: "127.0.0.1:5571", "[::1]:5571". Names are not resolved.
struct TcpAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  std::string url() const;  ///< "tcp://[::1]:5571"
};
/// Parses with inet_pton: four decimal octets without leading zeros, or an IPv6 address in brackets.
std::optional<TcpAddress> parse_tcp_address(std::string_view host, unsigned port);
/// A non-blocking listening socket and its URL (port 0: any free port).
struct TcpListener {
  Descriptor socket;
  std::string url;
};
Result<TcpListener> listen_tcp(const std::string& url);

}  // namespace trocar::link::detail
