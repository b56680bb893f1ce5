#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "scoring/score.h"
#include "tasks/testing/attempt_patient.h"

namespace trocar::scoring {

inline const anatomy::VirtualPatient& patient() {
  static const anatomy::VirtualPatient the_patient = testing::make_box_patient();
  return the_patient;
}
/// An attempt on the box patient with the box task, the gun and the planned path, unless changed.
struct BoxCase {
  tasks::Task task = testing::make_box_task();
  tasks::Needle needle = testing::make_gun();
  const anatomy::VirtualPatient* who = &patient();
  std::vector<tasks::PlannedPath> experts = {testing::make_box_plan()};
  std::vector<tasks::Action> actions = {};
  tasks::XrayUse xray = {};
  std::optional<double> tip_visible_share = {};

  Outcome score(const std::vector<telemetry::TickSample>& samples, const std::vector<std::size_t>& shots) const {
    const anatomy::TissueTable tissues = testing::make_box_tissues();
    return score_attempt({.task = task,
                          .patient = *who,
                          .tissues = tissues,
                          .needle = needle,
                          .experts = experts,
                          .samples = samples,
                          .shots = shots,
                          .actions = actions,
                          .xray = xray,
                          .has_transducer = tip_visible_share.has_value(),
                          .tip_visible_share = tip_visible_share});
  }
  /// The gun, if there is one, is fired at the end.
  Outcome score(const testing::Attempt& attempt) const {
    return score(attempt.samples,
                 needle.is_biopsy ? std::vector<std::size_t>{attempt.fired} : std::vector<std::size_t>{});
  }
};
/// The same with a needle that has a stylet instead of a gun.
inline BoxCase make_puncture() {
  BoxCase made;
  made.needle.is_biopsy = false;
  made.needle.stylet_diameter_mm = 0.8;
  return made;
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
