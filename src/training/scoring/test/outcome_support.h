#pragma once

#include <algorithm>
#include <string>

#include "scoring/score.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::scoring {

inline const anatomy::VirtualPatient& patient() {
  static const anatomy::VirtualPatient the_patient = testing::make_box_patient();
  return the_patient;
}
inline const ScorePart& part(const Outcome& outcome, const std::string& name) {
  return *std::find_if(outcome.parts.begin(), outcome.parts.end(), [&](const ScorePart& p) { return p.name == name; });
}
inline bool has_hint(const Outcome& outcome, const std::string& words) {
  return std::any_of(outcome.hints.begin(), outcome.hints.end(),
                     [&](const Hint& hint) { return hint.text.find(words) != std::string::npos; });
}
inline Segment shifted(const Vec3& by_P) {
  const Segment line_P = testing::make_box_plan().line_P;
  return {line_P.a + by_P, line_P.b + by_P};
}

}  // namespace trocar::scoring
