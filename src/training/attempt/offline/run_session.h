#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "attempt/record/attempt_record.h"
#include "attempt/record/score_session.h"
#include "attempt/record/session_case.h"
#include "cases/prepare_case.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::attempt {

/// Operator, settings and output file of an attempt. Its operator: expert | novice | novice:SHARE |
/// constant-velocity:MM_PER_S | replay:SESSION.
struct RunOptions : AttemptIdentity {
  RunOptions() { operator_name = "expert"; }

  std::string force_model;  ///< insertion | proxy | combined; empty: the task's, or that of the replayed session.
  std::string device = "premium";  ///< Name in data/devices.toml; its limits and coupling are simulated.
  double rate_hz = 1000.0;         ///< 250..4000. A replay uses its session's rate.
  std::filesystem::path session;   ///< Written here; must not exist.
  // Replay only. It uses seeds, rate and device of its session; the values above are ignored.
  std::shared_ptr<const storage::Session> replayed;  ///< Session of the operator's name, if it is already loaded.
  ReplayChanges replay_changes;
  bool is_other_patient_meant = false;  ///< A patient with another content hash is accepted.
};

/// Checks the options before a patient is opened (exit status 2); run_session calls it, too.
Status check_run(const RunOptions& options);

/// Performs an attempt in one thread, faster than real time: operator, hand, device, tick, recording, score. Every tick
/// is in the session file. A failure or interruption leaves no file: the same options reproduce the same ticks.
Result<RunResult> run_session(const cases::Case& the_case, const RunOptions& options, const Progress& progress = {});

}  // namespace trocar::attempt
