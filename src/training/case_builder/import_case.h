#pragma once

#include <stop_token>
#include <string>
#include <vector>

#include "case_builder/case_draft.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::case_builder {

/// What is to be imported.
struct ImportRequest {
  /// A CT (NIfTI, NRRD, MHA, the folder of one DICOM series), or a patient folder, or an embedded patient's name; the
  /// latter two bring their labels.
  std::string ct;
  std::vector<std::string> labels;  ///< Label volumes, masks, .seg.nrrd, folders of masks or of DICOM mask series.
  std::string label_map = "totalsegmentator";  ///< Names of label numbers, or a TOML file with a [labels] table.
  std::string task = "liver-biopsy";           ///< The template, of the data folder.
};

/// Whether the request names a patient that is whole already.
bool is_whole_patient(const ImportRequest& request);

/// A new draft with surfaces and statistics. A patient folder brings its landmarks, paths and own task. Takes seconds
/// to minutes: run it in the background; a stop is obeyed between the steps. Errors: one line, those of the files, of
/// the patient's building, of the template.
Result<CaseDraft> import_case(const ImportRequest& request, const Progress& progress = {},
                              const std::stop_token& stop = {});

}  // namespace trocar::case_builder
