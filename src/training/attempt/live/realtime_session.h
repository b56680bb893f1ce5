#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/offline/run_session.h"
#include "attempt/servers/haptic_servers.h"
#include "core/clock.h"
#include "link/client/haptic_client.h"

namespace trocar::attempt {

/// Servers of an attempt.
struct RealtimeOptions {
  /// Endpoints of running servers, in any order: the needle's, and optionally the probe's. Empty: two servers are
  /// started for the attempt and end with it.
  std::vector<std::string> endpoints;
  std::optional<link::ClientSecurity> security;  ///< For servers on tcp.
  /// Timeout for a server without messages or without progress (except loading a scene).
  std::chrono::milliseconds timeout{5000};
};

/// Checks the options before a patient is opened (exit status 2); run_realtime_session calls it, too.
Status check_realtime(const RealtimeOptions& options);

/// Checks that every named server responds, or that a server can be started. Call it before a patient is opened.
Status find_servers(const RealtimeOptions& options);

/// Performs a scripted attempt through live haptic servers, in real time: the operator runs in this program; hand,
/// device and tick run in the server. The command line's client of AttemptLoop, on the caller's thread. Every needle
/// tick is recorded and scored as by run_session; times start at the first tick; lost ticks are counted. Meanwhile a
/// transducer is held on the skin beside the entry; its pose is recorded, too. A server that disconnects and returns
/// within the timeout receives scene and hand again, and the attempt continues from the needle's last pose. Errors: no
/// server, another client in control, a request that a server refuses, a fault of the needle's gate, a needle server
/// that does not return, an interruption; the session file then contains everything recorded until then and is
/// incomplete.
Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& options,
                                       const RealtimeOptions& realtime, const Progress& progress = {});

/// The same with these servers and this clock.
Result<RunResult> run_realtime_session(const cases::Case& the_case, const RunOptions& options,
                                       std::vector<std::unique_ptr<ServerHost>> servers,
                                       std::chrono::milliseconds timeout, std::shared_ptr<Clock> clock,
                                       const Progress& progress = {});

}  // namespace trocar::attempt
