#include "attempt/record/run_result.h"

namespace trocar::attempt {

std::vector<PunctureRecord> find_punctures(const storage::SessionInfo& info,
                                           const std::vector<telemetry::TickSample>& samples) {
  std::vector<PunctureRecord> punctures;
  for (const telemetry::TickSample& sample : samples) {
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      punctures.push_back(
          {info.layer_names.at(event.id), sample.time_s, sample.depth_mm, telemetry::tip_load_n(sample)});
    }
  }
  return punctures;
}

}  // namespace trocar::attempt
