#pragma once

#include <filesystem>

#include "case_builder/case_draft.h"
#include "case_builder/draft_patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::case_builder {

struct SaveOptions {
  std::filesystem::path folder;
  bool overwrites = false;  ///< A patient folder that stands there is replaced; anything else never is.
};

/// Writes the case as a patient folder with its own task (task.toml) in it, whole or not at all: `trocar run --patient
/// FOLDER` opens it. Errors: the folder is there already, or is no patient's, and everything that writing can meet;
/// what stood there before then stands there still.
Status save_case(const CaseDraft& draft, DraftPatient& patients, const SaveOptions& options,
                 const Progress& progress = {});

}  // namespace trocar::case_builder
