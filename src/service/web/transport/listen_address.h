#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::web {

struct ListenAddress {
  std::string host = "127.0.0.1";  ///< A number of IPv4 or IPv6 (without brackets), or "localhost".
  int port = 8080;                 ///< 0: any free port.

  /// Whether only programs of this machine reach it: 127.0.0.0/8, ::1, "localhost".
  bool is_loopback() const noexcept;
  /// Whether it stands for every address of the machine: 0.0.0.0, ::.
  bool is_any() const noexcept;
};

/// "HOST:PORT", "[::1]:PORT" or "PORT" (on 127.0.0.1). Error (exit status 2): no number of an address, no port from 0
/// to 65535.
Result<ListenAddress> parse_listen_address(std::string_view text);

/// A host as a URL shows it: IPv6 in brackets.
std::string url_host(const std::string& host);

}  // namespace trocar::web
