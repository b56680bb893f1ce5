#pragma once

#include <string>

#include "storage/session_file.h"

namespace trocar::report::detail {

std::string page_header(const storage::Session& session);
/// Score and its parts; a text if the session has no outcome.
std::string result_section(const storage::Session& session);
std::string hints_section(const storage::Session& session);
/// The tissue along the specimen notch; empty without a core.
std::string core_section(const storage::Session& session);
std::string bleeding_section(const storage::Session& session);
std::string case_section(const storage::Session& session);

}  // namespace trocar::report::detail
