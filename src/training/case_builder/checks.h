#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "case_builder/case_draft.h"
#include "tasks/needle.h"

namespace trocar::case_builder {

enum class CheckLevel : std::uint8_t { kOk, kWarning, kError };

/// Step of building a case to which a check belongs.
enum class CaseStep : std::uint8_t { kImport, kLabels, kTarget, kPath, kForces, kUltrasound, kSave };
inline constexpr int kCaseSteps = 7;

/// Result of a check of a draft, one line.
struct CaseCheck {
  CheckLevel level = CheckLevel::kOk;
  CaseStep step = CaseStep::kLabels;
  std::string text;             ///< Text of the result.
  std::optional<Vec3> where_P;  ///< Position to which a view can jump.
};

/// Runs all checks of a draft: labels (outside the body, implausible HU, volume or extent, cut off, unknown tissue),
/// task, target, entry zone, path and recorded ultrasound. Errors come first within a step; a correct step has one
/// line. `patient`: that of the draft. Takes about 100 ms for a CT of 30 million voxels: do not call it on the GUI
/// thread.
std::vector<CaseCheck> check_draft(const CaseDraft& draft, const anatomy::VirtualPatient& patient,
                                   const tasks::Needle& needle, const anatomy::TissueTable& tissues);

/// Worst level of a step; kOk if there are no findings.
CheckLevel worst_level(const std::vector<CaseCheck>& checks, CaseStep step) noexcept;

}  // namespace trocar::case_builder
