#include "case_panels/landmark_text.h"

#include "case_builder/landmark_names.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {

std::string landmark_of(const QString& text) {
  const QString typed = text.trimmed();
  for (const std::string_view name : case_builder::landmark_names())
    if (shown(name) == typed) return std::string(name);
  constexpr int kMostNumbered = 99;
  for (int n = 1; n <= kMostNumbered; ++n)
    if (const std::string name = "landmark " + std::to_string(n); shown(name) == typed) return name;
  return to_std(typed);
}

}  // namespace trocar::trainer
