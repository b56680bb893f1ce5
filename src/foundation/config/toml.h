#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace toml {
inline namespace v3 {
class table;
}
}  // namespace toml

namespace trocar::config {

/// The allowed range of a number in a configuration file.
struct Range {
  double low;
  double high;
};

/// A table of a TOML document. The error of a getter names the file, the key and the expected value. Cheap to copy;
/// keeps the document alive.
class TomlTable {
 public:
  /// Every key that is present, in the file's order of lines.
  std::vector<std::string> keys() const;
  bool has(std::string_view key) const;
  /// Error for the first key that is not in `known`, with the nearest known key: a misspelled key is never ignored
  /// silently.
  Status check_keys(const std::vector<std::string_view>& known) const;

  /// Finite number inside the range, or an error. An integer in the file is also accepted.
  Result<double> number(std::string_view key, Range range) const;
  Result<double> number_or(std::string_view key, Range range, double fallback) const;
  Result<std::int64_t> integer(std::string_view key, Range range) const;
  Result<bool> boolean_or(std::string_view key, bool fallback) const;
  Result<std::string> string(std::string_view key) const;
  Result<std::string> string_or(std::string_view key, std::string fallback) const;
  Result<std::vector<std::string>> strings(std::string_view key) const;  ///< A missing key is an empty list.
  Result<std::vector<double>> numbers(std::string_view key, Range range) const;
  /// A list of lists with `columns` numbers each.
  Result<std::vector<std::vector<double>>> rows(std::string_view key, std::size_t columns, Range range) const;
  Result<TomlTable> table(std::string_view key) const;
  /// All tables of an array of tables ([[key]]); a missing key is an empty list.
  Result<std::vector<TomlTable>> tables(std::string_view key) const;

  /// Path of this table for messages: "file.toml: tissues.liver".
  std::string where() const;

 private:
  friend Result<TomlTable> parse_toml(std::string_view text, const std::string& name);
  friend struct TomlNodes;
  std::shared_ptr<const toml::table> document_;
  const toml::table* table_ = nullptr;
  std::string file_;
  std::string path_;
};

/// Parses untrusted TOML text: at most 4 MiB of valid UTF-8 without control characters, nested at most 32 deep, without
/// backslashes that join lines (toml++ 3.3 aborts or misbehaves on such text). `name` is used in messages.
Result<TomlTable> parse_toml(std::string_view text, const std::string& name);
Result<TomlTable> load_toml(const std::filesystem::path& path);

/// A number of a data table with its source: KEY = {value = 0.46, source = "…", range = [low, high]}.
struct SourcedNumber {
  double value = 0.0;
  std::string source;
  std::optional<Range> range;  ///< Measured spread or, for an assumed number, the plausible range.
};

/// Reads a SourcedNumber. Errors: outside of `allowed`, no source, or a source that begins with "assumed" without a
/// range.
Result<SourcedNumber> read_sourced_number(const TomlTable& table, std::string_view key, Range allowed);

/// The candidate that is closest to a misspelled word, empty when none is similar.
std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& candidates);

}  // namespace trocar::config
