#include "config/toml_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/detail/toml_library.h"
#include "core/text.h"

namespace trocar::config {
namespace {

// Strings stay on one line: TomlTable refuses lines that end with a backslash.
constexpr toml::format_flags kFlags = toml::format_flags::allow_unicode_strings;
constexpr std::size_t kLongestLine = 110;  ///< A longer list has one line per value.

/// Only for single values: in lists of numbers below 0.1, toml++ 3.3 converts a negative logarithm to size_t, which is
/// undefined.
std::string formatted(const toml::node& node) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << toml::toml_formatter(node, kFlags);
  return std::move(stream).str();
}

std::string text_of(std::string_view text) {
  return formatted(toml::value<std::string>(valid_utf8(text)));
}

/// toml++ 3.3 leaves the quotes off a key such as "it's", which is not valid.
std::string key_text(std::string_view key) {
  const auto is_bare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), is_bare) ? std::string(key) : text_of(key);
}

/// The shortest digits that read back to the same number; toml++ 3.3 writes 17: 0.46 as 0.46000000000000002.
std::string shortest(double value) {
  std::string text = fmt::format("{}", value);
  if (!std::isfinite(value)) return std::isnan(value) ? "nan" : text;
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

TomlValue::TomlValue(std::string_view text) : text_(text_of(text)) {}

TomlValue::TomlValue(bool value) : text_(formatted(toml::value<bool>(value))) {}

std::string TomlValue::number_text(double value) {
  return shortest(value);
}

std::string TomlValue::number_text(std::int64_t value) {
  return formatted(toml::value<std::int64_t>(value));
}

TomlValue::TomlValue(const std::vector<TomlValue>& values) {
  std::vector<std::string_view> texts;
  for (const TomlValue& value : values) texts.push_back(value.text());
  text_ = fmt::format("[{}]", fmt::join(texts, ", "));
  if (text_.size() > kLongestLine) text_ = fmt::format("[\n  {},\n]", fmt::join(texts, ",\n  "));
}

TomlValue::TomlValue(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries)
    text_ += fmt::format("{}{} = {}", text_.empty() ? "" : ", ", key_text(entry.key), entry.value.text());
  text_ = fmt::format("{{{}}}", text_);
}

void TomlWriter::comment(std::string_view text) {
  text_ += fmt::format("# {}\n", text);
}

void TomlWriter::begin_table(std::initializer_list<std::string_view> path) {
  std::vector<std::string> keys;
  for (const std::string_view key : path) keys.push_back(key_text(key));
  text_ += fmt::format("{}[{}]\n", text_.empty() ? "" : "\n", fmt::join(keys, "."));
}

void TomlWriter::begin_row(std::string_view name) {
  text_ += fmt::format("{}[[{}]]\n", text_.empty() ? "" : "\n", key_text(name));
}

void TomlWriter::set(std::string_view key, const TomlValue& value) {
  text_ += fmt::format("{} = {}\n", key_text(key), value.text());
}

}  // namespace trocar::config
