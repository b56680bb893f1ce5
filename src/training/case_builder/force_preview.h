#pragma once

#include <vector>

#include "anatomy/tissue/tissue_table.h"
#include "case_builder/case_draft.h"
#include "core/result.h"
#include "attempt/offline/force_curve.h"
#include "tasks/needle.h"

namespace trocar {

/// What a hand feels along the expert's path: at 10 mm/s, without the stylus' weight.
struct ForcePreview {
  std::vector<CurvePoint> curve;
  std::vector<CurveEvent> events;  ///< Layers that give way.
  std::vector<PathPiece> pieces;   ///< Tissue from the skin to the path's end.
  double highest_n = 0.0;
};

/// With the task's force model. Errors: no path, a label of a tissue that the table does not know. About a tenth of a
/// second.
Result<ForcePreview> preview_forces(const CaseDraft& draft, std::shared_ptr<const VirtualPatient> patient,
                                    const Needle& needle, const TissueTable& tissues);

}  // namespace trocar
