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

/// Where in the making of a case something belongs.
enum class CaseStep : std::uint8_t { kImport, kLabels, kTarget, kPath, kForces, kSave };
inline constexpr int kCaseSteps = 6;

/// One line about a draft.
struct CaseCheck {
  CheckLevel level = CheckLevel::kOk;
  CaseStep step = CaseStep::kLabels;
  std::string text;             ///< What is right, doubtful or wrong, in words.
  std::optional<Vec3> where_P;  ///< What a view can jump to.
};

/// Everything that can be said of a draft: labels (outside the body, implausible HU, volume or extent, cut off, of no
/// known tissue), the task (what the patient lacks), target, entry zone and path (what they touch, where, by how much).
/// Errors come first within a step; a step that is in order says so in one line. `patient` is the draft's
/// (DraftPatient). Some 100 ms for a CT of 30 million voxels: not for the thread of a window.
std::vector<CaseCheck> check_draft(const CaseDraft& draft, const anatomy::VirtualPatient& patient,
                                   const tasks::Needle& needle, const anatomy::TissueTable& tissues);

/// The worst of a step; kOk where nothing is said of it.
CheckLevel worst_level(const std::vector<CaseCheck>& checks, CaseStep step) noexcept;

}  // namespace trocar::case_builder
