#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::config {

/// A text as a field of a CSV file (RFC 4180): always in quotation marks, and with the apostrophes of
/// core/text.h, so that no spreadsheet takes it or a part of it for a formula.
std::string csv_text(std::string_view text);
/// Fields with commas between them and a line end.
std::string csv_row(const std::vector<std::string>& fields);
/// The text of a field without the apostrophes of csv_text.
std::string plain_text(std::string_view field);

/// A row of a CSV file.
struct CsvRow {
  std::size_t line = 1;  ///< Line of the file at which it begins, from 1.
  std::vector<std::string> fields;
};

/// Reads a CSV file row by row: RFC 4180, with or without a byte order mark; spaces around a quotation are left out. A
/// longer row than kMostRowBytes is refused, so that a quotation that does not end takes no more memory.
class CsvReader {
 public:
  static constexpr std::size_t kMostRowBytes = std::size_t{16} << 20;
  /// The next bytes of the file; an empty piece is its end.
  using Source = std::function<Result<std::string>()>;

  /// `where`: the file, for messages.
  CsvReader(Source source, std::string where) : source_(std::move(source)), where_(std::move(where)) {}
  /// Of a text, which outlives it.
  CsvReader(std::string_view text, std::string where);

  /// Reads the next row that is not empty; false: the end. Error: a quotation that does not end, text after a
  /// quotation, a quotation mark inside of a field, a NUL byte, a row that is too long; with line and field. Errors of
  /// the source. Call it with the same row again: its memory is used again.
  Result<bool> next(CsvRow& row);

 private:
  Status read_row(CsvRow& row);
  Status read_field(std::string& field);
  Status read_quoted(std::string& field);
  void skip_spaces();
  /// The character at a distance; empty: the end of the file, or an error, which `fault_` keeps.
  std::optional<char> peek(std::size_t distance = 0) {
    return at_ + distance < buffer_.size() || fill(distance) ? std::optional(buffer_[at_ + distance]) : std::nullopt;
  }
  bool fill(std::size_t distance);
  bool is_next(char c) { return peek() == c; }
  bool is_field_end() { return !peek() || is_next(',') || is_next('\r') || is_next('\n'); }
  Status take_until(std::string& field, std::string_view ends);
  /// An error with the place of the present field.
  tl::unexpected<Error> refuse(std::string what, const char* advice) const;

  Source source_;
  std::string where_, buffer_;
  std::size_t at_ = 0, line_ = 1, row_bytes_ = 0;
  std::size_t field_ = 1, field_line_ = 1;  ///< Number and line of the present field.
  bool has_begun_ = false, is_ended_ = false;
  Status fault_;
};

/// All rows of a text.
Result<std::vector<CsvRow>> parse_csv(std::string_view text, const std::string& where);

}  // namespace trocar::config
