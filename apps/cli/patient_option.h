#pragma once

#include "cli/action.h"
#include "io/patient/patient_folder.h"

namespace trocar::cli {

/// Adds --no-cache; without it `source` uses the user's cache folder for embedded patients. `source` must outlive the
/// command.
void add_cache_option(Command& command, io::PatientSource& source);

}  // namespace trocar::cli
