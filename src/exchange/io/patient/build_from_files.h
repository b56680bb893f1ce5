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
#include "patient_builder/build_patient.h"
#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/plausibility/anatomy_finding.h"

namespace trocar::io {

/// What is mirrored left to right, because its file was: labels about the middle of their own grid, or CT and labels
/// about the middle of the CT.
using patient_builder::Mirroring;

/// The input files of a patient.
struct PatientFiles {
  std::filesystem::path ct;                    ///< NIfTI, NRRD, MHA, or a folder of DICOM files.
  std::vector<std::filesystem::path> labels;   ///< Label volumes, masks, folders of masks or of DICOM mask series.
  std::string label_map = "totalsegmentator";  ///< See read_label_sources.
  std::string name;                            ///< Name of the patient.
  std::string series{};                        ///< Selects one of several DICOM series, see read_ct.
  std::optional<anatomy::Rescale> rescale{};   ///< Rescale for a CT whose file lacks it.
  patient_builder::DeriveChoice derive{};      ///< Thin structures to add.
  anatomy::Posture posture = anatomy::Posture::kSupine;  ///< For the puncture.
  Mirroring mirroring = Mirroring::kNone;                ///< Kept in the provenance, as the next ones.
  std::vector<std::string> confirmed{};  ///< Findings that are right (patient_builder/plausibility/anatomy_finding.h).
  std::vector<patient_builder::AnatomyFinding>* findings = nullptr;  ///< Receives all findings.
  bool sibling_series = false;  ///< Labels may be drawn on another series of the scan (dicom::CtReference).
};

/// Reads the files and builds the patient; its provenance names the files without paths of this machine. A stop request
/// takes effect between the steps (CT, labels, patient) with the error "stopped". Errors: those of read_ct,
/// read_label_sources and build_patient.
Result<anatomy::VirtualPatient> build_from_files(const PatientFiles& files, std::vector<std::string>& warnings,
                                                 const Progress& progress = {}, const std::stop_token& stop = {});

/// The last part of a path, without a trailing slash: "liver.nii.gz", "dicom_folder".
std::string last_name(const std::filesystem::path& path);

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
