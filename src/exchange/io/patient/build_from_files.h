#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/hounsfield.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

/// The files of which a patient is made.
struct PatientFiles {
  std::filesystem::path ct;                    ///< NIfTI, NRRD, MHA, or a folder of DICOM files.
  std::vector<std::filesystem::path> labels;   ///< Label volumes, masks, folders of masks or of DICOM mask series.
  std::string label_map = "totalsegmentator";  ///< See read_label_sources.
  std::string name;                            ///< Of the patient.
  std::string series{};                        ///< Of several DICOM series, see read_ct.
  std::optional<anatomy::Rescale> rescale{};   ///< For a CT whose file lacks the scale of its numbers.
};

/// Reads the files and builds the patient; it says in its provenance of what, without paths of this machine. Between
/// the steps, the CT, the labels, the patient, a stop is obeyed (error "stopped"). Errors: those of read_ct,
/// read_label_sources and build_patient.
Result<anatomy::VirtualPatient> build_from_files(const PatientFiles& files, std::vector<std::string>& warnings,
                                                 const Progress& progress = {}, const std::stop_token& stop = {});

/// The last part of a path, without a slash at its end: "liver.nii.gz", "dicom_folder".
std::string last_name(const std::filesystem::path& path);

}  // namespace trocar::io
