#pragma once

#include "core/result.h"
#include "devices/simulated/replay_file.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// The motion of the stylus that led the needle of a session, in the room where its own plan places the patient: for a
/// replay device. Errors: no ticks, an unknown needle.
Result<devices::RecordedMotion> stylus_motion(const storage::Session& session);

}  // namespace trocar::attempt
