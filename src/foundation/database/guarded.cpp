#include "database/guarded.h"

#include <algorithm>

namespace trocar::database {

std::string reason_of(const std::exception& error) {
  std::string text = error.what();
  if (const std::size_t end = text.find(" while "); end != std::string::npos) text.resize(end);
  if (const std::size_t colon = text.rfind(": "); colon != std::string::npos) text.erase(0, colon + 2);
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace trocar::database
