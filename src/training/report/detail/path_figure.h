#pragma once

#include <string>

#include "anatomy/patient.h"
#include "storage/session_file.h"

namespace trocar::report::detail {

/// Planned and own path over three CT slices through the target; says so where there is no patient to show.
std::string path_figure(const storage::Session& session, const anatomy::VirtualPatient* patient);

}  // namespace trocar::report::detail
