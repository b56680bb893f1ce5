#pragma once

#include <string>

namespace trocar::config {

/// A text as a TOML string in quotes, for files that are written.
std::string toml_quoted(const std::string& text);

}  // namespace trocar::config
