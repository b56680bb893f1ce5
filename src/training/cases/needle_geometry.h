#pragma once

#include "haptics/needle_geometry.h"
#include "tasks/needle.h"

namespace trocar::cases {

/// Geometry of a listed needle for the force models: of steel, with its grip at the hub.
haptics::NeedleGeometry needle_geometry(const tasks::Needle& needle) noexcept;

}  // namespace trocar::cases
