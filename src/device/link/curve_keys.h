#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "core/result.h"

namespace trocar::link {

/// A CURVE key pair in Z85, 40 characters each.
struct CurveKeys {
  std::string public_key;
  std::string secret_key;
};
Result<CurveKeys> make_curve_keys();

/// Writes DIR/server.key, DIR/server.pub, DIR/client.key, DIR/client.pub and DIR/allowed (the client's public key);
/// secret files for the user alone (0600), the folder too (0700). A folder that has something in it is refused (exit
/// status 2).
Status write_key_folder(const std::filesystem::path& folder);
/// A .key file: lines "public KEY" and "secret KEY". Errors: missing, not Z85, no pair, readable by others.
Result<CurveKeys> load_curve_keys(const std::filesystem::path& file);
/// A .pub file: one key.
Result<std::string> load_public_key(const std::filesystem::path& file);
/// Public keys of the clients that may connect, one a line, # starts a comment.
Result<std::set<std::string>> load_allow_list(const std::filesystem::path& file);

}  // namespace trocar::link
