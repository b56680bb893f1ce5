#pragma once

#include <string>

#include "storage/session_file.h"

namespace trocar::report_detail {

std::string page_header(const Session& session);
/// Score and its parts; says so when the session has no outcome.
std::string result_section(const Session& session);
std::string hints_section(const Session& session);
/// The tissue along the specimen notch; empty without a core.
std::string core_section(const Session& session);
std::string case_section(const Session& session);

}  // namespace trocar::report_detail
