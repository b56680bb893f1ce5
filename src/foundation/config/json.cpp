#include "config/json.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/files/input_file.h"

namespace trocar::config {
namespace {

constexpr int kMaxJsonDepth =
    64;  ///< Our documents are nested less than 10 deep; recursive functions may process them.

struct Extent {
  int deepest = 0;         ///< Nesting of arrays and objects.
  std::size_t commas = 0;  ///< Between values.
};

/// Strings do not count.
Extent extent_of(std::string_view text) {
  Extent extent;
  int depth = 0;
  bool in_string = false;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    if (in_string) {
      if (c == '\\') ++n;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      extent.deepest = std::max(extent.deepest, ++depth);
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',') {
      ++extent.commas;
    }
  }
  return extent;
}

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& name, std::size_t most_values) {
  const Extent extent = extent_of(text);
  if (extent.deepest > kMaxJsonDepth)
    return fail(fmt::format("the JSON is nested more than {} deep", kMaxJsonDepth), name, "is this the right file?");
  if (extent.commas > most_values)
    return fail(fmt::format("the JSON has more than {} values", most_values), name, "is this the right file?");
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    return fail("not valid JSON", fmt::format("{}, byte {}", name, error.byte), "export or download the file again");
  } catch (const std::exception& error) {
    return fail(fmt::format("the JSON cannot be read: {}", error.what()), name, "export or download the file again");
  }
}

Result<Json> load_json(const std::filesystem::path& path) {
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kJson));
  return parse_json(text, path.string(), kMostJsonFileValues);
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace trocar::config
