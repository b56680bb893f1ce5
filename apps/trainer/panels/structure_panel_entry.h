#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// Structure panel of the main 3D view, which must precede it in the registry.
ViewDescription structure_panel_entry();

}  // namespace trocar::trainer
