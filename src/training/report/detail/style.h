#pragma once

#include <string>

namespace trocar::report::detail {

/// The style sheet of the report: screen and A4 print, curves told apart by dashes as well as by colour.
std::string style_sheet();
/// The part of it that a plot alone needs.
std::string plot_style();

}  // namespace trocar::report::detail
