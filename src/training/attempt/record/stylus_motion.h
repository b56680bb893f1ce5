#pragma once

#include "core/result.h"
#include "devices/simulated/replay_file.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// Motion of the stylus that led the needle of a session, for a replay device. Frame: the room in which the session's
/// own plan places the patient. Errors: no ticks, an unknown needle.
Result<devices::RecordedMotion> stylus_motion(const storage::Session& session);

}  // namespace trocar::attempt
