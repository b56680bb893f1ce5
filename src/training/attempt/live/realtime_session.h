#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "attempt/offline/run_session.h"
#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// Through which servers an attempt goes.
struct RealtimeOptions {
  /// Of running servers, in any order: the needle's, and perhaps the probe's. None: two are started for the attempt and
  /// end with it.
  std::vector<std::string> endpoints;
  std::optional<link::ClientSecurity> security;  ///< For servers on tcp.
  /// How long a server may be silent, or keep from doing what it was asked (loading a scene excepted).
  std::chrono::milliseconds patience{5000};
};

/// What can be said of the options before there is a patient (exit status 2); run_realtime_session asks it, too.
Status check_realtime(const RealtimeOptions& options);

/// Whether every server that is named answers, or there is one to be started: worth asking before a patient is opened.
Status find_servers(const RealtimeOptions& options);

/// Performs an attempt through live haptic servers, in real time: operator here, hand, device and tick there. The
/// needle's every tick is recorded and scored as by run_session, times from the first one; ticks that get lost on the
/// way are counted. A transducer is held on the skin beside the entry meanwhile; where it was is recorded, too.
/// A needle's server that goes away and comes back within the patience gets scene and hand again, and the attempt goes
/// on from where the needle was. Errors: no server, another client in control, what a server refuses, a fault of the
/// needle's gate, a needle's server that stays away, an interruption; the session file then holds everything up to
/// there and is incomplete.
Result<RunResult> run_realtime_session(const Case& the_case, const RunOptions& options, const RealtimeOptions& realtime,
                                       const Progress& progress = {});

}  // namespace trocar::attempt
