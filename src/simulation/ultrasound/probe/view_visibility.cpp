#include "ultrasound/probe/view_visibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "ultrasound/probe/detail/view_rays.h"

namespace trocar::ultrasound {

Result<ViewVisibility> measure_visibility(const anatomy::VirtualPatient& patient, const ProbeView& view,
                                          const Transducer& transducer, const Pose& X_PT) {
  TROCAR_TRY(const Vec3 target_P, detail::find_target_point(patient, view));
  const detail::ViewAnatomy ground(patient, view);
  return detail::ViewRays(ground, view, transducer, target_P).measure(X_PT);
}

std::string hidden_causes(const ViewVisibility& visibility) {
  constexpr double kLeast = 0.005;
  std::vector<std::pair<double, const char*>> causes = {{visibility.behind_bone, "behind bone"},
                                                        {visibility.behind_gas, "behind gas or lung"},
                                                        {visibility.unscanned, "outside the CT"},
                                                        {visibility.outside_picture, "outside the picture"},
                                                        {visibility.too_deep, "too deep for the frequency"}};
  std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> texts;
  for (const auto& [share, text] : causes)
    if (share >= kLeast) texts.push_back(fmt::format("{:.0f} % {}", 100.0 * share, text));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace trocar::ultrasound
