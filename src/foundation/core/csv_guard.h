#pragma once

#include <string>
#include <string_view>

namespace trocar {
inline namespace core {

/// A text for a field of a CSV file that no spreadsheet takes for a formula, neither as a whole nor in a part: an
/// apostrophe precedes each place where a cell may begin (the begin of the text, and behind a comma, semicolon, tab or
/// line break, by which a spreadsheet of another country may separate) if a formula would begin there. That is one of
/// = + - @ (also in full width), a tab, a line break or an apostrophe, also behind blanks and quotation marks.
std::string guard_formulas(std::string_view text);

/// The text of guard_formulas(text). Texts without such apostrophes stay as they are.
std::string without_formula_guards(std::string_view field);

}  // namespace core
}  // namespace trocar
