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

namespace {

/// Reads a text field by field.
class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  bool is_at_end() const { return at_ >= text_.size(); }

  Result<CsvRow> read_row() {
    CsvRow row{line_, {}};
    for (bool has_more = true; has_more;) {
      const std::string place = fmt::format("{}, line {}, field {}", where_, line_, row.fields.size() + 1);
      TROCAR_TRY(row.fields.emplace_back(), is_next('"') ? read_quoted(place) : read_plain(place));
      has_more = is_next(',');
      if (has_more) ++at_;
    }
    if (is_next('\r')) ++at_;
    if (is_next('\n')) ++at_;
    ++line_;
    return row;
  }

 private:
  static constexpr const char* kCheckQuotes = "check the quotes";

  bool is_next(char c) const { return at_ < text_.size() && text_[at_] == c; }
  bool is_field_end() const { return is_at_end() || is_next(',') || is_next('\r') || is_next('\n'); }

  Result<std::string> read_quoted(const std::string& place) {
    std::string field;
    for (++at_;; ++at_) {
      if (is_at_end()) return fail("a quotation does not end", place, kCheckQuotes);
      if (is_next('"') && (at_ + 1 >= text_.size() || text_[at_ + 1] != '"')) break;
      if (is_next('"')) ++at_;
      if (is_next('\n')) ++line_;
      field += text_[at_];
    }
    ++at_;
    if (!is_field_end()) return fail("text after a quotation", place, kCheckQuotes);
    return field;
  }

  Result<std::string> read_plain(const std::string& place) {
    std::string field;
    for (; !is_field_end(); ++at_) field += text_[at_];
    if (field.find('"') != std::string::npos) return fail("a quotation mark inside of a field", place, kCheckQuotes);
    if (field.find('\0') != std::string::npos) return fail("it is no text", place, "name a CSV file");
    return field;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace

Result<std::vector<CsvRow>> parse_csv(std::string_view text, const std::string& where) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<CsvRow> rows;
  for (CsvReader reader(text, where); !reader.is_at_end();) {
    TROCAR_TRY(CsvRow row, reader.read_row());
    if (row.fields.size() > 1 || !row.fields.front().empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace trocar::results
