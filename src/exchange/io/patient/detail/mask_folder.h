#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "dicom/segmentation/segmentation.h"
#include "io/patient/label_map.h"
#include "patient_builder/build_patient.h"

namespace trocar::io::detail {

/// The values other than 0 in the image.
std::vector<int> values_in(const volume::LabelGrid& labels);

/// An empty mask needs no voxels: a coarse grid over the same box gives its position.
volume::LabelGrid empty_over(const volume::GridGeometry& geometry);

/// Collects the masks of a folder. Masks that do not overlap share one source.
class MaskFolder {
 public:
  void add(patient_builder::LabelSource source);
  std::vector<patient_builder::LabelSource> take();

 private:
  std::vector<patient_builder::LabelSource> joined_;
  std::vector<patient_builder::LabelSource> others_;  ///< Empty masks and files of several labels.
};

/// The DICOM segmentations and structure sets that a path names: the file itself, or those in a folder and its
/// sub-folders, in the order of their names. None for other files. Errors: a damaged DICOM file.
Result<std::vector<std::filesystem::path>> find_dicom_labels(const std::filesystem::path& path);

/// Reads one of them. Structures are named by the label map, their own name, or their property type
/// (LabelMap::name_of); a single structure without a known name is named after its file if that is a known one. Ignored
/// structures are left out; empty ones have a coarse grid over the CT. Warnings name the file. Errors: those of
/// dicom::read_segmentation.
Result<std::vector<patient_builder::LabelSource>> read_dicom_labels(const std::filesystem::path& path,
                                                                    const LabelMap& map, const dicom::CtReference& ct,
                                                                    std::vector<std::string>& warnings);

}  // namespace trocar::io::detail
