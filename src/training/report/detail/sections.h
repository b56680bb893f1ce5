#pragma once

#include <string>

#include "report/session_analysis.h"
#include "storage/session_file.h"

namespace trocar::report::detail {

/// Title of the task; its name as words if the case is not at hand.
std::string title_of(const storage::Session& session, const ReportStory& story);
std::string page_header(const storage::Session& session, const ReportStory& story);
// The verdict (verdict.cpp), in the order of reading.
/// Passed or not, with the reasons; a text if the session has no outcome.
std::string verdict_section(const storage::Session& session);
/// The first thing to improve, then the other hints.
std::string advice_section(const storage::Session& session);
/// The score's parts; empty if it is not scored.
std::string score_section(const storage::Session& session);
std::string steps_section(const storage::Session& session, const ReportStory& story);
std::string actions_section(const ReportStory& story);

// sections.cpp
/// The tissue along the specimen notch; empty without a core.
std::string core_section(const storage::Session& session);
std::string bleeding_section(const storage::Session& session);
std::string case_section(const storage::Session& session);

}  // namespace trocar::report::detail
