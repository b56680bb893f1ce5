#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::results {

/// A field of a CSV file (RFC 4180), quoted where it has to be. A text that a spreadsheet would take for a formula (it
/// begins with = + - @, a tab or an apostrophe) gets an apostrophe in front, which parse_csv removes.
std::string csv_text(std::string_view text);
/// Fields with commas between them and a line end.
std::string csv_row(const std::vector<std::string>& fields);

/// A row of a CSV file.
struct CsvRow {
  std::size_t line = 1;  ///< Line of the file at which it begins, from 1.
  std::vector<std::string> fields;
};
/// Rows of fields, without empty lines. Error: a quote that does not end, text after a quote, a quote inside of a
/// field, a NUL; with line and field.
Result<std::vector<CsvRow>> parse_csv(std::string_view text, const std::string& where);
/// The text of a field without the apostrophe in front of csv_text.
std::string plain_text(std::string_view field);

}  // namespace trocar::results
