#pragma once

#include <optional>
#include <string>

#include "attempt/live/attempt_view.h"
#include "metrics/harm_watch.h"
#include "scoring/pain.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Display text of a tick's event: punctures, entered tissue, a needle resumed inside. Empty for other events.
std::optional<AttemptEvent> describe_event(const storage::SessionInfo& info, const telemetry::TickSample& sample,
                                           const telemetry::TickEvent& event);

/// The event of an action: "the stylet was drawn: bile drips from the hub". `patient`: tells why an injection of
/// anaesthetic numbs nothing; may be null.
AttemptEvent describe_action(const tasks::SubstanceTable& substances, const tasks::Action& action,
                             const anatomy::VirtualPatient* patient = nullptr);
/// "contrast agent: 1.5 ml (3.0 ml in all)"
AttemptEvent describe_injection(const tasks::ContrastInjection& injection, double depth_mm);
/// All actions and injections of an attempt by time, for its story.
std::vector<AttemptEvent> describe_actions(const tasks::SubstanceTable& substances, const storage::Session& session,
                                           const anatomy::VirtualPatient* patient);
/// The event "pain": "the patient feels pain: spinous process".
AttemptEvent describe_pain(const scoring::PainEvent& pain);
/// The event "harm": "critical harm: the needle went 2 mm into the heart", "grazed: …" at the moment `now`.
AttemptEvent describe_harm(const metrics::HarmEvent& harm, const telemetry::TickSample& now);

}  // namespace trocar::attempt
