#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "config/json_fwd.h"
#include "core/result.h"

namespace trocar::config {

/// Most values of a JSON file: a value takes up to 100 bytes of memory, and may be two bytes of the file. [assumed:
/// markups of 3D Slicer have about 20 a control point]
inline constexpr std::size_t kMostJsonFileValues = 500'000;

/// Parses untrusted JSON, nested at most 64 deep; the error names `name`, line and column (in bytes, from 1). A key
/// that an object has twice is refused: readers differ in which one counts. So is a text of more than `most_values`
/// commas, those in strings excepted. Never throws.
Result<Json> parse_json(std::string_view text, const std::string& name,
                        std::size_t most_values = std::numeric_limits<std::size_t>::max());
/// The same for a file, with kMostJsonFileValues.
Result<Json> load_json(const std::filesystem::path& path);

/// The document as text; bytes that are not UTF-8 are replaced; they do not throw. indent < 0: one line.
std::string json_text(const Json& json, int indent = 2);

/// The value; null if there is none.
template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}
/// The text; null if it is empty.
inline Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

}  // namespace trocar::config
