#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "core/result.h"

namespace trocar::io {

/// Reads the `--labels` of `patient build`: each is a multi-label file (names from `label_map`, see LabelMap; a
/// .seg.nrrd contains its names), a single mask file (named after the file), a folder of mask files, or a folder of
/// DICOM mask series (one sub-folder per structure, which is named after it; a pixel above 0 is inside). The map may
/// rename or ignore names of files. A file with one value is a mask. If it is given as a file and its name is not a
/// known structure, a label map that contains the value names it. Several values without a map and values above 255 are
/// errors; a value that the map lacks has no name, which is an error in build_patient. Masks of a folder that do not
/// overlap share one source; an empty mask has a coarse grid over its box.
Result<std::vector<anatomy::LabelSource>> read_label_sources(const std::vector<std::filesystem::path>& paths,
                                                             const std::string& label_map);

}  // namespace trocar::io
