#pragma once

#include <filesystem>

#include "case_builder/case_draft.h"
#include "case_builder/draft_patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::case_builder {

struct SaveOptions {
  std::filesystem::path folder;
  bool overwrites = false;  ///< Replaces an existing patient folder; other folders are never replaced.
};

/// Writes the case as a patient folder with its own task (task.toml), completely or not at all. Errors: the folder
/// exists, or is not a patient folder, and all write errors; existing data are then unchanged.
Status save_case(const CaseDraft& draft, DraftPatient& patients, const SaveOptions& options,
                 const Progress& progress = {});

}  // namespace trocar::case_builder
