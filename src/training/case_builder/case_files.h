#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "case_builder/case_draft.h"
#include "core/progress.h"
#include "core/result.h"
#include "io/patient/build_from_files.h"

namespace trocar::case_builder {

/// Input of an import.
struct ImportRequest {
  /// A CT (NIfTI, NRRD, MHA, the folder of one DICOM series), or a patient folder, or an embedded patient's name; the
  /// latter two include their labels.
  std::string ct;
  std::vector<std::string> labels;  ///< Label volumes, masks, .seg.nrrd, folders of masks or of DICOM mask series.
  std::string label_map = "totalsegmentator";  ///< Names of label numbers, or a TOML file with a [labels] table.
  std::string task = "liver-biopsy";           ///< Template task of the data folder.
  anatomy::Posture posture = anatomy::Posture::kSupine;
  bool sibling_series = false;  ///< Labels may be drawn on another series of the scan.
  io::Mirroring mirroring = io::Mirroring::kNone;
  std::vector<std::string> confirmed{};  ///< Findings about the whole segmentation that are right.
  /// Receives the findings when the import ends, also if it fails; may be empty.
  std::shared_ptr<std::vector<patient_builder::AnatomyFinding>> findings{};
};

/// True if the request names a patient that is already complete.
bool is_whole_patient(const ImportRequest& request);

/// A new draft with surfaces and statistics. A patient folder includes its landmarks, paths and own task. Takes seconds
/// to minutes: run it in the background; `stop` is checked between the steps. Errors, one line: the files, building the
/// patient, the template.
Result<CaseDraft> import_case(const ImportRequest& request, const Progress& progress = {},
                              const std::stop_token& stop = {});

struct SaveOptions {
  std::filesystem::path folder;
  bool overwrites = false;  ///< Replaces an existing patient folder; other folders are never replaced.
};

/// Writes the case as a patient folder with its own task (task.toml), completely or not at all. Errors: the folder
/// exists, or is not a patient folder, and all write errors; existing data are then unchanged.
Status save_case(const CaseDraft& draft, DraftPatient& patients, const SaveOptions& options,
                 const Progress& progress = {});

}  // namespace trocar::case_builder
