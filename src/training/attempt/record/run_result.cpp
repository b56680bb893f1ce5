#include "attempt/record/run_result.h"

namespace trocar {

std::vector<PunctureRecord> find_punctures(const SessionInfo& info, const std::vector<TickSample>& samples) {
  std::vector<PunctureRecord> punctures;
  for (const TickSample& sample : samples) {
    for (const TickEvent& event : sample.events) {
      if (event.kind != EventKind::kPuncture) continue;
      punctures.push_back({info.layer_names.at(event.id), sample.time_s, sample.depth_mm, tip_load_n(sample)});
    }
  }
  return punctures;
}

}  // namespace trocar
