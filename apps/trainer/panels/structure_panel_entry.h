#pragma once

#include "views/view_registry.h"

namespace trocar::trainer {

/// The structures of the main 3D view, which comes before it in the registry.
ViewDescription structure_panel_entry();

}  // namespace trocar::trainer
