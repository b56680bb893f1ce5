#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::config {

/// The text of one value of a TOML document: a string, a number, a truth value, a list or an inline table. A number
/// that is parsed from the text is bit-identical to the original. Malformed UTF-8 in a string is replaced by U+FFFD.
class TomlValue {
 public:
  struct Entry;  ///< Key and value of an inline table.

  TomlValue(std::string_view text);
  TomlValue(const std::string& text) : TomlValue(std::string_view(text)) {}
  TomlValue(const char* text) : TomlValue(std::string_view(text)) {}
  TomlValue(bool value);
  TomlValue(std::floating_point auto value) : text_(number_text(static_cast<double>(value))) {}
  TomlValue(std::integral auto value) : text_(number_text(static_cast<std::int64_t>(value))) {}
  /// A list.
  template <class T>
  TomlValue(const std::vector<T>& values) : TomlValue(std::vector<TomlValue>(values.begin(), values.end())) {}
  TomlValue(const std::vector<TomlValue>& values);
  /// An inline table, with the keys in this order.
  TomlValue(const std::vector<Entry>& entries);

  const std::string& text() const noexcept { return text_; }

 private:
  static std::string number_text(double value);
  static std::string number_text(std::int64_t value);

  std::string text_;
};

struct TomlValue::Entry {
  std::string_view key;
  TomlValue value;
};

/// Writes a TOML document. Keys and tables have the order of the calls: TomlTable::keys returns the rows of a table in
/// the order of the file's lines (toml++ formats a whole table with sorted keys).
class TomlWriter {
 public:
  /// A comment line; `text` has no line break.
  void comment(std::string_view text);
  /// Starts the table [a.b] for the path {"a", "b"}.
  void begin_table(std::initializer_list<std::string_view> path);
  /// Starts the next table of the list [[name]].
  void begin_row(std::string_view name);
  /// Sets a key of the table that was started last, or of the document if no table was started.
  void set(std::string_view key, const TomlValue& value);

  const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

}  // namespace trocar::config
