#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::signing {

/// A random token of `bits` bits (a multiple of 8, 128 to 512) in URL-safe Base64 without padding: 22 characters for
/// 128 bits, 43 for 256. Error: libsodium cannot be used.
Result<std::string> make_token(int bits);

/// A random key of 128 bits, 32 hexadecimal digits, for what has to be told apart everywhere: attempts, people.
std::string make_id();

/// Digest of a token (SHA-256, 64 hexadecimal digits): a server stores it in place of the token, so that a stolen
/// database opens no session.
std::string token_digest(std::string_view token);

/// Compares two texts of the same length in a time that does not depend on their bytes. False for different lengths.
bool is_same_secret(std::string_view a, std::string_view b) noexcept;

/// SHA-256 as 64 hexadecimal digits, the same as of the program sha256sum.
std::string sha256(std::string_view bytes);
/// That of a file, read in pieces. Errors: those of InputFile for a session.
Result<std::string> sha256_of_session(const std::filesystem::path& file);

}  // namespace trocar::signing
