#pragma once

#include "haptics/needle_geometry.h"
#include "tasks/needle.h"

namespace trocar::cases {

/// A needle of the list as the forces see it, of steel, with its grip at the hub.
haptics::NeedleGeometry needle_geometry(const tasks::Needle& needle) noexcept;

}  // namespace trocar::cases
