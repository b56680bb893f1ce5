#pragma once

#include <string>
#include <string_view>

namespace trocar::web {

/// A client's text for a line of the log: in quotation marks, control characters, quotation marks and malformed UTF-8
/// replaced by '?', at most 60 bytes. It can neither begin a line nor look like another field.
std::string log_text(std::string_view text);

}  // namespace trocar::web
