#pragma once

#include <string>

#include "core/result.h"
#include "learning/history.h"

namespace trocar::cli {

/// Attempts of a folder of sessions; empty: that of the trainer, which need not exist. Prints a warning per damaged
/// session. Errors: no such folder (exit status 2); it cannot be read.
Result<learning::History> read_past_sessions(const std::string& folder);

}  // namespace trocar::cli
