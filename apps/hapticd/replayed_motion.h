#pragma once

#include <filesystem>

#include "core/result.h"
#include "devices/simulated/replay_file.h"

namespace trocar {

/// The motion of a file that a replay device names: CSV (devices/simulated/replay_file.h), or a session, which the
/// program `trocar` converts: the server itself reads no sessions. Errors: the file, or `trocar` is not installed.
Result<devices::RecordedMotion> load_motion(const std::filesystem::path& path);

}  // namespace trocar
