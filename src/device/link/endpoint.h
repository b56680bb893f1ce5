#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::link {

/// Where a server listens.
struct Endpoint {
  std::string url;          ///< "ipc:///run/user/0/trocar-needle", "tcp://127.0.0.1:5571"
  bool needs_keys = false;  ///< tcp: other users can connect, on loopback too. On ipc the file's mode keeps them out.
};
/// ipc:///PATH (absolute, no longer than a socket's name may be) and tcp://ADDRESS:PORT (an address of version 4, or of
/// version 6 in brackets, as inet_pton takes it; port 0: any free one; localhost is 127.0.0.1); else exit status 2.
Result<Endpoint> parse_endpoint(std::string_view text);
/// For a tool, under the user's run-time folder ($XDG_RUNTIME_DIR where it is the user's alone, else /tmp/trocar-UID,
/// made so). Empty, with a warning in the log, where that one is another's: parse_endpoint() refuses it.
std::string default_endpoint(std::string_view tool);

}  // namespace trocar::link
