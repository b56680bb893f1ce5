#pragma once

#include <optional>
#include <string>

#include "cli/action.h"

namespace trocar::cli {

/// Adds --breathing and --phase, as cases::breathing_of() reads them; both must outlive the command.
void add_breathing_options(Command& command, std::string& breathing, std::optional<double>& phase);

}  // namespace trocar::cli
