#pragma once

#include <filesystem>
#include <set>
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

/// A CURVE key pair in Z85, 40 characters each.
struct CurveKeys {
  std::string public_key;
  std::string secret_key;
};
Result<CurveKeys> make_curve_keys();

/// Writes DIR/server.key, DIR/server.pub, DIR/client.key, DIR/client.pub and DIR/allowed (the client's public key).
/// Only the user can access the secret files (0600) and the folder (0700). Errors (exit status 2): the folder is not
/// empty.
Status write_key_folder(const std::filesystem::path& folder);
/// Reads a .key file: lines "public KEY" and "secret KEY". Errors: a key is missing or not Z85, the keys do not match,
/// or check_private_file() fails. All three functions refuse a file that other users can replace (check_folders_of()).
Result<CurveKeys> load_curve_keys(const std::filesystem::path& file);
/// Reads a .pub file: one key.
Result<std::string> load_public_key(const std::filesystem::path& file);
/// Reads the public keys of the clients that may connect, one per line; # starts a comment. Errors: no key.
Result<std::set<std::string>> load_allow_list(const std::filesystem::path& file);

}  // namespace trocar::link
