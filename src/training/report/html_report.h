#pragma once

#include <filesystem>
#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "storage/session_file.h"

namespace trocar::report {

/// The session as one self-contained HTML page: score and hints, force-displacement plot with the punctures marked
/// (paper A, figure 4b), force components over time, the path in three CT slices, the core, the case. `patient` may be
/// null (missing or changed): then the page states this and has no slices.
std::string html_report(const storage::Session& session, const anatomy::VirtualPatient* patient);

}  // namespace trocar::report
