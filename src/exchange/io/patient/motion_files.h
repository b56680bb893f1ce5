#pragma once

#include <filesystem>
#include <memory>

#include "core/result.h"
#include "motion/motion_model.h"

namespace trocar::io {

/// Reads the motion model of a patient folder: motion.toml, motion_modes.nrrd, motion_border.nrrd. nullptr: the folder
/// has none. Errors: a file is missing, damaged, or of another model.
Result<std::shared_ptr<const motion::MotionModel>> load_motion_model(const std::filesystem::path& folder);

/// Writes a motion model into a patient folder, in place of the one it has: a reader finds the old one, none, or the
/// new one. Errors: those of the file system.
Status save_motion_model(const motion::MotionModel& model, const std::filesystem::path& folder);

}  // namespace trocar::io
