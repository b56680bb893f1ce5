#pragma once

#include <string>

#include "core/result.h"
#include "learning/history.h"
#include "storage/session_file.h"

namespace trocar::cli {

/// Attempts of a folder of sessions; empty: that of the trainer, which need not exist. Prints a warning per damaged
/// session. Errors: no such folder (exit status 2); it cannot be read.
Result<learning::History> read_past_sessions(const std::string& folder);

/// Prints a warning if a session was made with another version of the forces than this program's.
void warn_of_forces(const storage::SessionInfo& info, const std::string& session);

}  // namespace trocar::cli
