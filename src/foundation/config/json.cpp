#include "config/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

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

/// "FILE, line 3, column 7" for a byte from 0.
std::string place_of(const std::string& name, std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("{}, line {}, column {}", name, line, before.size() - start + 1);
}

/// Where the key number `number` (from 0) of a valid text begins.
std::size_t find_key(std::string_view text, std::size_t number) {
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] != '"') continue;
    const std::size_t begin = n;
    for (++n; n < text.size() && text[n] != '"'; ++n)
      if (text[n] == '\\') ++n;
    const std::size_t next = text.find_first_not_of(" \t\r\n", n + 1);
    if (next == std::string_view::npos || text[next] != ':') continue;  // a value
    if (number-- == 0) return begin;
  }
  return 0;
}

/// Keys of the objects that are open while a text is parsed.
class KeyWatch {
 public:
  void see(Json::parse_event_t event, const Json& value) {
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event != Json::parse_event_t::key) return;
    const auto& key = value.get_ref<const std::string&>();
    if (!open_.back().insert(key).second && !twice_) twice_ = {key, keys_};
    ++keys_;
  }
  struct Key {
    std::string text;
    std::size_t number;  ///< Of all keys of the text.
  };
  const std::optional<Key>& twice() const noexcept { return twice_; }

 private:
  std::vector<std::set<std::string>> open_;
  std::size_t keys_ = 0;
  std::optional<Key> twice_;
};

}  // namespace

Result<Json> parse_json(std::string_view text, const std::string& name, std::size_t most_values) {
  const Extent extent = extent_of(text);
  if (extent.deepest > kMaxJsonDepth)
    return fail(fmt::format("the JSON is nested more than {} deep", kMaxJsonDepth), name, "is this the right file?");
  if (extent.commas > most_values)
    return fail(fmt::format("the JSON has more than {} values", most_values), name, "is this the right file?");
  try {
    KeyWatch keys;
    Json json = Json::parse(text, [&](int, Json::parse_event_t event, Json& value) {
      keys.see(event, value);
      return true;
    });
    if (!keys.twice()) return json;
    return fail(fmt::format("the key \"{}\" occurs twice", keys.twice()->text),
                place_of(name, text, find_key(text, keys.twice()->number)), "remove one");
  } catch (const Json::parse_error& error) {
    return fail("not valid JSON", place_of(name, text, error.byte > 0 ? error.byte - 1 : 0),
                "correct it there, or export or download the file again");
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
