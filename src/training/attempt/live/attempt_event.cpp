#include "attempt/live/attempt_event.h"

#include <fmt/format.h>

#include "anatomy/structure_words.h"

namespace trocar::attempt {

std::optional<AttemptEvent> describe_event(const storage::SessionInfo& info, const telemetry::TickSample& sample,
                                           const telemetry::TickEvent& event) {
  AttemptEvent told{sample.time_s, sample.depth_mm, event.kind, {}, {}};
  const auto name_in = [&](const std::vector<std::string>& names) {
    return event.id < names.size() && !names[event.id].empty() ? names[event.id] : fmt::format("#{}", event.id);
  };
  switch (event.kind) {
    case telemetry::EventKind::kNone:
      return std::nullopt;
    case telemetry::EventKind::kPuncture:
      told.name = name_in(info.layer_names);
      told.text = fmt::format("through the {} at {:.1f}\u00a0N", anatomy::layer_words(told.name),
                              telemetry::tip_load_n(sample));
      return told;
    case telemetry::EventKind::kEnter:
      told.name = name_in(info.label_names);
      told.text = fmt::format("into the {}", anatomy::structure_words(told.name));
      return told;
    case telemetry::EventKind::kLimit:
      break;
  }
  if (event.id != static_cast<std::uint8_t>(telemetry::LimitReason::kResumedInside)) return std::nullopt;
  told.name = to_string(telemetry::LimitReason::kResumedInside);
  told.text = "the needle was resumed inside the body";
  return told;
}

}  // namespace trocar::attempt
