#pragma once

#include <filesystem>
#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "language/language.h"
#include "report/report_story.h"

namespace trocar::report {

/// The session as one self-contained HTML page, in the order of reading: passed or not with the reasons, what to
/// improve first, the score, steps and actions, the core, force-displacement plot with the punctures marked (paper A,
/// figure 4b), force components over time, the path in three CT slices, the case. `patient` may be null (missing or
/// changed): then the page states this and has no slices. Text that `language` has no words for stays English.
std::string html_report(const storage::Session& session, const anatomy::VirtualPatient* patient,
                        const ReportStory& story = {}, const language::Language& language = {});

/// Name of a session's report: "a.trocar" -> "a.report.html".
std::filesystem::path report_file_of(const std::filesystem::path& session);

}  // namespace trocar::report
