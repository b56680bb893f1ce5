#include "config/toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "config/detail/toml_library.h"
#include "config/detail/toml_text.h"
#include "core/files/input_file.h"

namespace trocar::config {

/// Data of toml++ about the keys of a table, for the getters and their messages.
struct TomlNodes {
  const TomlTable& table;

  const toml::node* find(std::string_view key) const { return table.table_ ? table.table_->get(key) : nullptr; }

  std::string path_of(std::string_view key) const {
    return table.path_.empty() ? std::string(key) : fmt::format("{}.{}", table.path_, key);
  }

  /// "tissues.toml, line 12: layers.skin.delta_x_mm"
  std::string place(std::string_view key) const {
    const toml::node* node = find(key);
    const auto line = node ? node->source().begin.line : 0;
    return line > 0 ? fmt::format("{}, line {}: {}", table.file_, line, path_of(key))
                    : fmt::format("{}: {}", table.file_, path_of(key));
  }

  tl::unexpected<Error> missing(std::string_view key, std::string_view expected) const {
    return fail(fmt::format("missing: {}", expected), place(key), "add the key");
  }
  tl::unexpected<Error> wrong(std::string_view key, std::string_view expected) const {
    return fail(fmt::format("must be {}", expected), place(key), "correct the value");
  }

  TomlTable child(const toml::table& node, std::string path) const {
    TomlTable child = table;
    child.table_ = &node;
    child.path_ = std::move(path);
    return child;
  }
};

namespace {

std::string number_words(Range range) {
  return fmt::format("a number from {} to {}", range.low, range.high);
}

bool is_inside(double value, Range range) {
  return std::isfinite(value) && value >= range.low && value <= range.high;
}

/// The numbers of a list; nothing if an element is none inside the range.
std::optional<std::vector<double>> finite_numbers(const toml::array& list, Range range) {
  std::vector<double> values;
  for (const toml::node& element : list) {
    const double value = element.is_number() ? element.value<double>().value_or(std::nan("")) : std::nan("");
    if (!is_inside(value, range)) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

}  // namespace

std::vector<std::string> TomlTable::keys() const {
  struct Entry {
    toml::source_position position;
    std::string key;
  };
  std::vector<Entry> entries;
  if (table_)
    for (const auto& [key, node] : *table_) entries.push_back({key.source().begin, std::string(key.str())});
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.position.line, a.position.column) < std::pair(b.position.line, b.position.column);
  });
  std::vector<std::string> keys;
  for (Entry& entry : entries) keys.push_back(std::move(entry.key));
  return keys;
}

bool TomlTable::has(std::string_view key) const {
  return TomlNodes{*this}.find(key) != nullptr;
}

Status TomlTable::check_keys(const std::vector<std::string_view>& known) const {
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string_view nearest = nearest_word(key, known);
    return fail("unknown key", TomlNodes{*this}.place(key),
                nearest.empty() ? fmt::format("known are: {}", fmt::join(known, ", "))
                                : fmt::format("did you mean \"{}\"?", nearest));
  }
  return {};
}

Result<double> TomlTable::number(std::string_view key, Range range) const {
  const TomlNodes nodes{*this};
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, number_words(range));
  if (!node->is_number()) return nodes.wrong(key, number_words(range));
  const double value = node->value<double>().value_or(std::nan(""));
  if (!is_inside(value, range)) return nodes.wrong(key, fmt::format("{}, it is {}", number_words(range), value));
  return value;
}

Result<double> TomlTable::number_or(std::string_view key, Range range, double fallback) const {
  if (!has(key)) return fallback;
  return number(key, range);
}

Result<std::int64_t> TomlTable::integer(std::string_view key, Range range) const {
  const TomlNodes nodes{*this};
  const std::string expected = fmt::format("a whole number from {} to {}", range.low, range.high);
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, expected);
  if (!node->is_integer()) return nodes.wrong(key, expected);
  const std::int64_t value = node->value<std::int64_t>().value_or(0);
  if (!is_inside(static_cast<double>(value), range))
    return nodes.wrong(key, fmt::format("{}, it is {}", expected, value));
  return value;
}

Result<bool> TomlTable::boolean_or(std::string_view key, bool fallback) const {
  const TomlNodes nodes{*this};
  const toml::node* node = nodes.find(key);
  if (!node) return fallback;
  if (!node->is_boolean()) return nodes.wrong(key, "true or false");
  return node->value<bool>().value_or(fallback);
}

Result<std::string> TomlTable::string(std::string_view key) const {
  const TomlNodes nodes{*this};
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, "a text in quotes");
  if (!node->is_string()) return nodes.wrong(key, "a text in quotes");
  return std::string(node->as_string()->get());
}

Result<std::string> TomlTable::string_or(std::string_view key, std::string fallback) const {
  if (!has(key)) return fallback;
  return string(key);
}

