#include "config/toml_quoted.h"

#include "config/json.h"

namespace trocar::config {

std::string toml_quoted(const std::string& text) {
  std::string quoted;
  for (const char c : json_text(Json(text), -1)) {  // the escapes are JSON's, but TOML wants DEL escaped too
    if (c == '\x7f')
      quoted += "\\u007f";
    else
      quoted += c;
  }
  return quoted;
}

}  // namespace trocar::config
