#include "tasks/xray_use.h"

namespace trocar::tasks {

std::vector<ContrastInjection> find_injections(std::span<const XrayUse> uses) {
  std::vector<ContrastInjection> found;
  double before_ml = 0.0;
  for (const XrayUse& use : uses) {
    const double ml = use.contrast_ml - before_ml;
    before_ml = use.contrast_ml;
    if (!(ml > 0.0)) continue;
    if (found.empty() || use.time_s - found.back().end_s > kBetweenInjections_s)
      found.push_back({use.time_s, 0.0, 0.0});
    found.back().end_s = use.time_s;
    found.back().ml += ml;
    found.back().total_ml = use.contrast_ml;
  }
  return found;
}

}  // namespace trocar::tasks
