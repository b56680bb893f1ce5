#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "registration/shadow/beams.h"
#include "volume/grid.h"

namespace trocar::cli {

/// An ultrasound volume of a file.
struct UltrasoundVolume {
  std::string name;  ///< File name without ending.
  volume::LabelGrid gray;
  registration::Beams beams;
};

/// Reads a volume of gray levels; prints warnings. `beam_axis`: parallel beams along it; empty: the beams of the
/// header, or parallel along +y.
Result<UltrasoundVolume> read_ultrasound_volume(const std::string& path, const std::string& beam_axis);

}  // namespace trocar::cli
