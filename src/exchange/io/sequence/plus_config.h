#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "ultrasound/sweep/freehand.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io {

/// Data of a PLUS configuration for freehand reconstruction.
struct PlusConfig {
  ultrasound::TrackedSequence::Transforms transforms;  ///< <CoordinateDefinitions>: "ImageToProbe" and so on, fixed.
  bool has_reconstruction = false;  ///< The file has a <VolumeReconstruction>; else `reconstruction` is the default.
  ultrasound::FreehandOptions reconstruction;
  std::vector<std::string> left_aside;  ///< Settings of the file that this program does not support; for a warning.
};

/// Reads a PLUS configuration (PlusDeviceSet_*.xml, 1 MB at most, no entities of its own). Errors: not XML (the byte is
/// named), another document, an invalid matrix or number, an unknown name of a mode.
Result<PlusConfig> read_plus_config(const std::filesystem::path& path);

}  // namespace trocar::io
