#include "attempt/live/attempt_event.h"

#include <fmt/format.h>

#include "anatomy/structure_words.h"

namespace trocar {

std::optional<AttemptEvent> describe_event(const SessionInfo& info, const TickSample& sample, const TickEvent& event) {
  AttemptEvent told{sample.time_s, sample.depth_mm, event.kind, {}, {}};
  const auto name_in = [&](const std::vector<std::string>& names) {
    return event.id < names.size() && !names[event.id].empty() ? names[event.id] : fmt::format("#{}", event.id);
  };
  switch (event.kind) {
    case EventKind::kNone:
      return std::nullopt;
    case EventKind::kPuncture:
      told.name = name_in(info.layer_names);
      told.text = fmt::format("through the {} at {:.1f}\u00a0N", layer_words(told.name), tip_load_n(sample));
      return told;
    case EventKind::kEnter:
      told.name = name_in(info.label_names);
      told.text = fmt::format("into the {}", structure_words(told.name));
      return told;
    case EventKind::kLimit:
      break;
  }
  if (event.id != static_cast<std::uint8_t>(LimitReason::kResumedInside)) return std::nullopt;
  told.name = to_string(LimitReason::kResumedInside);
  told.text = "the needle was taken up again inside the body";
  return told;
}

}  // namespace trocar
