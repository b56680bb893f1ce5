#pragma once

#include <string>
#include <utility>

#include "core/text.h"

namespace trocar::attempt::detail {

/// A message with a capital first letter, for the beginning of a sentence.
inline std::string sentence(std::string text) {
  if (!text.empty()) text[0] = ascii::to_upper(text[0]);
  return text;
}

}  // namespace trocar::attempt::detail
