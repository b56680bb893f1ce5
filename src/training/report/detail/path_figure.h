#pragma once

#include <string>

#include "anatomy/patient.h"
#include "storage/session_file.h"

namespace trocar::report::detail {

/// Planned and performed path over three CT slices through the target; a text if there is no patient to show.
std::string path_figure(const storage::Session& session, const anatomy::VirtualPatient* patient);

}  // namespace trocar::report::detail
