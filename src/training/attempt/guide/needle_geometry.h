#pragma once

#include "haptics/needle_geometry.h"
#include "tasks/needle.h"

namespace trocar {

/// A needle of the list as the forces see it, of steel, with its grip at the hub.
NeedleGeometry needle_geometry(const Needle& needle) noexcept;

}  // namespace trocar
