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
/// ipc://PATH (shorter than a socket's name may be) and tcp://HOST:PORT; else exit status 2.
Result<Endpoint> parse_endpoint(std::string_view text);
/// For a tool, under the user's run-time folder ($XDG_RUNTIME_DIR, else /tmp/trocar-UID, made for the user alone).
std::string default_endpoint(std::string_view tool);

}  // namespace trocar
