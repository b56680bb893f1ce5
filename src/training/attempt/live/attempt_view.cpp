#include "attempt/live/attempt_view.h"

#include <fmt/format.h>

#include <algorithm>

#include "anatomy/structure_words.h"
#include "core/text.h"

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

AttemptEvent describe_action(const tasks::SubstanceTable& substances, const tasks::Action& action,
                             const anatomy::VirtualPatient* patient) {
  AttemptEvent told{action.time_s, action.depth_mm, telemetry::EventKind::kNone, "action", {}};
  const auto look = [&](bool is_aspirated) {
    const auto found = substances.looks.find(action.result.substance);
    if (found == substances.looks.end()) return std::string(tasks::substance_words(action.result.substance));
    std::string words = is_aspirated ? found->second.aspirated : found->second.flows;
    if (!words.empty()) words.front() = ascii::to_lower(words.front());
    const bool is_slow = action.result.substance != tasks::Substance::kNothing && action.result.is_slow();
    return words + (is_slow ? ", slowly: the bevel is only partly in it" : "");
  };
  switch (action.kind) {
    case tasks::ActionKind::kAnaesthetise:
      told.text = fmt::format("anaesthetic: {:.0f}\u00a0ml", action.amount);
      if (patient != nullptr)
        if (const std::string fault = scoring::why_not_numb(action, *patient); !fault.empty())
          told.text += "; " + fault;
      break;
    case tasks::ActionKind::kDrawStylet:
      told.text = "stylet removed: " + look(false);
      break;
    case tasks::ActionKind::kReplaceStylet:
      told.text = "stylet reinserted";
      break;
    case tasks::ActionKind::kAspirate:
      told.text = "aspirated: " + look(true);
      break;
    case tasks::ActionKind::kAdvanceWire:
      told.text = fmt::format("guide wire {:.0f}\u00a0mm beyond the tip", action.amount);
      break;
    case tasks::ActionKind::kHoldBreath:
      told.text = "asked the patient to hold the breath";
      break;
    case tasks::ActionKind::kBreathe:
      told.text = "told the patient to breathe again";
      break;
    case tasks::ActionKind::kFire:
      told.text = action.depth_mm > 0.0 ? "the gun was fired" : "the gun was fired outside the body";
      break;
    case tasks::ActionKind::kLoad:
      told.text = "the gun is loaded again";
      break;
  }
  return told;
}

AttemptEvent describe_injection(const tasks::ContrastInjection& injection, double depth_mm) {
  AttemptEvent told{injection.end_s, depth_mm, telemetry::EventKind::kNone, "action", {}};
  told.text = fmt::format("contrast agent: {:.1f}\u00a0ml", injection.ml);
  if (injection.total_ml > injection.ml + 0.05)
    told.text += fmt::format(" ({:.1f}\u00a0ml in all)", injection.total_ml);
  return told;
}

std::vector<AttemptEvent> describe_actions(const tasks::SubstanceTable& substances, const storage::Session& session,
                                           const anatomy::VirtualPatient* patient) {
  std::vector<AttemptEvent> all;
  for (const tasks::Action& action : session.actions) all.push_back(describe_action(substances, action, patient));
  for (const tasks::ContrastInjection& injection : tasks::find_injections(session.xray)) {
    const auto sample = std::ranges::lower_bound(session.samples, injection.end_s, {}, &telemetry::TickSample::time_s);
    all.push_back(describe_injection(injection, sample != session.samples.end() ? sample->depth_mm : 0.0));
  }
  std::ranges::stable_sort(all, {}, &AttemptEvent::time_s);
  return all;
}

AttemptEvent describe_pain(const scoring::PainEvent& pain) {
  const std::string why = pain.label.empty() ? "no local anaesthetic" : anatomy::structure_words(pain.label);
  return {pain.time_s, pain.depth_mm, telemetry::EventKind::kNone, "pain", "the patient feels pain: " + why};
}

AttemptEvent describe_harm(const metrics::HarmEvent& harm, const telemetry::TickSample& now) {
  const std::string words = metrics::harm_words(harm);
  AttemptEvent told{now.time_s, now.depth_mm, telemetry::EventKind::kNone, "harm", {}, harm.grade};
  told.text = harm.is_graze ? words : fmt::format("{} harm: {}", tasks::to_string(harm.grade), words);
  return told;
}

}  // namespace trocar::attempt
