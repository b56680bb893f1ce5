#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar {

/// Where a server listens.
struct Endpoint {
  std::string url;          ///< "ipc:///run/user/0/trocar-needle", "tcp://127.0.0.1:5571"
  bool is_loopback = true;  ///< ipc, 127.0.0.0/8, ::1, localhost.
};
/// ipc:///PATH (absolute, no longer than a socket's name may be) and tcp://HOST:PORT (port 0: any free one; localhost
/// becomes 127.0.0.1, for sockets are bound to addresses); else exit status 2.
Result<Endpoint> parse_endpoint(std::string_view text);
/// For a tool, under the user's run-time folder ($XDG_RUNTIME_DIR where it is the user's alone, else /tmp/trocar-UID,
/// made so). Empty, with a warning in the log, where that one is another's: parse_endpoint() refuses it.
std::string default_endpoint(std::string_view tool);

}  // namespace trocar
