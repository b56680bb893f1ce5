#include "anatomy/structure_words.h"

#include <algorithm>

namespace trocar {

std::string structure_words(std::string_view name) {
  std::string side;
  std::string rest;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    const std::string_view word = name.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    std::string& part = side.empty() && (word == "left" || word == "right") ? side : rest;
    if (!part.empty()) part += ' ';
    part += word;
  }
  if (side.empty() || rest.empty()) return side + rest;
  return side + ' ' + rest;
}

}  // namespace trocar
