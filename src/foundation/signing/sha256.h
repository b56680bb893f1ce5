#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace trocar::signing {

/// SHA-256 as 64 hexadecimal digits, the same as of the program sha256sum.
std::string sha256(std::string_view bytes);
/// That of a file, read in pieces. Errors: those of InputFile for a session.
Result<std::string> sha256_of_session(const std::filesystem::path& file);

}  // namespace trocar::signing
