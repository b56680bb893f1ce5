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
