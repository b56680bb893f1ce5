#include "config/csv.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace trocar::config {
namespace {

constexpr const char* kCheckQuotes = "check the quotes";
constexpr std::size_t kMostFields = 10'000;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

}  // namespace

std::string csv_text(std::string_view text) {
  const std::string guarded = guard_formulas(text);
  std::string field = "\"";
  field.reserve(guarded.size() + 2);
  for (const char c : guarded) {
    if (c == '"') field += '"';
    field += c;
  }
  return field += '"';
}

std::string csv_row(const std::vector<std::string>& fields) {
  return fmt::format("{}\r\n", fmt::join(fields, ","));
}

std::string plain_text(std::string_view field) {
  return without_formula_guards(field);
}

CsvReader::CsvReader(std::string_view text, std::string where)
    : CsvReader(
          [rest = text]() mutable -> Result<std::string> {
            constexpr std::size_t kPiece = std::size_t{64} << 10;
            std::string piece(rest.substr(0, kPiece));
            rest.remove_prefix(piece.size());
            return piece;
          },
          std::move(where)) {}

bool CsvReader::fill(std::size_t distance) {
  while (at_ + distance >= buffer_.size() && !is_ended_) {
    buffer_.erase(0, at_);
    at_ = 0;
    Result<std::string> piece = source_();
    if (!piece) fault_ = tl::unexpected(piece.error());
    is_ended_ = !piece || piece->empty();
    if (piece) buffer_ += *piece;
  }
  return at_ + distance < buffer_.size();
}

tl::unexpected<Error> CsvReader::refuse(std::string what, const char* advice) const {
  return fail(std::move(what), fmt::format("{}, line {}, field {}", where_, field_line_, field_), advice);
}

/// Takes the characters up to one of `ends` into the field, or to the end of the file.
Status CsvReader::take_until(std::string& field, std::string_view ends) {
  while (peek()) {
    const std::size_t end = std::min(buffer_.find_first_of(ends, at_), buffer_.size());
    const std::string_view taken = std::string_view(buffer_).substr(at_, end - at_);
    if (taken.find('\0') != std::string_view::npos) return refuse("it is no text", "name a CSV file");
    row_bytes_ += taken.size();
    if (row_bytes_ > kMostRowBytes)
      return refuse(fmt::format("the row is longer than {} MiB", kMostRowBytes >> 20), kCheckQuotes);
    line_ += static_cast<std::size_t>(std::ranges::count(taken, '\n'));
    field += taken;
    at_ = end;
    if (at_ < buffer_.size()) break;
  }
  return fault_;
}

void CsvReader::skip_spaces() {
  while (is_next(' ') || is_next('\t')) ++at_;
}

Status CsvReader::read_quoted(std::string& field) {
  for (++at_;; ++at_) {
    TROCAR_TRY_STATUS(take_until(field, "\""));
    if (!peek()) return refuse("a quotation does not end", kCheckQuotes);
    if (peek(1) != '"') break;
    ++at_;
    ++row_bytes_;
    field += '"';
  }
  ++at_;
  skip_spaces();
  if (!is_field_end()) return refuse("text after a quotation", kCheckQuotes);
  return {};
}

Status CsvReader::read_field(std::string& field) {
  field.clear();
  if (is_next('"')) return read_quoted(field);
  TROCAR_TRY_STATUS(take_until(field, ",\r\n\""));
  if (!is_next('"')) return {};
  if (field.find_first_not_of(" \t") != std::string::npos)
    return refuse("a quotation mark inside of a field", kCheckQuotes);
  field.clear();
  return read_quoted(field);
}

Status CsvReader::read_row(CsvRow& row) {
  row.line = line_;
  row_bytes_ = 0;
  std::size_t fields = 0;
  for (bool has_more = true; has_more;) {
    if (fields == row.fields.size()) row.fields.emplace_back();
    field_ = fields + 1;
    field_line_ = line_;
    TROCAR_TRY_STATUS(read_field(row.fields[fields++]));
    has_more = is_next(',');
    if (has_more) ++at_;
    if (has_more && fields >= kMostFields)
      return refuse(fmt::format("the row has more than {} fields", kMostFields), "put commas between fields only");
  }
  row.fields.resize(fields);
  if (is_next('\r')) ++at_;
  if (is_next('\n')) ++at_;
  ++line_;
  return fault_;
}

Result<bool> CsvReader::next(CsvRow& row) {
  if (!has_begun_) {
    has_begun_ = true;
    peek(kByteOrderMark.size());
    if (std::string_view(buffer_).starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  }
  while (peek()) {
    TROCAR_TRY_STATUS(read_row(row));
    if (row.fields.size() > 1 || !row.fields.front().empty()) return true;
  }
  TROCAR_TRY_STATUS(fault_);
  return false;
}

Result<std::vector<CsvRow>> parse_csv(std::string_view text, const std::string& where) {
  CsvReader reader(text, where);
  std::vector<CsvRow> rows;
  for (CsvRow row;;) {
    TROCAR_TRY(const bool has_row, reader.next(row));
    if (!has_row) return rows;
    rows.push_back(row);
  }
}

}  // namespace trocar::config