Result<std::vector<std::string>> TomlTable::strings(std::string_view key) const {
  const TomlNodes nodes{*this};
  std::vector<std::string> values;
  const toml::node* node = nodes.find(key);
  if (!node) return values;
  if (!node->is_array()) return nodes.wrong(key, "a list of texts in quotes");
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_string()) return nodes.wrong(key, "a list of texts in quotes");
    values.emplace_back(element.as_string()->get());
  }
  return values;
}

Result<std::vector<double>> TomlTable::numbers(std::string_view key, Range range) const {
  const TomlNodes nodes{*this};
  const std::string expected = fmt::format("a list, each {}", number_words(range));
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, expected);
  if (!node->is_array()) return nodes.wrong(key, expected);
  auto values = finite_numbers(*node->as_array(), range);
  if (!values) return nodes.wrong(key, expected);
  return *std::move(values);
}

Result<std::vector<std::vector<double>>> TomlTable::rows(std::string_view key, std::size_t columns, Range range) const {
  const TomlNodes nodes{*this};
  const std::string expected = fmt::format("a list of lists of {}, each {}", columns, number_words(range));
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, expected);
  if (!node->is_array()) return nodes.wrong(key, expected);
  std::vector<std::vector<double>> rows;
  for (const toml::node& element : *node->as_array()) {
    auto row = element.is_array() ? finite_numbers(*element.as_array(), range) : std::nullopt;
    if (!row || row->size() != columns)
      return nodes.wrong(key, fmt::format("{}; row {} is not", expected, rows.size() + 1));
    rows.push_back(*std::move(row));
  }
  return rows;
}

Result<TomlTable> TomlTable::table(std::string_view key) const {
  const TomlNodes nodes{*this};
  const toml::node* node = nodes.find(key);
  if (!node) return nodes.missing(key, "a table");
  if (!node->is_table()) return nodes.wrong(key, "a table");
  return nodes.child(*node->as_table(), nodes.path_of(key));
}

Result<std::vector<TomlTable>> TomlTable::tables(std::string_view key) const {
  const TomlNodes nodes{*this};
  std::vector<TomlTable> children;
  const toml::node* node = nodes.find(key);
  if (!node) return children;
  if (!node->is_array()) return nodes.wrong(key, "a list of tables ([[...]])");
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_table()) return nodes.wrong(key, "a list of tables ([[...]])");
    children.push_back(nodes.child(*element.as_table(), fmt::format("{}[{}]", nodes.path_of(key), children.size())));
  }
  return children;
}

std::string TomlTable::where() const {
  return path_.empty() ? file_ : fmt::format("{}: {}", file_, path_);
}

Result<TomlTable> parse_toml(std::string_view text, const std::string& name) {
  TROCAR_TRY_STATUS(detail::check_toml_text(text, name));
  try {
    const auto document = std::make_shared<const toml::table>(toml::parse(text));
    TomlTable table;
    table.document_ = document;
    table.table_ = document.get();
    table.file_ = name;
    return table;
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    return fail(fmt::format("not valid TOML: {}", error.description()),
                fmt::format("{}, line {}, column {}", name, at.line, at.column), "correct the file");
  } catch (const std::exception& error) {
    return fail(fmt::format("not valid TOML: {}", error.what()), name, "correct the file");
  }
}

Result<TomlTable> load_toml(const std::filesystem::path& path) {
  TROCAR_TRY(const std::string text, read_input(path, FileKind::kToml));
  return parse_toml(text, path.string());
}

Result<SourcedNumber> read_sourced_number(const TomlTable& table, std::string_view key, Range allowed) {
  TROCAR_TRY(const TomlTable entry, table.table(key));
  TROCAR_TRY_STATUS(entry.check_keys({"value", "source", "range"}));
  SourcedNumber number;
  TROCAR_TRY(number.value, entry.number("value", allowed));
  TROCAR_TRY(number.source, entry.string("source"));
  if (number.source.empty()) return fail("the source is empty", entry.where(), "state where the number comes from");
  if (entry.has("range")) {
    TROCAR_TRY(const std::vector<double> range, entry.numbers("range", allowed));
    if (range.size() != 2 || range[0] > number.value || number.value > range[1])
      return fail("the range must be [low, high] around the value", entry.where(), "correct the range, or remove it");
    number.range = Range{range[0], range[1]};
  } else if (number.source.starts_with("assumed")) {
    return fail("an assumed number must give its range", entry.where(), "add range = [low, high]");
  }
  return number;
}

std::string_view nearest_word(std::string_view word, const std::vector<std::string_view>& candidates) {
  std::string_view nearest;
  std::size_t smallest = word.size() + 1;
  for (const std::string_view candidate : candidates) {
    // Levenshtein distance, one row of the table at a time.
    std::vector<std::size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < candidate.size(); ++j) {
        const std::size_t replaced = diagonal + (word[i] == candidate[j] ? 0 : 1);
        diagonal = row[j + 1];
        row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
      }
    }
    // More changes than a third of the letters do not count as a misspelling.
    const std::size_t allowed = std::max<std::size_t>(2, std::max(word.size(), candidate.size()) / 3);
    if (row.back() <= allowed && row.back() < smallest) {
      smallest = row.back();
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace trocar::config
