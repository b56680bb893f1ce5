#pragma once

#include <string_view>

namespace trocar::report_detail {

/// The style sheet of the report: screen and A4 print, curves told apart by dashes as well as by colour.
std::string_view style_sheet();

}  // namespace trocar::report_detail
