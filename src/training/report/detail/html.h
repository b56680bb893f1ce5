#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trocar::report::detail {

/// Text for HTML and for attribute values; control characters become spaces.
std::string escape(std::string_view text);

/// A number with fixed decimals and a real minus sign; "–" when it is not finite.
std::string number_text(double value, int decimals);

/// Display text of a table's name: "liver-biopsy" -> "liver biopsy", "rib_right_10" -> "right rib 10".
std::string words(std::string_view name);
/// The same with a capital first letter.
std::string title_words(std::string_view name);

/// Display texts of names, escaped, with commas between.
std::string joined_words(const std::vector<std::string>& names);
/// The text with a capital first letter.
std::string capitalised(std::string text);

/// A name that somebody gave, escaped, which a report in another language leaves as it is.
std::string given_name(std::string_view name);

std::string base64(std::string_view bytes);

/// Approximate width of a text (px) at a font size, sufficient to place labels.
double text_width(std::string_view text, double font_px);

/// The style sheet of the report: screen and A4 print, curves differ in dashes as well as in colour.
std::string style_sheet();
/// The part of the style sheet that a plot needs.
std::string plot_style();

}  // namespace trocar::report::detail
