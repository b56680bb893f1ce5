#pragma once

#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "case_builder/case_draft.h"
#include "cases/force_curve.h"
#include "core/result.h"
#include "tasks/needle.h"

namespace trocar::case_builder {

/// Predicted force on the hand along the expert's path: at 10 mm/s, without the stylus' weight.
struct ForcePreview {
  std::vector<cases::CurvePoint> curve;
  std::vector<cases::CurveEvent> events;  ///< Punctured layers.
  std::vector<cases::PathPiece> pieces;   ///< Tissue from the skin to the path's end.
  double highest_n = 0.0;
};

/// With the task's force model. Errors: no path, a label with a tissue that is not in the table. Takes about 0.1 s.
Result<ForcePreview> preview_forces(const CaseDraft& draft, std::shared_ptr<const anatomy::VirtualPatient> patient,
                                    const tasks::Needle& needle, const anatomy::TissueTable& tissues);

}  // namespace trocar::case_builder
