#pragma once

#include <string>

#include "storage/session_file.h"

namespace trocar::attempt {

/// "recorded with version 1 of the forces, …", one line, if a session was made with another version of the forces than
/// this program's (haptics/force_version.h): forces that are computed anew from it differ. Empty: the same version.
std::string other_forces_note(const storage::SessionInfo& info);

}  // namespace trocar::attempt
