#pragma once

#include <filesystem>

#include "core/result.h"
#include "devices/simulated/replay_device.h"

namespace trocar {

/// Loads the motion of a replay device's file: CSV (docs/devices.md), or a session. The program
/// `trocar` converts a session, because the server does not read sessions. Errors: an unusable file, or `trocar` is not
/// installed.
Result<devices::RecordedMotion> load_motion(const std::filesystem::path& path);

}  // namespace trocar
