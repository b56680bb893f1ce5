#pragma once

#include <filesystem>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

enum class ExportKind {
  kNifti,  ///< ct.nii.gz, and a mask for each structure in segmentations/, as TotalSegmentator writes them.
  kDicom   ///< ct/ct_0001.dcm …, and segmentation.dcm (DICOM SEG).
};

/// Writes CT and structures of a patient for other programs, and so that build_from_files() makes the same patient of
/// them: structures that a build finds or derives itself are left out, the body is the structure "skin". The folder is
/// written completely or not at all. Errors: the folder exists, the file system's.
Status export_patient(const anatomy::VirtualPatient& patient, ExportKind kind, const std::filesystem::path& folder,
                      const Progress& progress = {});

}  // namespace trocar::io
