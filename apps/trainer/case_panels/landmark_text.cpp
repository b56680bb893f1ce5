#include "case_panels/landmark_text.h"

#include <algorithm>
#include <string>
#include <vector>

#include "case_builder/case_edits.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

/// Names that the program gives.
std::vector<std::string> given_names() {
  constexpr int kMostNumbered = 99;
  const auto listed = case_builder::landmark_names();
  std::vector<std::string> names(listed.begin(), listed.end());
  for (int n = 1; n <= kMostNumbered; ++n) names.push_back("landmark " + std::to_string(n));
  return names;
}

}  // namespace

QString landmark_text(const std::string& name) {
  const std::vector<std::string> given = given_names();
  return std::ranges::find(given, name) != given.end() ? shown(name) : to_qt(name);
}

std::string landmark_of(const QString& text) {
  const QString typed = text.trimmed();
  for (const std::string& name : given_names())
    if (shown(name) == typed) return name;
  return to_std(typed);
}

}  // namespace trocar::trainer
