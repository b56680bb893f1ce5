#pragma once

#include "ultrasound/engine/detail/frame_state.h"
#include "ultrasound/engine/detail/scan_plan.h"
#include "ultrasound/engine/detail/tissue_texture.h"
#include "ultrasound/engine/detail/tissue_walk.h"

/// Sheets too thin for CT and labels: diaphragm, walls of vessels and hollow organs (docs/physics.md U6).
namespace trocar::ultrasound::detail {

/// Raises the scatterers' gain of a walk in the walls beside its borders. Call after make_texture.
void add_walls(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, WalkResult& walk,
               const Texture& texture) noexcept;

}  // namespace trocar::ultrasound::detail
