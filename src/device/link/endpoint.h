#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::link {

inline constexpr std::string_view kIpcScheme = "ipc://";
inline constexpr std::string_view kTcpScheme = "tcp://";

/// Address of a server.
struct Endpoint {
  std::string url;  ///< "ipc:///run/user/0/trocar-needle", "tcp://127.0.0.1:5571"
  /// True for tcp: other users can connect, also on loopback. For ipc, the file mode prevents it.
  bool needs_keys = false;
};
/// Parses ipc:///PATH (absolute, at most as long as a socket name may be) or tcp://ADDRESS:PORT (an IPv4 address, or an
/// IPv6 address in brackets, in the format of inet_pton; port 0: any free port; localhost is 127.0.0.1). Errors (exit
/// status 2): another format.
Result<Endpoint> parse_endpoint(std::string_view text);
/// Default endpoint of a tool, in the user's run-time folder: $XDG_RUNTIME_DIR if only the user can access it, else
/// /tmp/trocar-UID, which is made private to the user. If that folder is not private, logs a warning and returns an
/// empty text, which parse_endpoint() refuses.
std::string default_endpoint(std::string_view tool);

}  // namespace trocar::link
