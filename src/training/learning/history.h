#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "core/result.h"
#include "learning/past_attempt.h"
#include "storage/session_summary.h"

namespace trocar::learning {

/// The attempts of a folder of session files.
struct History {
  std::vector<PastAttempt> attempts;  ///< By time; of the same second: by file name.
  std::vector<std::string> damaged;   ///< One line for each session that cannot be read.
};

/// Error: the time of the session is none.
Result<PastAttempt> attempt_of(const storage::SessionSummary& session);

/// Reads info and outcome of all sessions (*.trocar, *.session) of a folder, on several threads. A folder that does not
/// exist has none. Error: the folder cannot be read. Empty if `stop` was requested.
Result<History> read_history(const std::filesystem::path& folder, const std::stop_token& stop = {});

}  // namespace trocar::learning
