#pragma once

#include <string>

#include "report/report_story.h"

namespace trocar::report {

/// The session in lines of plain text, in the order of html_report: passed or not with the reasons, what to improve,
/// the score's parts, steps, actions, interruptions. Ends with a line break.
std::string text_report(const storage::Session& session, const ReportStory& story = {});

}  // namespace trocar::report
