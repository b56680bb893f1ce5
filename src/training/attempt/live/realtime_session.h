#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/offline/run_session.h"
#include "core/clock.h"
#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// Servers of an attempt.
struct RealtimeOptions {
  /// Of running servers, in any order: the needle's, and perhaps the probe's. None: two are started for the attempt and
  /// end with it.
  std::vector<std::string> endpoints;
  std::optional<link::ClientSecurity> security;  ///< For servers on tcp.
  /// Timeout for a server without messages or without progress (except loading a scene).
  std::chrono::milliseconds patience{5000};
  std::shared_ptr<Clock> clock = std::make_shared<SteadyClock>();
};

/// Checks the options before a patient is opened (exit status 2); run_realtime_session calls it, too.
Status check_realtime(const RealtimeOptions& options);

/// Checks that every named server responds, or that one can be started; call it before a patient is opened.
Status find_servers(const RealtimeOptions& options);

/// Performs an attempt through live haptic servers, in real time: operator here, hand, device and tick there. The
/// needle's every tick is recorded and scored as by run_session, times from the first one; ticks that get lost on the
/// way are counted. A transducer is held on the skin beside the entry meanwhile; where it was is recorded, too.
/// A needle's server that goes away and comes back within the patience gets scene and hand again, and the attempt goes
/// on from where the needle was. Errors: no server, another client in control, what a server refuses, a fault of the
/// needle's gate, a needle's server that stays away, an interruption; the session file then holds everything up to
/// there and is incomplete.
Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& options,
                                       const RealtimeOptions& realtime, const Progress& progress = {});

}  // namespace trocar::attempt
