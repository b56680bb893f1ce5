#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "config/json_fwd.h"
#include "core/result.h"

namespace trocar::config {

/// Parses untrusted JSON, nested at most 64 deep; the error names `name` and the byte. Never throws.
Result<Json> parse_json(std::string_view text, const std::string& name);
Result<Json> load_json(const std::filesystem::path& path);

/// The document as text; bytes that are not UTF-8 are replaced; they do not throw. indent < 0: one line.
std::string json_text(const Json& json, int indent = 2);

}  // namespace trocar::config
