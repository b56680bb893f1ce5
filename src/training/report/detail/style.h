#pragma once

#include <string>

namespace trocar::report::detail {

/// The style sheet of the report: screen and A4 print, curves differ in dashes as well as in colour.
std::string style_sheet();
/// The part of the style sheet that a plot needs.
std::string plot_style();

}  // namespace trocar::report::detail
