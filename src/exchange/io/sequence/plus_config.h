#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "ultrasound/sweep/freehand_options.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io {

/// What freehand reconstruction needs of a PLUS configuration.
struct PlusConfig {
  ultrasound::TrackedSequence::Transforms transforms;  ///< <CoordinateDefinitions>: "ImageToProbe" and so on, fixed.
  bool has_reconstruction = false;  ///< There is a <VolumeReconstruction>; else `reconstruction` is the default.
  ultrasound::FreehandOptions reconstruction;
  std::vector<std::string> left_aside;  ///< What the file asks for and this program does not do; for a warning.
};

/// Reads a PLUS configuration (PlusDeviceSet_*.xml, 1 MB at most, no entities of its own). Errors: no XML (the byte is
/// named), another document, a matrix or number that is none, an unknown name of a mode.
Result<PlusConfig> read_plus_config(const std::filesystem::path& path);

}  // namespace trocar::io
