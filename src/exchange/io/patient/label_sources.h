#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/segmentation.h"
#include "patient_builder/build_patient.h"

namespace trocar::io {

/// Reads the `--labels` of `patient build`: each is a multi-label file (names from the label table of a NIfTI header,
/// else from `label_map`, see LabelMap; a .seg.nrrd contains its names), a single mask file (named after the file), a
/// folder of mask files, a folder of DICOM mask series (one sub-folder per structure, which is named after it; a pixel
/// above 0 is inside), or a DICOM SEG or RT structure set, given as a file or by a folder with such files in it or
/// below (their own names). The map may rename or ignore names of files. A file with one
/// value is a mask. If it is given as a file and its name is not a known structure, a label map that contains the value
/// names it. Several values without a map, or in a file named after one structure, values above 255 and no background
/// are errors; a value that the map lacks has no name, which is an error in build_patient. Masks of a folder that do
/// not overlap share one source; empty structures are left out with warnings, and labels without any voxel are errors.
/// Images of a folder that are not read are told. `ct` is the CT that they belong to: DICOM objects of another series
/// are errors, contours are drawn on its grid.
Result<std::vector<patient_builder::LabelSource>> read_label_sources(const std::vector<std::filesystem::path>& paths,
                                                                     const std::string& label_map,
                                                                     const dicom::CtReference& ct,
                                                                     std::vector<std::string>& warnings);

/// The same without a CT, for labels that need none (not RT structure sets), and without warnings.
Result<std::vector<patient_builder::LabelSource>> read_label_sources(const std::vector<std::filesystem::path>& paths,
                                                                     const std::string& label_map);

/// UIDs of the series that the DICOM segmentations and structure sets of these paths refer to. Damaged files are left
/// to read_label_sources.
std::vector<std::string> series_of_labels(const std::vector<std::filesystem::path>& paths);

}  // namespace trocar::io
