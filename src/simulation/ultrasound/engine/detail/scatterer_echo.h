#pragma once

#include <vector>

#include "ultrasound/engine/detail/scatterer_cell.h"

namespace trocar::ultrasound::detail {

/// Sum of the echoes of a task's scatterers, before it is added to the scanlines: complex, a row of scanlines for each
/// sample, so that an echo's two scanlines are adjacent. Begins kBeforeFace samples before the face, and one scanline
/// before the task's first.
using ScattererField = std::vector<float>;
inline constexpr int kBeforeFace = kPad / 2;
inline constexpr int kFieldRow = 2 * (kGroup + 2);
ScattererField make_scatterer_field(const ScanPlan& plan);

/// Adds the echoes of all scatterers that contribute to scanlines [first, last), at most kGroup of them. Each task
/// writes to its own scanlines; `field` is its own working memory.
void add_scatterers(const ScanPlan& plan, const std::vector<Brick>& library, FrameState& frame, int first, int last,
                    ScattererField& field) noexcept;

}  // namespace trocar::ultrasound::detail
