#pragma once

#include <cctype>
#include <string>
#include <utility>

namespace trocar::attempt::detail {

/// A message with a capital first letter, for the beginning of a sentence.
inline std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace trocar::attempt::detail
