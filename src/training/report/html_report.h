#pragma once

#include <filesystem>
#include <string>

#include "anatomy/patient.h"
#include "core/result.h"
#include "language/language.h"
#include "report/session_analysis.h"

namespace trocar::report {

/// The session as one self-contained HTML page, in the order of reading: passed or not with the reasons, what to
/// improve first, the score, steps and actions, the core, force-displacement plot with the punctures marked (paper A,
/// figure 4b), force components over time, the path in three CT slices, the case. `patient` may be null (missing or
/// changed): then the page states this and has no slices. Text that `language` has no words for stays English.
std::string html_report(const storage::Session& session, const anatomy::VirtualPatient* patient,
                        const ReportStory& story = {}, const language::Language& language = {});

/// Name of a session's report: "a.trocar" -> "a.report.html".
std::filesystem::path report_file_of(const std::filesystem::path& session);

/// The session in lines of plain text, in the order of html_report: passed or not with the reasons, what to improve,
/// the score's parts, steps, actions, interruptions. Ends with a line break.
std::string text_report(const storage::Session& session, const ReportStory& story = {});

}  // namespace trocar::report
