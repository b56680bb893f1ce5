#pragma once

#include <string>

namespace trocar::testing {

/// How often a part occurs in a text, without overlap.
inline std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

}  // namespace trocar::testing
