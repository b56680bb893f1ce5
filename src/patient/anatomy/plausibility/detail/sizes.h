#pragma once

#include <vector>

#include "anatomy/plausibility/detail/label_shapes.h"
#include "anatomy/plausibility/judge_anatomy.h"

namespace trocar::anatomy::detail {

/// Volumes, lengths and shapes of whole organs beyond those of any person, and large organs that a segmentation of many
/// structures lacks although its scan reaches over their place. Both are told, not refused.
void judge_sizes(const volume::LabelGrid& labels, const LabelTable& table, const LabelShapes& shapes,
                 std::vector<AnatomyFinding>& findings);

}  // namespace trocar::anatomy::detail
