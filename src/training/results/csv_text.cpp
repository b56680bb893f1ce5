#include "results/csv_text.h"

#include <fmt/format.h>

namespace trocar::results {
namespace {

bool is_formula(std::string_view text) {
  return !text.empty() && std::string_view("=+-@\t'").find(text.front()) != std::string_view::npos;
}

}  // namespace

std::string csv_text(std::string_view text) {
  std::string field = is_formula(text) ? fmt::format("'{}", text) : std::string(text);
  if (field.find_first_of(",\"\n\r") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_row(const std::vector<std::string>& fields) {
  return fmt::format("{}\r\n", fmt::join(fields, ","));
}

std::string plain_text(std::string_view field) {
  const bool has_mark = field.size() >= 2 && field.front() == '\'' && is_formula(field.substr(1));
  return std::string(has_mark ? field.substr(1) : field);
}

Result<std::vector<std::vector<std::string>>> parse_csv(std::string_view text, const std::string& where) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t at = 0; at < text.size();) {
    const auto place = [&] { return fmt::format("{}, row {}", where, rows.size() + 1); };
    std::vector<std::string> row;
    for (bool has_more = true; has_more;) {
      std::string field;
      if (at < text.size() && text[at] == '"') {
        for (++at;; ++at) {
          if (at >= text.size()) return fail("a quotation does not end", place(), "check the quotes");
          if (text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"')) break;
          if (text[at] == '"') ++at;
          field += text[at];
        }
        ++at;
        if (at < text.size() && text[at] != ',' && text[at] != '\r' && text[at] != '\n')
          return fail("text after a quotation", place(), "check the quotes");
      } else {
        for (; at < text.size() && text[at] != ',' && text[at] != '\r' && text[at] != '\n'; ++at) field += text[at];
      }
      row.push_back(std::move(field));
      has_more = at < text.size() && text[at] == ',';
      if (has_more) ++at;
    }
    if (at < text.size() && text[at] == '\r') ++at;
    if (at < text.size() && text[at] == '\n') ++at;
    if (row.size() > 1 || !row.front().empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace trocar::results
