#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/result.h"

namespace trocar {

using Json = nlohmann::ordered_json;

/// Parses untrusted JSON; the error names `name` and the byte. Never throws.
Result<Json> parse_json(std::string_view text, const std::string& name);
Result<Json> load_json(const std::filesystem::path& path);

}  // namespace trocar
