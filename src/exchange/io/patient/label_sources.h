#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "core/result.h"

namespace trocar::io {

/// Reads the `--labels` of `patient build`: each a multi-label file (names from `label_map`, see LabelMap; a .seg.nrrd
/// brings its own names), a single mask file (named after the file), a folder of mask files, or a folder of DICOM mask
/// series (one sub-folder a structure, named after it; a pixel above 0 is inside). The map may rename or leave out
/// names that files bring. A file with one value is a mask; given by itself and not named like a known structure, a
/// label map that has the value names it. Several values without a map and values above 255 are errors; a value that
/// the map lacks comes without a name, which build_patient refuses. Masks of a folder that do not overlap share one
/// source; an empty mask comes with a coarse grid over its box.
Result<std::vector<anatomy::LabelSource>> read_label_sources(const std::vector<std::filesystem::path>& paths,
                                                             const std::string& label_map);

}  // namespace trocar::io
